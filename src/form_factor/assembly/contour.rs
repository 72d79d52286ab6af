//! Rows of exact exchanges.

use glam::DVec3;

use super::Row;
use crate::form_factor::pair::visible_exchange;
use crate::mesh::Patch;
use crate::visibility::{Facet, Occluders};

/// Error of an exchange, as a share of the smaller patch's area.
const TOLERANCE: f64 = 1e-4;

/// Patches with what decides quickly that two of them do not face each other.
pub(super) struct Exchanges<'a> {
    patches: &'a [Patch],
    occluders: &'a Occluders,
    spheres: Vec<(DVec3, f64)>,
}

impl<'a> Exchanges<'a> {
    pub(super) fn new(patches: &'a [Patch], occluders: &'a Occluders) -> Self {
        let sphere = |patch: &Patch| {
            let centre = patch.corners.iter().sum::<DVec3>() / patch.corners.len() as f64;
            let reach = |corner: &DVec3| corner.distance(centre);
            (centre, patch.corners.iter().map(reach).fold(0.0, f64::max))
        };
        Self { patches, occluders, spheres: patches.iter().map(sphere).collect() }
    }

    /// Exchanges, m², of patch `i` with those after it.
    pub(super) fn row(&self, i: usize) -> Row {
        let this = facet(&self.patches[i]);
        let mut row = Row::new();
        for j in i + 1..self.patches.len() {
            let other = facet(&self.patches[j]);
            if self.is_behind(i, other) || self.is_behind(j, this) {
                continue;
            }
            let exchange = visible_exchange(self.occluders, this, other, TOLERANCE);
            if exchange > 0.0 {
                row.push((j as u32, exchange));
            }
        }
        row
    }

    fn is_behind(&self, i: usize, facet: Facet<'_>) -> bool {
        let (centre, radius) = self.spheres[i];
        facet.plane.depth(centre) <= -radius
    }
}

fn facet(patch: &Patch) -> Facet<'_> {
    Facet::new(&patch.corners, patch.normal)
}
