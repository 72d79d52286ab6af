//! Colours that stand for numbers.

use super::colours;
use super::picture::Picture;
use super::scale::Scale;
pub(crate) use super::scale::{linear_marks, logarithmic_marks, round_above, short_number};
use super::view::View;
use crate::colour::Rgb;

/// Share of the pixels at either end that the scale leaves out, so that a lamp does not stretch it.
const TAIL: f64 = 0.01;

/// Ratio of values a step apart, in shares of the picture's pixels, that tells lamps from what they
/// light, in the brighter half of the picture. Edges that mix the two fill far less than a step.
const LAMP_RATIO: f64 = 2.5;
const LAMP_STEP: f64 = 0.02;

/// Ends of the scale of errors: 1 is what is allowed, and the same in all pictures.
const ERRORS: [f64; 2] = [0.02, 50.0];

/// About as many lines of equal value as a picture may have.
const ISOLINES: usize = 8;

/// sRGB-coded colour where there is no mesh.
const BACKGROUND: f64 = 0.12;

/// A map from values to colours, settled for one picture.
pub(super) struct ColourMap {
    view: View,
    pub(super) scale: Scale,
    /// Least and greatest value in the picture; `None` if it shows no mesh.
    pub(super) extremes: Option<[f64; 2]>,
}

impl ColourMap {
    /// A map for a picture; without a range, its ends are found without the picture's darkest and
    /// brightest hundredth and without lamps much brighter than the rest.
    pub(super) fn new(picture: &Picture, range: Option<[f64; 2]>) -> Self {
        let view = picture.view;
        let mut numbers: Vec<f64> =
            (0..picture.values.len()).filter_map(|index| number(picture, index)).collect();
        numbers.sort_by(f64::total_cmp);
        let fixed = (view == View::Error).then_some(ERRORS);
        let scale = match range.or(fixed) {
            Some([low, high]) => Scale::between(low, high),
            // Shadows are black: shares of the brightest tell more than powers of ten.
            None if view == View::Direct => Scale::between(0.0, automatic_scale(&numbers).high()),
            None => automatic_scale(&numbers),
        };
        let extremes = numbers.first().zip(numbers.last()).map(|(&low, &high)| [low, high]);
        Self { view, scale, extremes }
    }

    /// sRGB-coded colour, 0..=1, of a pixel.
    pub(super) fn colour_of_pixel(&self, picture: &Picture, index: usize) -> Rgb {
        let Some(number) = number(picture, index) else {
            return Rgb::splat(BACKGROUND);
        };
        let colour = colours::at(self.scale.place(number));
        over_background(colour, picture.coverage[index])
    }

    /// True if a line of equal value passes between a pixel and the one to its right or below it, in
    /// views that have such lines.
    pub(super) fn has_isoline(&self, picture: &Picture, index: usize) -> bool {
        if self.view != View::Illuminance {
            return false;
        }
        let width = picture.width as usize;
        let right = Some(index + 1).filter(|right| !right.is_multiple_of(width));
        let below = Some(index + width).filter(|&below| below < picture.values.len());
        let marks = self.scale.marks(ISOLINES);
        right.into_iter().chain(below).any(|other| {
            let numbers = number(picture, index).zip(number(picture, other));
            numbers.is_some_and(|(a, b)| {
                let (low, high) = (a.min(b), a.max(b));
                // A jump over much of the scale is an edge of things, not a slope.
                let is_slope = self.scale.place(high) - self.scale.place(low) < 0.05;
                is_slope && marks.iter().any(|&mark| low < mark && mark <= high)
            })
        })
    }
}

/// A scale for the bulk of `values`, which rise.
fn automatic_scale(values: &[f64]) -> Scale {
    let [low, high] = bulk(values);
    Scale::of_values(low, high)
}

/// Ends of the bulk of `values`, which rise: without the least and the greatest hundredth, and
/// without lamps much brighter than the rest.
pub(crate) fn bulk(values: &[f64]) -> [f64; 2] {
    let at = |share: f64| {
        let index = (share * values.len() as f64) as usize;
        values.get(index).copied().unwrap_or(0.0)
    };
    let steps = ((0.5 / LAMP_STEP) as usize..).map(|step| step as f64 * LAMP_STEP);
    let below_lamps = steps
        .take_while(|share| share + LAMP_STEP < 1.0)
        .find(|share| at(share + LAMP_STEP) > LAMP_RATIO * at(*share));
    [at(TAIL), at(below_lamps.unwrap_or(1.0 - TAIL))]
}

/// sRGB-coded colour, 0..=1, of a pixel that the mesh covers by a share with `colour`.
pub(super) fn over_background(colour: Rgb, coverage: f32) -> Rgb {
    Rgb::splat(BACKGROUND).lerp(colour, f64::from(coverage))
}

/// The mean value of the mesh in a pixel, background left out; `None` where there is no mesh.
pub(super) fn value_of_mesh(picture: &Picture, index: usize) -> Option<Rgb> {
    let coverage = f64::from(picture.coverage[index]);
    let of_background = (1.0 - coverage) * picture.background;
    (coverage > 0.0).then(|| (picture.values[index].as_dvec3() - of_background) / coverage)
}

/// What the mesh's share of a pixel amounts to.
fn number(picture: &Picture, index: usize) -> Option<f64> {
    value_of_mesh(picture, index).map(|value| picture.view.number(value))
}
