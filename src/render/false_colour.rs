//! Colours that stand for numbers.

use std::f64::consts::PI;

use super::picture::Picture;
use super::scale::Scale;
use crate::colour::{LUMENS_PER_WATT, Rgb, luminance};

/// Share of the pixels at either end that the scale leaves out, so that a lamp does not stretch it.
const TAIL: f64 = 0.01;

/// Ratio of values a step apart, in shares of the picture's pixels, that tells lamps from what they
/// light, in the brighter half of the picture. Edges that mix the two fill far less than a step.
const LAMP_RATIO: f64 = 2.5;
const LAMP_STEP: f64 = 0.02;

/// sRGB-coded colour where there is no mesh.
const BACKGROUND: f64 = 0.12;

/// What false colours stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// Luminance-weighted mean of radiosity over the channels, W/m².
    #[default]
    Radiosity,
    /// The same in photometric units, lm/m² (lux), at 683 lm/W.
    LuminousExitance,
}

impl Quantity {
    /// Name and unit, as the legend says them.
    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Radiosity => "radiosity, W/m²",
            Self::LuminousExitance => "luminous exitance, lx",
        }
    }

    fn per_watt(self) -> f64 {
        match self {
            Self::Radiosity => 1.0,
            Self::LuminousExitance => LUMENS_PER_WATT,
        }
    }
}

/// A map of a quantity in the colours of [viridis], which are even to the eye and to the colour-blind.
///
/// [viridis]: https://bids.github.io/colormap/
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FalseColour {
    /// What is shown.
    pub quantity: Quantity,
    /// Ends of the scale, in the quantity's unit; `None` takes them from the picture,
    /// without its darkest and its brightest hundredth and without lamps much brighter than the rest.
    pub range: Option<[f64; 2]>,
}

/// A map settled for one picture.
pub(super) struct Map {
    pub(super) quantity: Quantity,
    pub(super) scale: Scale,
    /// Least and greatest value in the picture; `None` if it shows no mesh.
    pub(super) extremes: Option<[f64; 2]>,
}

impl FalseColour {
    pub(super) fn map(&self, picture: &Picture) -> Map {
        let mut values: Vec<f64> = (0..picture.radiance.len())
            .filter_map(|index| value(picture, index, self.quantity))
            .collect();
        values.sort_by(f64::total_cmp);
        let scale = match self.range {
            Some([low, high]) => Scale::between(low, high),
            None => automatic_scale(&values),
        };
        let extremes = values.first().zip(values.last()).map(|(&low, &high)| [low, high]);
        Map { quantity: self.quantity, scale, extremes }
    }
}

/// A scale for the bulk of `values`, which rise.
fn automatic_scale(values: &[f64]) -> Scale {
    let at = |share: f64| {
        let index = (share * values.len() as f64) as usize;
        values.get(index).copied().unwrap_or(0.0)
    };
    let steps = ((0.5 / LAMP_STEP) as usize..).map(|step| step as f64 * LAMP_STEP);
    let below_lamps = steps
        .take_while(|share| share + LAMP_STEP < 1.0)
        .find(|share| at(share + LAMP_STEP) > LAMP_RATIO * at(*share));
    Scale::of_values(at(TAIL), at(below_lamps.unwrap_or(1.0 - TAIL)))
}

impl Map {
    /// sRGB-coded colour, 0..=1, of a pixel.
    pub(super) fn colour_of_pixel(&self, picture: &Picture, index: usize) -> Rgb {
        let background = Rgb::splat(BACKGROUND);
        let Some(value) = value(picture, index, self.quantity) else {
            return background;
        };
        let colour = colour_at(self.scale.place(value));
        background.lerp(colour, f64::from(picture.coverage[index]))
    }
}

/// sRGB-coded colour, 0..=1, at a place along the scale, 0..=1.
pub(super) fn colour_at(place: f64) -> Rgb {
    let colour = colorous::VIRIDIS.eval_continuous(place);
    Rgb::new(colour.r.into(), colour.g.into(), colour.b.into()) / 255.0
}

/// What the mesh's share of a pixel amounts to.
fn value(picture: &Picture, index: usize, quantity: Quantity) -> Option<f64> {
    let coverage = f64::from(picture.coverage[index]);
    if coverage == 0.0 {
        return None;
    }
    let of_background = (1.0 - coverage) * picture.background;
    let radiance = (picture.radiance[index].as_dvec3() - of_background) / coverage;
    Some(luminance(radiance * PI).max(0.0) * quantity.per_watt())
}
