//! Pictures put together from rectangles and words.

use std::path::Path;

use image::{Rgb, RgbImage};
use radiosity::render::{Letters, fill};

/// sRGB-coded colour behind everything.
pub(crate) const GROUND: [u8; 3] = [18, 18, 20];

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
        fill(&mut self.0, [left, top, size, size].map(|pixels| pixels as u32), colour);
    }

    /// Writes a line; what would be outside of the picture is left out.
    pub(crate) fn write(&mut self, at: [usize; 2], text: &str) {
        let letters = Letters::for_picture(self.0.width(), self.0.height());
        letters.write(&mut self.0, text, at.map(|pixels| pixels as u32));
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
