//! The strip at the picture's foot that says what its colours mean.

use image::{Rgb as Pixel, RgbImage};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use super::false_colour::{Map, colour_at};
use super::scale::short_number;

/// Smallest picture, pixels, that a legend fits into.
const LEAST_SIZE: (u32, u32) = (160, 100);

/// Height of a picture, pixels, from which the letters are larger.
const LARGE_PICTURE: u32 = 1000;

/// sRGB-coded colour of the strip's ground.
const GROUND: [u8; 3] = [16, 16, 16];

/// sRGB-coded colour of letters and marks.
const INK: [u8; 3] = [240, 240, 240];

/// Draws the legend of `map` over the foot of `image`; a tiny image is left alone.
pub(super) fn draw(image: &mut RgbImage, map: &Map) {
    if image.width() < LEAST_SIZE.0 || image.height() < LEAST_SIZE.1 {
        return;
    }
    let layout = Layout::new(image.width(), image.height());
    for y in layout.top..image.height() {
        for x in 0..image.width() {
            image.put_pixel(x, y, Pixel(GROUND));
        }
    }
    layout.draw_heading(image, map);
    layout.draw_bar(image);
    layout.draw_marks(image, map);
}

/// Where things are, pixels: a heading, the bar under it, marks and their numbers under the bar.
struct Layout {
    size: RasterHeight,
    letter: u32,
    line: u32,
    /// Empty space around the strip's contents.
    margin: u32,
    top: u32,
    bar_top: u32,
    bar_left: u32,
    bar_width: u32,
}

impl Layout {
    fn new(width: u32, height: u32) -> Self {
        let size = if height < LARGE_PICTURE { RasterHeight::Size16 } else { RasterHeight::Size24 };
        let letter = get_raster_width(FontWeight::Regular, size) as u32;
        let line = size.val() as u32;
        let margin = line / 4;
        let top = height - (3 * line + 4 * margin);
        // Numbers are centred under their marks and may stand out at the ends.
        let bar_left = 3 * letter;
        let bar_width = width - 2 * bar_left;
        Self {
            size,
            letter,
            line,
            margin,
            top,
            bar_top: top + margin + line + margin,
            bar_left,
            bar_width,
        }
    }

    fn draw_heading(&self, image: &mut RgbImage, map: &Map) {
        let label = map.quantity.label();
        let top = self.top + self.margin;
        self.write(image, label, self.bar_left, top);
        let Some([low, high]) = map.extremes else {
            return;
        };
        let range = format!("min {}  max {}", short_number(low), short_number(high));
        let wanted = (label.chars().count() + 2 + range.chars().count()) as u32 * self.letter;
        if wanted <= self.bar_width {
            let left = self.bar_left + self.bar_width - range.chars().count() as u32 * self.letter;
            self.write(image, &range, left, top);
        }
    }

    fn draw_bar(&self, image: &mut RgbImage) {
        for x in 0..self.bar_width {
            let place = f64::from(x) / f64::from((self.bar_width - 1).max(1));
            let colour = colour_at(place).to_array().map(|coded| (coded * 255.0).round() as u8);
            for y in 0..self.line {
                image.put_pixel(self.bar_left + x, self.bar_top + y, Pixel(colour));
            }
        }
    }

    fn draw_marks(&self, image: &mut RgbImage, map: &Map) {
        let most = (self.bar_width / (9 * self.letter)).clamp(2, 10);
        let foot = self.bar_top + self.line;
        let mut free_from = 0;
        for mark in map.scale.marks(most as usize) {
            let along = map.scale.place(mark) * f64::from(self.bar_width - 1);
            let x = self.bar_left + along.round() as u32;
            for y in foot..foot + self.margin {
                image.put_pixel(x, y, Pixel(INK));
            }
            let text = short_number(mark);
            let width = text.chars().count() as u32 * self.letter;
            let left = x.saturating_sub(width / 2).min(image.width().saturating_sub(width));
            if left >= free_from {
                self.write(image, &text, left, foot + self.margin);
                free_from = left + width + self.letter;
            }
        }
    }

    fn write(&self, image: &mut RgbImage, text: &str, left: u32, top: u32) {
        let glyphs = text.chars().filter_map(|c| get_raster(c, FontWeight::Regular, self.size));
        for (glyph, position) in glyphs.zip(0..) {
            for (row, y) in glyph.rows().zip(top..) {
                for (&intensity, x) in row.iter().zip(left + position * self.letter..) {
                    blend_ink(image, x, y, intensity);
                }
            }
        }
    }
}

fn blend_ink(image: &mut RgbImage, x: u32, y: u32, intensity: u8) {
    if let Some(pixel) = image.get_pixel_mut_checked(x, y) {
        for (under, ink) in pixel.0.iter_mut().zip(INK) {
            let share = f64::from(intensity) / 255.0;
            *under = (f64::from(*under) * (1.0 - share) + f64::from(ink) * share).round() as u8;
        }
    }
}
