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
        let (patches, occluders) = (self.patches, self.occluders);
        let horizon = HalfSpace::new(eye, normal);
        let sights = self.rays.look(patches, (eye, normal), turn);
        let seen = sights.into_iter().filter(|sight| sight.front).map(|sight| {
            let patch = &patches[sight.patch.index()];
            let above = horizon.clip(&patch.corners);
            let clear = !above.is_empty() && !occluders.may_be_hidden(eye, &above, patch.normal);
            let factor = if clear { point_to_polygon(eye, normal, &above) } else { sight.delta };
            Seen { patch: sight.patch.0, factor, clear }
        });
        seen.collect()
    }
}
