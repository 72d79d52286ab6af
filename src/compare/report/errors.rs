//! Errors in pictures.

use std::f64::consts::PI;

use image::RgbImage;

use crate::colour::luminance;
use crate::compare::sentences::percent;
use crate::page::colour_maps;
use crate::page::{Markup, html};
use crate::render::map::round_above;
use crate::render::{Picture, smallest_png};

/// Share of the pixels whose errors the scale holds.
const HELD: f64 = 0.98;

/// Steps between the ends of a scale; even, so that one is in the middle.
const STEPS: f64 = 40.0;

/// sRGB-coded grey where there is nothing to compare.
const NOTHING: [u8; 3] = [128; 3];

/// By how much the luminance of a picture differs from another's, as a share of a mean.
pub(super) struct ErrorMap {
    width: u32,
    height: u32,
    /// Row by row; `None` where no surface fills the pixel.
    errors: Vec<Option<f64>>,
}

/// One scale for several maps.
pub(super) struct ErrorScale {
    limit: f64,
}

impl ErrorMap {
    /// Of pictures of one size; `mean` is a radiosity, W/m².
    pub(super) fn new(picture: &Picture, reference: &Picture, mean: f64) -> Self {
        let error = |index: usize| {
            let radiosity = |p: &Picture| PI * luminance(p.values[index].as_dvec3());
            (picture.coverage[index] > 0.999)
                .then(|| (radiosity(picture) - radiosity(reference)) / mean.max(f64::MIN_POSITIVE))
        };
        let errors = (0..picture.values.len()).map(error).collect();
        Self { width: picture.width, height: picture.height, errors }
    }

    /// Sum of the errors' squares over a block of pixels.
    pub(super) fn sum(&self, [left, top]: [u32; 2], [width, height]: [u32; 2]) -> f64 {
        let row = |y: u32| {
            let start = (y * self.width + left) as usize;
            self.errors[start..start + width as usize].iter().flatten().map(|e| e * e).sum::<f64>()
        };
        (top..top + height).map(row).sum()
    }

    /// Blue where there is too little light, orange where there is too much; in steps, which pack better.
    pub(super) fn signed_png(&self, scale: &ErrorScale) -> Vec<u8> {
        let colour = |error: f64| {
            let place = ((error / scale.limit + 1.0) / 2.0).clamp(0.0, 1.0);
            colour_maps::diverging_at((place * STEPS).round() / STEPS)
        };
        let image = RgbImage::from_fn(self.width, self.height, |x, y| {
            let error = self.errors[(y * self.width + x) as usize];
            image::Rgb(error.map_or(NOTHING, colour))
        });
        smallest_png(&image)
    }

    /// The largest magnitude, in words.
    pub(super) fn largest(&self) -> String {
        percent(quantile(&self.sizes(), 1.0))
    }

    /// Half, 95 of a hundred, and all of the pixels.
    pub(super) fn in_words(&self) -> String {
        let sizes = self.sizes();
        let [median, most, worst] = [0.5, 0.95, 1.0].map(|share| percent(quantile(&sizes, share)));
        format!("Half of the pixels are within {median}, 95 % within {most}, all within {worst}.")
    }

    /// Magnitudes, rising.
    fn sizes(&self) -> Vec<f64> {
        let mut sizes: Vec<f64> = self.errors.iter().flatten().map(|error| error.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
    }
}

fn quantile(rising: &[f64], share: f64) -> f64 {
    let last = rising.len().saturating_sub(1);
    rising.get((share * last as f64) as usize).copied().unwrap_or(0.0)
}

impl ErrorScale {
    /// That holds nearly all errors of all maps.
    pub(super) fn of(maps: &[ErrorMap]) -> Self {
        let limits = maps.iter().map(|map| quantile(&map.sizes(), HELD));
        Self { limit: round_above(limits.fold(1e-4, f64::max)) }
    }

    /// The scale with its range.
    pub(super) fn legend(&self) -> Markup {
        let map = colour_maps::diverging();
        let stops: Vec<String> = map
            .chunks_exact(3)
            .step_by(15)
            .map(|c| format!("rgb({} {} {})", c[0], c[1], c[2]))
            .collect();
        let style = format!("background: linear-gradient(to right, {})", stops.join(", "));
        let end = percent(self.limit);
        let marks = [(0, format!("−{end}")), (50, "0".to_owned()), (100, format!("+{end}"))];
        html! {
            div.legend {
                span.title { "Signed error" }
                div.bar {
                    div.strip style=(style) {}
                    div.marks {
                        @for (at, mark) in marks { span style=(format!("left: {at}%")) { (mark) } }
                    }
                }
            }
        }
    }
}
