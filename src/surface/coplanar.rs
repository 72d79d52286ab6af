//! Regions in one plane: whether they are, and which of two in one place is meant.

use std::cmp::Reverse;

use glam::DVec3;

use super::merge::PlanarRegion;
use crate::colour::luminance;
use crate::geometry::polygon::area;
use crate::scene::Scene;

/// True if two regions lie in one plane and face the same way.
pub(super) fn are_level(outer: &PlanarRegion, inner: &PlanarRegion, epsilon: f64) -> bool {
    let level = |p: DVec3| outer.plane.height(p).abs() <= epsilon;
    let mut corners = inner.rings.iter().flatten().map(|&p| inner.plane.lift(p));
    inner.plane.normal.dot(outer.plane.normal) > 0.999 && corners.all(level)
}

/// Which of two regions in one place is meant: the greater.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct Rank {
    /// What glows is meant.
    glow: f64,
    /// Else what is smaller; m², negative.
    smallness: f64,
    /// Else what the file has first.
    place: Reverse<usize>,
}

impl Rank {
    pub(super) fn new(scene: &Scene, regions: &[PlanarRegion], place: usize) -> Self {
        let region = &regions[place];
        let face = &scene.faces[region.faces[0]];
        let glow = luminance(scene[face.material].emission);
        // To six digits, so that rounding does not decide.
        let size = size(region);
        let unit = 10f64.powf(size.max(f64::MIN_POSITIVE).log10().floor() - 6.0);
        let smallness = -(size / unit).round() * unit;
        Self { glow, smallness, place: Reverse(place) }
    }

    /// Of two in one place and of one size, the one that glows is meant, or else the one that the file has first.
    pub(super) fn of_equals(&self) -> (f64, Reverse<usize>) {
        (self.glow, self.place)
    }
}

/// m².
pub(super) fn size(region: &PlanarRegion) -> f64 {
    region.rings.iter().map(|ring| area(ring)).sum()
}
