//! Words in pictures.

use image::{Rgb as Pixel, RgbImage};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Height of a picture, pixels, from which the letters are larger.
const LARGE_PICTURE: u32 = 1000;

/// sRGB-coded colour of letters and marks.
pub(super) const INK: [u8; 3] = [240, 240, 240];

/// The same of what is under a mark.
const GROUND: [u8; 3] = [20, 20, 20];

/// Letters of one width and height.
#[derive(Clone, Copy, Debug)]
pub struct Letters {
    size: RasterHeight,
    /// Pixels from one letter to the next.
    pub width: u32,
    /// Pixels of a line.
    pub height: u32,
}

impl Letters {
    /// Letters that suit a picture of this size, pixels.
    pub fn for_picture(width: u32, height: u32) -> Self {
        let large = width.min(height) >= LARGE_PICTURE;
        let size = if large { RasterHeight::Size24 } else { RasterHeight::Size16 };
        let width = get_raster_width(FontWeight::Regular, size) as u32;
        Self { size, width, height: size.val() as u32 }
    }

    /// Pixels that a text is wide.
    pub fn length(&self, text: &str) -> u32 {
        text.chars().count() as u32 * self.width
    }

    /// Writes a line; what would be outside of the image is left out.
    pub fn write(&self, image: &mut RgbImage, text: &str, [left, top]: [u32; 2]) {
        let glyphs = text.chars().filter_map(|c| get_raster(c, FontWeight::Regular, self.size));
        for (glyph, position) in glyphs.zip(0..) {
            for (row, y) in glyph.rows().zip(top..) {
                for (&intensity, x) in row.iter().zip(left + position * self.width..) {
                    blend_ink(image, x, y, intensity);
                }
            }
        }
    }
}

/// Writes a word into the upper left corner, on a ground of its own, so that it can be read over any picture.
pub(super) fn mark(image: &mut RgbImage, word: &str) {
    let letters = Letters::for_picture(image.width(), image.height());
    let margin = letters.height / 4;
    let size = [letters.length(word) + 2 * margin, letters.height + 2 * margin];
    fill(image, [0, 0, size[0], size[1]], GROUND);
    letters.write(image, word, [margin, margin]);
}

fn blend_ink(image: &mut RgbImage, x: u32, y: u32, intensity: u8) {
    if let Some(pixel) = image.get_pixel_mut_checked(x, y) {
        for (under, ink) in pixel.0.iter_mut().zip(INK) {
            let share = f64::from(intensity) / 255.0;
            *under = (f64::from(*under) * (1.0 - share) + f64::from(ink) * share).round() as u8;
        }
    }
}

/// Fills a rectangle: left, top, width and height in pixels.
pub fn fill(image: &mut RgbImage, [left, top, width, height]: [u32; 4], colour: [u8; 3]) {
    for y in top..(top + height).min(image.height()) {
        for x in left..(left + width).min(image.width()) {
            image.put_pixel(x, y, Pixel(colour));
        }
    }
}
