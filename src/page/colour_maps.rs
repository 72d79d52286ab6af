//! Maps from places along a scale to colours, as the scripts get them.

use crate::colour::Rgb;
use crate::render::colours;

/// Colours of a map.
const COUNT: usize = 256;

/// Ends and middle of the diverging map, sRGB-coded: blue, nearly white and orange, which the
/// colour-blind tell apart.
const BLUE: [f64; 3] = [0.0, 0.33, 0.60];
const WHITE: [f64; 3] = [0.97, 0.97, 0.97];
const ORANGE: [f64; 3] = [0.76, 0.30, 0.0];

/// Viridis at a place along a scale, 0..=1, sRGB-coded.
pub(crate) fn viridis_at(place: f64) -> [u8; 3] {
    bytes(colours::at(place))
}

/// Blue over white to orange at a place along a scale, 0..=1, sRGB-coded.
pub(crate) fn diverging_at(place: f64) -> [u8; 3] {
    let [blue, white, orange] = [BLUE, WHITE, ORANGE].map(Rgb::from_array);
    let from_middle = (2.0 * place - 1.0).clamp(-1.0, 1.0);
    bytes(white.lerp(if from_middle < 0.0 { blue } else { orange }, from_middle.abs()))
}

/// Viridis, dark to bright: 256 colours, sRGB-coded, three bytes each.
pub(crate) fn viridis() -> Vec<u8> {
    sampled(viridis_at)
}

/// Blue over white to orange, in the same form.
pub(crate) fn diverging() -> Vec<u8> {
    sampled(diverging_at)
}

fn sampled(colour: impl Fn(f64) -> [u8; 3]) -> Vec<u8> {
    (0..COUNT).map(|number| number as f64 / (COUNT - 1) as f64).flat_map(colour).collect()
}

fn bytes(coded: Rgb) -> [u8; 3] {
    coded.to_array().map(|coded| (coded * 255.0).round() as u8)
}
