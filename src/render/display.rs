//! From values to the colours of a screen.

use std::f64::consts::PI;

use glam::Vec3;
use image::RgbImage;

use super::legend::{self, Legend, LegendBody};
use super::letters;
use super::map::{ColourMap, over_background, value_of_mesh};
use super::picture::Picture;
use super::view::View;
use crate::colour::{Rgb, linear_from_srgb, luminance, srgb_from_linear};
use crate::tone::{tone_map, tone_map_picture};

/// How strongly a line in full covers what is under it.
const LINE_STRENGTH: f64 = 0.6;

/// The same of lines of equal value.
const ISOLINE_STRENGTH: f64 = 0.75;

/// What a picture says of light that is not yet what it will be.
const UNFINISHED: &str = "unfinished";

/// How a picture is shown on a screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Display {
    /// Factor on radiosity, m²/W, from [`crate::tone::exposure_scale`], before [`tone_map`]; for light
    /// and wireframes.
    pub scale: f64,
    /// Ends of the scale of false colours, in the unit of the view; `None` takes them from the
    /// picture, without its darkest and its brightest hundredth and without lamps much brighter
    /// than the rest.
    pub range: Option<[f64; 2]>,
}

impl Display {
    /// A display of this factor on radiosity, m²/W, and a scale of false colours as the picture asks.
    pub fn exposed(scale: f64) -> Self {
        Self { scale, range: None }
    }
}

/// The picture in 8-bit sRGB, with its lines and, below it, the legend of its view.
pub fn displayed(picture: &Picture, display: &Display) -> RgbImage {
    let exposed = |index: usize| -> Rgb {
        let exposed = |radiance: Vec3| radiance.as_dvec3() * PI * display.scale;
        let value = exposed(picture.values[index]);
        coded(match picture.whites.get(index) {
            Some(&white) => tone_map_picture(value, exposed(white)),
            None => tone_map(value),
        })
    };
    let label = picture.view.label();
    let legend = |remark: &str, body| Legend { label, remark: remark.to_owned(), body };
    match picture.view {
        View::Light => painted(picture, exposed),
        View::Wireframe => {
            let image = painted(picture, exposed);
            legend::below(&image, &legend(&picture.caption, LegendBody::Nothing))
        }
        view if view.shows_colours() => {
            let colour = |index: usize| {
                let value = value_of_mesh(picture, index).unwrap_or_default();
                over_background(coded(value), picture.coverage[index])
            };
            let image = painted(picture, colour);
            legend::below(&image, &legend(&picture.caption, LegendBody::Key(&picture.key)))
        }
        _ => {
            let map = ColourMap::new(picture, display.range);
            let colour = |index: usize| {
                let line = map.has_isoline(picture, index);
                let strength = if line { ISOLINE_STRENGTH } else { 0.0 };
                with_line(map.colour_of_pixel(picture, index), strength)
            };
            let image = painted(picture, colour);
            legend::below(&image, &legend(&map.extremes_in_words(), LegendBody::Scale(&map.scale)))
        }
    }
}

fn coded(linear: Rgb) -> Rgb {
    linear.to_array().map(srgb_from_linear).into()
}

/// An image of sRGB-coded colours, 0..=1, with the picture's lines and its mark over them.
fn painted(picture: &Picture, colour: impl Fn(usize) -> Rgb) -> RgbImage {
    let mut image = RgbImage::from_fn(picture.width, picture.height, |x, y| {
        let index = y as usize * picture.width as usize + x as usize;
        let line = picture.lines.get(index).copied().unwrap_or(0.0);
        let colour = with_line(colour(index), f64::from(line) * LINE_STRENGTH);
        image::Rgb(colour.to_array().map(|coded| (coded * 255.0).round() as u8))
    });
    if picture.unfinished {
        letters::mark(&mut image, UNFINISHED);
    }
    image
}

/// Lines are dark on bright surfaces and bright on dark ones.
fn with_line(coded: Rgb, strength: f64) -> Rgb {
    let bright = luminance(Rgb::from_array(coded.to_array().map(linear_from_srgb))) > 0.1;
    let ink = if bright { Rgb::ZERO } else { Rgb::ONE };
    coded.lerp(ink, strength)
}
