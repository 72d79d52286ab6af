//! Colours that stand for something, told apart by the colour-blind too.

use crate::colour::{Rgb, linear_from_srgb};

/// A colour and what it stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Swatch {
    pub(super) name: String,
    /// sRGB-coded.
    pub(super) colour: [u8; 3],
}

/// Colours without an order, sRGB-coded, of [Okabe and Ito 2008], grey first.
///
/// [Okabe and Ito 2008]: https://jfly.uni-koeln.de/color/
pub(crate) const CATEGORIES: [[u8; 3]; 8] = [
    [187, 187, 187],
    [204, 121, 167],
    [86, 180, 233],
    [230, 159, 0],
    [0, 114, 178],
    [0, 158, 115],
    [240, 228, 66],
    [213, 94, 0],
];

/// `count` colours in an order, dark to bright, sRGB-coded.
pub(super) fn steps(count: usize) -> impl Iterator<Item = [u8; 3]> {
    let last = (count.max(2) - 1) as f64;
    (0..count).map(move |step| {
        let colour = colorous::VIRIDIS.eval_continuous(step as f64 / last);
        [colour.r, colour.g, colour.b]
    })
}

/// sRGB-coded colour, 0..=1, at a place along a scale, 0..=1: [viridis], which is even to the eye.
///
/// [viridis]: https://bids.github.io/colormap/
pub(crate) fn at(place: f64) -> Rgb {
    let colour = colorous::VIRIDIS.eval_continuous(place);
    Rgb::new(colour.r.into(), colour.g.into(), colour.b.into()) / 255.0
}

/// The linear colour, 0..=1, of an sRGB-coded one.
pub(super) fn linear(coded: [u8; 3]) -> Rgb {
    Rgb::from_array(coded.map(|channel| linear_from_srgb(f64::from(channel) / 255.0)))
}
