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

/// Viridis, dark to bright: 256 colours, sRGB-coded, three bytes each.
pub(super) fn viridis() -> Vec<u8> {
    sampled(colours::at)
}

/// Blue over white to orange, in the same form.
pub(super) fn diverging() -> Vec<u8> {
    let [blue, white, orange] = [BLUE, WHITE, ORANGE].map(Rgb::from_array);
    sampled(|place| {
        let from_middle = 2.0 * place - 1.0;
        white.lerp(if from_middle < 0.0 { blue } else { orange }, from_middle.abs())
    })
}

fn sampled(colour: impl Fn(f64) -> Rgb) -> Vec<u8> {
    let places = (0..COUNT).map(|number| number as f64 / (COUNT - 1) as f64);
    places
        .flat_map(|place| colour(place).to_array().map(|coded| (coded * 255.0).round() as u8))
        .collect()
}
