//! Looking at patches from a point, by hemicube and by rays.

use super::sampled::{PatchVisibility, SeenPatch};
use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::Hemicube;
use crate::form_factor::rays::Rays;
use crate::mesh::Patch;
use crate::visibility::{Occluders, SurfacePoint};

/// The view through a hemicube: exact form factors times the shares of cells that were kept.
pub(super) struct HemicubeView<'a> {
    patches: &'a [Patch],
    hemicube: Hemicube<'a>,
}

impl<'a> HemicubeView<'a> {
    pub(super) fn new(patches: &'a [Patch], hemicube: Hemicube<'a>) -> Self {
        Self { patches, hemicube }
    }
}

impl PatchVisibility for HemicubeView<'_> {
    fn seen_from(&mut self, eye: SurfacePoint, turn: f64) -> Vec<SeenPatch> {
        let patches = self.patches;
        let fronts = self.hemicube.look(eye, turn).visible_patches().filter(|sight| sight.front);
        let seen = fronts.map(|sight| {
            let all =
                point_to_polygon(eye.position, eye.normal, &patches[sight.patch.index()].corners);
            let factor = sight.visible * all;
            SeenPatch { patch: sight.patch.0, factor, clear: sight.visible == 1.0 }
        });
        seen.collect()
    }
}

/// A patch that should meet more rays than this and meets none is hidden.
const FEW: f64 = 32.0;

/// The view along rays: their shares, or exact form factors where nothing is hidden.
pub(super) struct RayView<'a> {
    patches: &'a [Patch],
    occluders: &'a Occluders,
    rays: Rays<'a>,
}

impl<'a> RayView<'a> {
    pub(super) fn new(patches: &'a [Patch], occluders: &'a Occluders, rays: Rays<'a>) -> Self {
        Self { patches, occluders, rays }
    }
}

impl PatchVisibility for RayView<'_> {
    fn seen_from(&mut self, eye: SurfacePoint, turn: f64) -> Vec<SeenPatch> {
        let mut shares = vec![0.0; self.patches.len()];
        for sight in self.rays.look(self.patches, eye, turn) {
            shares[sight.patch.index()] = sight.delta;
        }
        let seen = |(index, share)| self.seen(eye, index, share);
        shares.into_iter().enumerate().filter_map(seen).collect()
    }
}

impl RayView<'_> {
    /// A patch that this share of the rays met, also if none did because it is small.
    fn seen(&self, eye: SurfacePoint, index: usize, share: f64) -> Option<SeenPatch> {
        let patch = &self.patches[index];
        if patch.polygon().plane.depth(eye.position) <= 0.0 {
            return None;
        }
        let above = eye.above().clip(&patch.corners);
        let all = point_to_polygon(eye.position, eye.normal, &above);
        if all == 0.0 || (share == 0.0 && all > FEW * self.rays.delta()) {
            return None;
        }
        let clear = !self.occluders.may_be_hidden(eye.position, &above, patch.normal);
        let factor = if clear { all } else { share };
        (factor > 0.0).then_some(SeenPatch { patch: index as u32, factor, clear })
    }
}
