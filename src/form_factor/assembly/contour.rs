//! Rows of exact exchanges.

use glam::DVec3;

use super::contacts::Contacts;
use super::row::SparseRow;
use crate::form_factor::pair::visible_exchange;
use crate::geometry::PlanarPolygon;
use crate::mesh::Patch;
use crate::visibility::Occluders;

/// Error of an exchange, as a share of the smaller patch's area.
///
/// Rows have hundreds of exchanges with errors either way: they sum to one within some tens of this.
const TOLERANCE: f64 = 1e-5;

/// Patches with what decides quickly that two of them do not face each other.
pub(super) struct Exchanges<'a> {
    patches: &'a [Patch],
    occluders: &'a Occluders,
    contacts: &'a Contacts,
    spheres: Vec<(DVec3, f64)>,
}

impl<'a> Exchanges<'a> {
    pub(super) fn new(
        patches: &'a [Patch],
        occluders: &'a Occluders,
        contacts: &'a Contacts,
    ) -> Self {
        let sphere = |patch: &Patch| {
            let centre = patch.corners.iter().sum::<DVec3>() / patch.corners.len() as f64;
            let reach = |corner: &DVec3| corner.distance(centre);
            (centre, patch.corners.iter().map(reach).fold(0.0, f64::max))
        };
        let spheres = patches.iter().map(sphere).collect();
        Self { patches, occluders, contacts, spheres }
    }

    /// Exchanges, m², of patch `i` with those after it that it does not touch.
    pub(super) fn row(&self, i: usize) -> SparseRow {
        if self.contacts.is_covered(i) {
            return SparseRow::new();
        }
        let others = (i + 1..self.patches.len()).filter(|&j| !self.contacts.is_covered(j));
        let exchange = |j: usize| (j as u32, self.with(i, j, self.patches[j].polygon()));
        let mut row: SparseRow =
            others.map(exchange).filter(|&(_, exchange)| exchange > 0.0).collect();
        row.shrink_to_fit();
        row
    }

    /// Share of the light of patch `i` that meets the black backs of others.
    pub(super) fn on_backs(&self, i: usize) -> f64 {
        if self.contacts.is_covered(i) {
            return 0.0;
        }
        let others = self
            .patches
            .iter()
            .enumerate()
            .filter(|(j, _)| *j != i && !self.contacts.is_backed(*j));
        let exchange = |(j, patch): (usize, &Patch)| {
            let corners: Vec<DVec3> = patch.corners.iter().rev().copied().collect();
            self.with(i, j, PlanarPolygon::new(&corners, -patch.normal))
        };
        others.map(exchange).sum::<f64>() / self.patches[i].area
    }

    /// Exchange, m², of patch `i` with a side of patch `j`.
    fn with(&self, i: usize, j: usize, side: PlanarPolygon<'_>) -> f64 {
        let this = self.patches[i].polygon();
        if self.is_behind(i, side) || self.is_behind(j, this) {
            return 0.0;
        }
        visible_exchange(self.occluders, this, side, TOLERANCE)
    }

    fn is_behind(&self, i: usize, polygon: PlanarPolygon<'_>) -> bool {
        let (centre, radius) = self.spheres[i];
        polygon.plane.depth(centre) <= -radius
    }
}
