//! Samples of a picture: a few everywhere, all where those differ.

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::caster::{Caster, Sides};
use super::lines::line_coverage;
use super::picture::RenderOptions;
use super::rays::Rays;
use super::shade::Shade;
use crate::colour::Rgb;
use crate::scene::Camera;

/// Samples of a pixel and of those beside it may differ by this share of their mean before the pixel
/// gets all of its samples: about three steps of an 8-bit picture.
const SMOOTH: f64 = 0.03;

/// Pixels between two questions whether to go on.
const BATCH: usize = 2048;

/// Progress, 0..=1, after the first samples.
const FIRST_SHARE: f64 = 0.5;

/// Means over a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pixel {
    pub(super) value: Rgb,
    pub(super) coverage: f64,
    pub(super) line: f64,
    /// Least and greatest values of the samples, by channel.
    range: [Rgb; 2],
}

pub(super) struct Tracer<'a> {
    shade: Shade<'a>,
    caster: Caster,
    rays: Rays,
    options: &'a RenderOptions,
    background: Rgb,
}

/// Samples of a pixel, as places in it, 0..1.
type Places = Vec<(f64, f64)>;

impl<'a> Tracer<'a> {
    pub(super) fn new(
        (camera, options): (&Camera, &'a RenderOptions),
        shade: Shade<'a>,
        background: Rgb,
    ) -> Self {
        let rays = Rays::new(camera, options.width, options.height);
        Self { caster: Caster::new(shade.mesh), shade, rays, options, background }
    }

    /// All pixels, row by row.
    pub(super) fn trace(mut self, observe: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Vec<Pixel> {
        let count = self.options.width as usize * self.options.height as usize;
        let (first, rest) = places_of_samples(self.options.samples.max(1));
        let all: Vec<usize> = (0..count).collect();
        let told = |share: f64| if rest.is_empty() { share } else { share * FIRST_SHARE };
        let mut pixels = self.sample(&all, &first, &mut |share| observe(told(share)));
        if rest.is_empty() {
            return pixels;
        }
        let rough: Vec<usize> =
            all.into_par_iter().filter(|&index| self.is_rough(&pixels, index)).collect();
        let told = |share: f64| FIRST_SHARE + share * (1.0 - FIRST_SHARE);
        let more = self.sample(&rough, &rest, &mut |share| observe(told(share)));
        let share = rest.len() as f64 / (first.len() + rest.len()) as f64;
        for (index, more) in rough.into_iter().zip(more) {
            let pixel = &mut pixels[index];
            pixel.value = pixel.value.lerp(more.value, share);
            pixel.coverage += (more.coverage - pixel.coverage) * share;
            pixel.line += (more.line - pixel.line) * share;
        }
        pixels
    }

    /// Pixels by the samples at `places`; once told to stop, without evaluating light anew.
    fn sample(
        &mut self,
        pixels: &[usize],
        places: &Places,
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Vec<Pixel> {
        let mut found = Vec::with_capacity(pixels.len());
        for batch in pixels.chunks(BATCH) {
            if observe(found.len() as f64 / pixels.len() as f64).is_break() {
                self.shade.interpolate();
            }
            found.par_extend(batch.par_iter().map(|&index| self.pixel(index, places)));
        }
        found
    }

    fn pixel(&self, index: usize, places: &Places) -> Pixel {
        let width = self.options.width as usize;
        let (left, top) = ((index % width) as f64, (index / width) as f64);
        let share = 1.0 / places.len() as f64;
        let mut pixel = Pixel { range: [Rgb::MAX, Rgb::MIN], ..Pixel::default() };
        for &(x, y) in places {
            let (value, coverage, line) = self.look(left + x, top + y);
            pixel.value += value * share;
            pixel.coverage += coverage * share;
            pixel.line += line * share;
            pixel.range = [pixel.range[0].min(value), pixel.range[1].max(value)];
        }
        pixel
    }

    /// Value, coverage and strength of lines at a place in the picture.
    fn look(&self, x: f64, y: f64) -> (Rgb, f64, f64) {
        let direction = self.rays.direction(x, y);
        let hit = self.caster.first(self.rays.eye, direction.normalize(), Sides::Front);
        let Some(hit) = hit else {
            return (self.background, 0.0, 0.0);
        };
        let line = match self.options.view.shows_lines() {
            true => line_coverage(self.shade.mesh, &self.rays, direction, &hit),
            false => 0.0,
        };
        (self.shade.value(&hit), 1.0, line)
    }

    /// True if a pixel's first samples, and those of the pixels beside it, differ.
    fn is_rough(&self, pixels: &[Pixel], index: usize) -> bool {
        let width = self.options.width as usize;
        let (column, row) = (index % width, index / width);
        let (columns, rows) = (around(column, width), around(row, self.options.height as usize));
        let near = rows.flat_map(|row| columns.clone().map(move |column| row * width + column));
        let [mut low, mut high] = pixels[index].range;
        let mut edge = false;
        for pixel in near.map(|index| &pixels[index]) {
            low = low.min(pixel.range[0]);
            high = high.max(pixel.range[1]);
            edge |= pixel.line > 0.0 || (pixel.coverage - pixels[index].coverage).abs() > 0.0;
        }
        edge |= pixels[index].coverage > 0.0 && pixels[index].coverage < 1.0;
        edge || (high - low).max_element() > SMOOTH * (high + low).element_sum() / 6.0
    }
}

/// A place and those beside it, out of `count`.
fn around(place: usize, count: usize) -> std::ops::Range<usize> {
    place.saturating_sub(1)..(place + 2).min(count)
}

/// Places in a pixel of `samples` squared samples: those that come first, one a row and column, and
/// the rest.
fn places_of_samples(samples: u32) -> (Places, Places) {
    let is_first = |i: u32, j: u32| samples < 3 || j == (2 * i + 1) % (samples | 1);
    let all = (0..samples).flat_map(|i| (0..samples).map(move |j| (i, j)));
    let (first, rest): (Vec<_>, Vec<_>) = all.partition(|&(i, j)| is_first(i, j));
    let places = |chosen: Vec<(u32, u32)>| {
        chosen.into_iter().map(|(i, j)| place_of_sample(i, j, samples)).collect()
    };
    (places(first), places(rest))
}

/// Place in a pixel, 0..1, of sample `i`, `j` out of `samples` squared: on a grid turned so that
/// no two samples share a row or column, which grades edges near the axes finest.
fn place_of_sample(i: u32, j: u32, samples: u32) -> (f64, f64) {
    let [i, j, n] = [i, j, samples].map(f64::from);
    ((i + (j + 0.5) / n) / n, (j + (n - i - 0.5) / n) / n)
}
