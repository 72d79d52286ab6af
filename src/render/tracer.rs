//! Samples of a picture: a few everywhere, all where those differ.
//!
//! Evaluating light anew is dear: it is done once in every pixel and, where that or the first samples
//! of the interpolated picture differ from what is beside them, at all samples.

use std::ops::{ControlFlow, Range};
use std::time::Instant;

use glam::DVec3;
use rayon::prelude::*;

use super::caster::{Caster, MeshHit, VisibleSides};
use super::lines::line_coverage;
use super::options::RenderOptions;
use super::rays::CameraRays;
use super::shade::{Gather, Shade, ShadedValue};
use crate::colour::Rgb;
use crate::scene::Camera;
use crate::watch::{Enough, Pace, watched};

/// Samples of a pixel and of those beside it may differ by this share of their mean before the pixel
/// gets all of its samples: about three steps of an 8-bit picture.
const SMOOTH: f64 = 0.03;

/// Means over a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pixel {
    pub(super) value: Rgb,
    /// That of the white of the pictures on what is seen.
    pub(super) white: Rgb,
    pub(super) coverage: f64,
    pub(super) line: f64,
    /// Least and greatest values of the samples, by channel.
    range: [Rgb; 2],
}

pub(super) struct PixelTracer<'a> {
    shade: Shade<'a>,
    caster: Caster,
    rays: CameraRays,
    options: &'a RenderOptions,
    background: Rgb,
}

/// A place in a pixel, 0..1 across and down.
type PixelOffset = [f64; 2];

impl<'a> PixelTracer<'a> {
    pub(super) fn new(
        camera: &Camera,
        options: &'a RenderOptions,
        shade: Shade<'a>,
        background: Rgb,
    ) -> Self {
        let rays = CameraRays::new(camera, options.width, options.height);
        Self { caster: Caster::new(shade.mesh), shade, rays, options, background }
    }

    /// All pixels, row by row; once told to stop, without evaluating light anew.
    pub(super) fn trace(
        self,
        gather: Gather<'_>,
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Vec<Pixel> {
        let count = self.options.width as usize * self.options.height as usize;
        let (first, rest) = places_of_samples(self.options.samples.max(1));
        let all: Vec<usize> = (0..count).collect();
        let mut batches = SampleBatches { tracer: &self, gather, observe, is_over: false };
        if rest.is_empty() {
            return batches.sample(&all, &first, 0.0..1.0);
        }
        let mut pixels = batches.pixels(&all, &first, 0.0..0.1);
        if gather.is_some() {
            let changes = batches.changes(&all, first[first.len() / 2], 0.1..0.5);
            pixels.iter_mut().zip(changes).for_each(|(pixel, change)| pixel.change(change));
        }
        let rough: Vec<usize> =
            all.into_par_iter().filter(|&index| self.is_rough(&pixels, index)).collect();
        if gather.is_some() {
            let places = [first, rest].concat();
            let found = batches.sample(&rough, &places, 0.5..1.0);
            rough.into_iter().zip(found).for_each(|(index, pixel)| pixels[index] = pixel);
        } else {
            let share = rest.len() as f64 / (first.len() + rest.len()) as f64;
            // Pixels for which there is no time stay as they are.
            for (index, more) in rough.iter().zip(batches.more(&rough, &rest, 0.1..1.0)) {
                pixels[*index].add(&more, share);
            }
        }
        pixels
    }

    fn pixel(&self, index: usize, places: &[PixelOffset], gather: Gather<'_>) -> Pixel {
        let share = 1.0 / places.len() as f64;
        let mut pixel = Pixel { range: [Rgb::MAX, Rgb::MIN], ..Pixel::default() };
        for &place in places {
            let (ShadedValue { value, white }, coverage, line) = match self.look(index, place) {
                Some((direction, hit)) => {
                    (self.shade.value(&hit, gather), 1.0, self.line(direction, &hit))
                }
                None => (self.beyond(index, place).into(), 0.0, 0.0),
            };
            pixel.value += value * share;
            pixel.white += white * share;
            pixel.coverage += coverage * share;
            pixel.line += line * share;
            pixel.range = [pixel.range[0].min(value), pixel.range[1].max(value)];
        }
        pixel
    }

    /// By how much evaluating light anew changes the value at a place in a pixel.
    fn change(&self, index: usize, place: PixelOffset, gather: Gather<'_>) -> ShadedValue {
        self.look(index, place).map_or(ShadedValue::default(), |(_, hit)| {
            let [anew, known] = [gather, None].map(|gather| self.shade.value(&hit, gather));
            ShadedValue { value: anew.value - known.value, white: anew.white - known.white }
        })
    }

    /// The direction, not of unit length, of a place in a pixel.
    fn direction(&self, index: usize, [x, y]: PixelOffset) -> DVec3 {
        let width = self.options.width as usize;
        let (left, top) = ((index % width) as f64, (index / width) as f64);
        self.rays.direction(left + x, top + y)
    }

    /// What is seen where there is no mesh.
    fn beyond(&self, index: usize, place: PixelOffset) -> Rgb {
        if !self.options.view.shows_light() {
            return self.background;
        }
        let direction = self.direction(index, place).normalize();
        let sky = self.options.sky.iter().map(|named| named.light.radiance(direction));
        self.background + sky.sum::<Rgb>()
    }

    /// What is met at a place in a pixel, and in which direction.
    fn look(&self, index: usize, place: PixelOffset) -> Option<(DVec3, MeshHit)> {
        let direction = self.direction(index, place);
        let is_there = |hit: &MeshHit| self.shade.is_there(hit);
        let unit = direction.normalize();
        let hit = self.caster.first_of(self.rays.eye, unit, VisibleSides::Front, is_there)?;
        Some((direction, hit))
    }

    /// Strength of the mesh's lines.
    fn line(&self, direction: DVec3, hit: &MeshHit) -> f64 {
        match self.options.view.shows_lines() {
            true => line_coverage(self.shade.mesh, &self.rays, direction, hit),
            false => 0.0,
        }
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

impl Pixel {
    /// Adds samples that are a `share` of all.
    fn add(&mut self, more: &Self, share: f64) {
        self.value = self.value.lerp(more.value, share);
        self.white = self.white.lerp(more.white, share);
        self.coverage += (more.coverage - self.coverage) * share;
        self.line += (more.line - self.line) * share;
    }

    /// Changes all samples alike.
    fn change(&mut self, change: ShadedValue) {
        self.value = (self.value + change.value).max(Rgb::ZERO);
        self.white = (self.white + change.white).max(Rgb::ZERO);
        self.range = self.range.map(|value| value + change.value);
    }
}

/// Samples on their way, in batches that may be the last ones.
struct SampleBatches<'a, 'b> {
    tracer: &'a PixelTracer<'a>,
    gather: Gather<'a>,
    observe: &'b mut dyn FnMut(f64) -> ControlFlow<()>,
    /// True once told to stop: what is still to be done must be quick.
    is_over: bool,
}

impl<'a> SampleBatches<'a, '_> {
    /// Pixels by the samples at `places`, told as a part of the whole.
    fn sample(&mut self, pixels: &[usize], places: &[PixelOffset], part: Range<f64>) -> Vec<Pixel> {
        let tracer = self.tracer;
        self.batches(pixels, part, |index, gather, _| tracer.pixel(index, places, gather))
    }

    /// All pixels by the samples at `places` without light anew; by one of them when told to stop.
    fn pixels(&mut self, pixels: &[usize], places: &[PixelOffset], part: Range<f64>) -> Vec<Pixel> {
        let tracer = self.tracer;
        self.batches(pixels, part, |index, _, is_over| {
            tracer.pixel(index, if is_over { &places[..1] } else { places }, None)
        })
    }

    /// More samples without light anew, of the first of the pixels only when told to stop.
    fn more(&mut self, pixels: &[usize], places: &[PixelOffset], part: Range<f64>) -> Vec<Pixel> {
        let tracer = self.tracer;
        let more = self.batches(pixels, part, |index, _, is_over| {
            (!is_over).then(|| tracer.pixel(index, places, None))
        });
        more.into_iter().map_while(|pixel| pixel).collect()
    }

    /// Changes by evaluating light anew at one place of each pixel.
    fn changes(
        &mut self,
        pixels: &[usize],
        place: PixelOffset,
        part: Range<f64>,
    ) -> Vec<ShadedValue> {
        let tracer = self.tracer;
        self.batches(pixels, part, |index, gather, _| tracer.change(index, place, gather))
    }

    fn batches<T: Send>(
        &mut self,
        pixels: &[usize],
        part: Range<f64>,
        find: impl Fn(usize, Gather<'a>, bool) -> T + Sync,
    ) -> Vec<T> {
        let mut found = Vec::with_capacity(pixels.len());
        let mut pace = Pace::new();
        while found.len() < pixels.len() {
            let done = found.len() as f64 / pixels.len() as f64;
            let done = part.start + done * (part.end - part.start);
            if (self.observe)(done).is_break() {
                (self.gather, self.is_over) = (None, true);
            }
            let (gather, is_over, start) = (self.gather, self.is_over, Instant::now());
            let batch = pace.batch(&pixels[found.len()..]);
            let each = |enough: &Enough| -> Vec<T> {
                let one = |&index: &usize| match enough.is_said() {
                    true => find(index, None, true),
                    false => find(index, gather, is_over),
                };
                batch.par_iter().map(one).collect()
            };
            found.extend(watched(each, || (self.observe)(done)));
            pace.learn(batch.len(), start.elapsed());
        }
        found
    }
}

/// A place and those beside it, out of `count`.
fn around(place: usize, count: usize) -> Range<usize> {
    place.saturating_sub(1)..(place + 2).min(count)
}

/// Places in a pixel of `samples` squared samples: those that come first, one a row and column, and
/// the rest.
fn places_of_samples(samples: u32) -> (Vec<PixelOffset>, Vec<PixelOffset>) {
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
fn place_of_sample(i: u32, j: u32, samples: u32) -> PixelOffset {
    let [i, j, n] = [i, j, samples].map(f64::from);
    [(i + (j + 0.5) / n) / n, (j + (n - i - 0.5) / n) / n]
}
