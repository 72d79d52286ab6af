//! Pictures put together from rectangles and words.

use std::path::Path;

use image::{Rgb, RgbImage};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// sRGB-coded colour behind everything, and that of words.
pub(crate) const GROUND: [u8; 3] = [18, 18, 20];
const INK: [u8; 3] = [235, 235, 235];

/// Height of a line of words, pixels.
pub(crate) const LINE: usize = 24;

/// A picture under way; places are pixels from the left and from the top.
pub(crate) struct Figure(RgbImage);

impl Figure {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        Self(RgbImage::from_pixel(width as u32, height as u32, Rgb(GROUND)))
    }

    pub(crate) fn dot(&mut self, [left, top]: [usize; 2], colour: [u8; 3]) {
        self.0.put_pixel(left as u32, top as u32, Rgb(colour));
    }

    pub(crate) fn square(&mut self, [left, top]: [usize; 2], size: usize, colour: [u8; 3]) {
        for y in top..top + size {
            for x in left..left + size {
                self.dot([x, y], colour);
            }
        }
    }

    /// Writes a line; what would be outside of the picture is left out.
    pub(crate) fn write(&mut self, [left, top]: [usize; 2], text: &str) {
        let (weight, size) = (FontWeight::Regular, RasterHeight::Size16);
        let glyphs = text.chars().map(|c| get_raster(c, weight, size));
        for (glyph, start) in glyphs.zip((left..).step_by(get_raster_width(weight, size))) {
            let Some(glyph) = glyph else { continue };
            for (row, y) in glyph.rows().zip(top as u32..) {
                for (&strength, x) in row.iter().zip(start as u32..) {
                    let Some(pixel) = self.0.get_pixel_mut_checked(x, y) else { continue };
                    pixel.0 = mixed(pixel.0, INK, f64::from(strength) / 255.0);
                }
            }
        }
    }

    /// A line of words after a square of the colour that they explain.
    pub(crate) fn explain(&mut self, [left, top]: [usize; 2], colour: [u8; 3], text: &str) {
        self.square([left, top], 16, colour);
        self.write([left + 24, top], text);
    }

    pub(crate) fn save(&self, path: &str) {
        let path = Path::new(path);
        std::fs::create_dir_all(path.parent().unwrap_or(path)).expect("a place for pictures");
        self.0.save(path).expect("a picture that can be written");
    }
}

/// A colour between two, sRGB-coded, at this share of the way.
pub(crate) fn mixed(from: [u8; 3], to: [u8; 3], share: f64) -> [u8; 3] {
    let between = |from: u8, to: u8| f64::from(from) * (1.0 - share) + f64::from(to) * share;
    std::array::from_fn(|k| between(from[k], to[k]).round() as u8)
}
