//! The strip below a picture that says what it shows; the picture itself stays whole.

use image::{GenericImage, Rgb as Pixel, RgbImage};

use super::colours::{self, Swatch};
use super::letters::{INK, Letters, fill};
use super::map::ColourMap;
use super::scale::{Scale, short_number};

/// Narrowest picture, pixels, that a legend fits under.
const LEAST_WIDTH: u32 = 96;

/// sRGB-coded colour of the strip's ground.
const GROUND: [u8; 3] = [16, 16, 16];

/// What is said about a picture.
pub(super) struct Legend<'a> {
    /// What is shown, with its unit.
    pub(super) label: &'static str,
    /// Said to the right of the label, or below it.
    pub(super) remark: String,
    pub(super) body: LegendBody<'a>,
}

/// What colours mean.
pub(super) enum LegendBody<'a> {
    Nothing,
    Scale(&'a Scale),
    Key(&'a [Swatch]),
}

impl ColourMap {
    /// Least and greatest value.
    pub(super) fn extremes_in_words(&self) -> String {
        self.extremes.map_or_else(String::new, |[low, high]| {
            format!("min {}  max {}", short_number(low), short_number(high))
        })
    }
}

/// `picture` with its legend below it; a very narrow one is left alone.
pub(super) fn below(picture: &RgbImage, legend: &Legend<'_>) -> RgbImage {
    if picture.width() < LEAST_WIDTH {
        return picture.clone();
    }
    let letters = Letters::for_picture(picture.width(), picture.height());
    let layout = LegendLayout::new(letters, picture.width(), legend);
    let height = picture.height() + layout.height;
    let mut image = RgbImage::from_pixel(picture.width(), height, Pixel(GROUND));
    // The larger image holds the smaller one.
    let _ = image.copy_from(picture, 0, 0);
    layout.draw(&mut image, picture.height(), &legend.body);
    image
}

/// Where things are, pixels from the top and left of the strip.
struct LegendLayout {
    letters: Letters,
    /// Empty space around things.
    margin: u32,
    /// Label and remark, each with its place.
    words: Vec<(String, [u32; 2])>,
    /// Places of a key's swatches.
    swatches: Vec<[u32; 2]>,
    body_top: u32,
    bar_left: u32,
    bar_width: u32,
    height: u32,
}

impl LegendLayout {
    fn new(letters: Letters, width: u32, legend: &Legend<'_>) -> Self {
        let margin = letters.height / 4;
        let line = letters.height + margin;
        let mut layout = Self {
            letters,
            margin,
            words: Vec::new(),
            swatches: Vec::new(),
            body_top: margin,
            // Numbers are centred under their marks and may stand out at the ends.
            bar_left: 3 * letters.width,
            bar_width: width - 6 * letters.width,
            height: 0,
        };
        layout.place_words(width, legend);
        let body = match legend.body {
            LegendBody::Nothing => 0,
            LegendBody::Scale(_) => 2 * line + margin,
            LegendBody::Key(key) => layout.place_swatches(width, key),
        };
        layout.height = layout.body_top + body;
        layout
    }

    /// Label and remark on one line if they fit, else one below the other, broken where need be.
    fn place_words(&mut self, width: u32, legend: &Legend<'_>) {
        let Self { letters, bar_left, bar_width, .. } = *self;
        let both =
            letters.length(legend.label) + 2 * letters.width + letters.length(&legend.remark);
        if both <= bar_width {
            let right = width - bar_left - letters.length(&legend.remark);
            self.words.push((legend.label.to_owned(), [bar_left, self.body_top]));
            self.words.push((legend.remark.clone(), [right, self.body_top]));
            self.body_top += letters.height + self.margin;
            return;
        }
        let most = ((width - 2 * self.margin) / letters.width) as usize;
        let text = [legend.label, &legend.remark];
        for line in text.into_iter().flat_map(|text| lines(text, most)) {
            self.words.push((line, [self.margin, self.body_top]));
            self.body_top += letters.height + self.margin;
        }
    }

    /// Swatches side by side, in as many rows as they need. Returns the height of all.
    fn place_swatches(&mut self, width: u32, key: &[Swatch]) -> u32 {
        let line = self.letters.height + self.margin;
        let first = self.bar_left.min(self.letters.width);
        let (mut left, mut top) = (first, 0);
        for swatch in key {
            let length = self.swatch_width() + self.letters.length(&swatch.name);
            if left > first && left + length > width {
                (left, top) = (first, top + line);
            }
            self.swatches.push([left, self.body_top + top]);
            left += length + 2 * self.letters.width;
        }
        top + line
    }

    /// Pixels from the left of a swatch to the left of its name.
    fn swatch_width(&self) -> u32 {
        self.letters.height + self.margin
    }

    fn draw(&self, image: &mut RgbImage, strip: u32, body: &LegendBody<'_>) {
        for (text, [left, top]) in &self.words {
            self.letters.write(image, text, [*left, strip + top]);
        }
        match body {
            LegendBody::Nothing => {}
            LegendBody::Scale(scale) => self.draw_scale(image, strip + self.body_top, scale),
            LegendBody::Key(key) => {
                for (swatch, &[left, top]) in key.iter().zip(&self.swatches) {
                    let size = self.letters.height;
                    fill(image, [left, strip + top, size, size], swatch.colour);
                    let name = [left + self.swatch_width(), strip + top];
                    self.letters.write(image, &swatch.name, name);
                }
            }
        }
    }

    /// The bar, and marks with their numbers under it.
    fn draw_scale(&self, image: &mut RgbImage, top: u32, scale: &Scale) {
        for x in 0..self.bar_width {
            let place = f64::from(x) / f64::from((self.bar_width - 1).max(1));
            let colour = colours::at(place).to_array().map(|coded| (coded * 255.0).round() as u8);
            fill(image, [self.bar_left + x, top, 1, self.letters.height], colour);
        }
        let foot = top + self.letters.height;
        for Mark { at, text, left } in self.marks(scale, image.width()) {
            fill(image, [at, foot, 1, self.margin], INK);
            self.letters.write(image, &text, [left, foot + self.margin]);
        }
    }

    /// As many marks as have room for their numbers; two at least.
    fn marks(&self, scale: &Scale, width: u32) -> Vec<Mark> {
        let most = (self.bar_width / (5 * self.letters.width)).clamp(2, 10) as usize;
        let fitting = (2..=most).rev().map(|count| self.placed(&scale.marks(count), scale, width));
        fitting.into_iter().find(|marks| self.has_room(marks)).unwrap_or_else(|| {
            // The first and the last, as far apart as the picture is wide.
            let mut marks = self.placed(&scale.marks(2), scale, width);
            marks.drain(1..marks.len().saturating_sub(1).max(1));
            if let [first, last] = marks.as_mut_slice() {
                first.left = 0;
                last.left = width.saturating_sub(self.letters.length(&last.text));
            }
            marks
        })
    }

    /// Marks with their numbers centred under them, moved where they would stand out of the picture.
    fn placed(&self, marks: &[f64], scale: &Scale, width: u32) -> Vec<Mark> {
        let place = |&mark: &f64| {
            let along = scale.place(mark) * f64::from(self.bar_width - 1);
            let (at, text) = (self.bar_left + along.round() as u32, short_number(mark));
            let length = self.letters.length(&text);
            let left = at.saturating_sub(length / 2).min(width.saturating_sub(length));
            Mark { at, text, left }
        };
        marks.iter().map(place).collect()
    }

    /// True if there is a letter's width at least between all numbers.
    fn has_room(&self, marks: &[Mark]) -> bool {
        marks.windows(2).all(|pair| {
            pair[0].left + self.letters.length(&pair[0].text) + self.letters.width <= pair[1].left
        })
    }
}

/// A mark under the bar: pixels from the left to it, its number, and from the left to that.
struct Mark {
    at: u32,
    text: String,
    left: u32,
}

/// A text in lines of at most `most` letters, broken between words; a longer word stays whole.
fn lines(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn every_scale_has_two_numbers_that_can_be_read(
            low in 1e-6..1e3_f64, decades in 0.01..9.0_f64, width in LEAST_WIDTH..1400,
        ) {
            let scale = Scale::of_values(low, low * 10_f64.powf(decades));
            let body = LegendBody::Scale(&scale);
            let legend = Legend { label: "radiosity, W/m²", remark: String::new(), body };
            let layout = LegendLayout::new(Letters::for_picture(width, width), width, &legend);
            let marks = layout.marks(&scale, width);
            prop_assert!(marks.len() >= 2);
            let texts: Vec<&str> = marks.iter().map(|mark| mark.text.as_str()).collect();
            let longest = texts.iter().map(|text| layout.letters.length(text)).max().unwrap_or(0);
            let is_readable = layout.has_room(&marks) || 2 * longest + layout.letters.width > width;
            prop_assert!(is_readable, "{texts:?} in {width} pixels");
        }
    }
}
