//! From radiance to the colours of a screen.

use std::f64::consts::PI;

use image::RgbImage;

use super::false_colour::FalseColour;
use super::legend;
use super::picture::Picture;
use crate::colour::{Rgb, linear_from_srgb, luminance, srgb_from_linear};
use crate::tone::tone_map;

/// How strongly a line in full covers what is under it.
const LINE_STRENGTH: f64 = 0.6;

/// How a picture is shown on a screen.
#[derive(Clone, Debug, PartialEq)]
pub enum Display {
    /// As the eye would see it, through [`tone_map`].
    Exposed {
        /// Factor on radiosity, m²/W, from [`crate::tone::exposure_scale`].
        scale: f64,
    },
    /// As a map of a quantity, with a legend.
    FalseColour(FalseColour),
}

/// The picture in 8-bit sRGB, with its lines and, in false colours, a legend.
pub(super) fn displayed(picture: &Picture, display: &Display) -> RgbImage {
    match display {
        Display::Exposed { scale } => painted(picture, |index| {
            tone_map(picture.radiance[index].as_dvec3() * (PI * scale))
                .to_array()
                .map(srgb_from_linear)
                .into()
        }),
        Display::FalseColour(choice) => {
            let map = choice.map(picture);
            let mut image = painted(picture, |index| map.colour_of_pixel(picture, index));
            legend::draw(&mut image, &map);
            image
        }
    }
}

/// An image of sRGB-coded colours, 0..=1, with the picture's lines over them.
fn painted(picture: &Picture, colour: impl Fn(usize) -> Rgb) -> RgbImage {
    RgbImage::from_fn(picture.width, picture.height, |x, y| {
        let index = y as usize * picture.width as usize + x as usize;
        let line = picture.lines.get(index).copied().unwrap_or(0.0);
        let colour = with_line(colour(index), f64::from(line));
        image::Rgb(colour.to_array().map(|coded| (coded * 255.0).round() as u8))
    })
}

/// Lines are dark on bright surfaces and bright on dark ones.
fn with_line(coded: Rgb, line: f64) -> Rgb {
    let bright = luminance(Rgb::from_array(coded.to_array().map(linear_from_srgb))) > 0.1;
    let ink = if bright { Rgb::ZERO } else { Rgb::ONE };
    coded.lerp(ink, line * LINE_STRENGTH)
}
