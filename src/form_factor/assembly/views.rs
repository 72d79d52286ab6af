//! Looking at patches from a point, by hemicube and by rays.

use glam::DVec3;

use super::sampled::{Look, Seen};
use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::{DeltaFactors, Hemicube, Targets};
use crate::form_factor::rays::{self, Rays};
use crate::mesh::Patch;
use crate::visibility::{HalfSpace, Occluders, PatchHierarchy};

/// The view through a hemicube: exact form factors times the shares of cells that were kept.
pub(super) struct Cells<'a> {
    patches: &'a [Patch],
    hemicube: Hemicube<'a>,
}

impl<'a> Cells<'a> {
    pub(super) fn new(
        patches: &'a [Patch],
        occluders: &'a Occluders,
        (delta, targets): (&'a DeltaFactors, &'a Targets),
    ) -> Self {
        Self { patches, hemicube: Hemicube::new(delta, targets, occluders) }
    }
}

impl Look for Cells<'_> {
    fn look(&mut self, eye: DVec3, normal: DVec3, turn: f64) -> Vec<Seen> {
        let patches = self.patches;
        let fronts = self.hemicube.look((eye, normal), turn).sights().filter(|sight| sight.front);
        let seen = fronts.map(|sight| {
            let all = point_to_polygon(eye, normal, &patches[sight.patch.index()].corners);
            let factor = sight.visible * all;
            Seen { patch: sight.patch.0, factor, clear: sight.visible == 1.0 }
        });
        seen.collect()
    }
}

/// A patch that should meet more rays than this and meets none is hidden.
const FEW: f64 = 32.0;

/// The view along rays: their shares, or exact form factors where nothing is hidden.
pub(super) struct Sphere<'a> {
    patches: &'a [Patch],
    occluders: &'a Occluders,
    rays: Rays<'a>,
}

impl<'a> Sphere<'a> {
    pub(super) fn new(
        patches: &'a [Patch],
        occluders: &'a Occluders,
        (sphere, hierarchy): (&'a rays::Sphere, &'a PatchHierarchy),
    ) -> Self {
        Self { patches, occluders, rays: Rays::new(sphere, hierarchy) }
    }
}

impl Look for Sphere<'_> {
    fn look(&mut self, eye: DVec3, normal: DVec3, turn: f64) -> Vec<Seen> {
        let mut shares = vec![0.0; self.patches.len()];
        for sight in self.rays.look(self.patches, (eye, normal), turn) {
            shares[sight.patch.index()] = sight.delta;
        }
        let seen = |(index, patch)| self.seen((eye, normal), (index, patch), shares[index]);
        self.patches.iter().enumerate().filter_map(seen).collect()
    }
}

impl Sphere<'_> {
    /// A patch that this share of the rays met, also if none did because it is small.
    fn seen(
        &self,
        (eye, normal): (DVec3, DVec3),
        (index, patch): (usize, &Patch),
        share: f64,
    ) -> Option<Seen> {
        if HalfSpace::new(patch.corners[0], patch.normal).depth(eye) <= 0.0 {
            return None;
        }
        let above = HalfSpace::new(eye, normal).clip(&patch.corners);
        let all = point_to_polygon(eye, normal, &above);
        if all == 0.0 || (share == 0.0 && all > FEW * self.rays.delta()) {
            return None;
        }
        let clear = !self.occluders.may_be_hidden(eye, &above, patch.normal);
        let factor = if clear { all } else { share };
        (factor > 0.0).then_some(Seen { patch: index as u32, factor, clear })
    }
}
