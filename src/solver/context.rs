//! What all passes are given.

use super::gather_points::ONE_PLACE;
use super::groups::Groups;
use crate::direct::PatchLight;
use crate::light::Optics;
use crate::surface::Surfaces;
use crate::visibility::Occluders;

/// What light meets on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Context<'a> {
    pub(super) surfaces: &'a Surfaces,
    pub(super) occluders: &'a Occluders,
    pub(super) optics: &'a Optics,
    pub(super) light: &'a PatchLight,
    /// What shoots as one.
    pub(super) groups: &'a Groups,
    /// Vertices of facets nearer to each other than this, m, are at one place.
    pub(super) near: f64,
}

/// What reflected light meets on its way to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct GatherContext<'a> {
    pub(super) surfaces: &'a Surfaces,
    pub(super) occluders: &'a Occluders,
    pub(super) groups: &'a Groups,
}

impl<'a> Context<'a> {
    pub(super) fn new(
        surfaces: &'a Surfaces,
        optics: &'a Optics,
        light: &'a PatchLight,
        groups: &'a Groups,
    ) -> Self {
        let near = ONE_PLACE * surfaces.tolerance;
        Self { surfaces, occluders: light.occluders(), optics, light, groups, near }
    }

    /// What reflected light is gathered in.
    pub(super) fn to_gather(self) -> GatherContext<'a> {
        let Self { surfaces, occluders, groups, .. } = self;
        GatherContext { surfaces, occluders, groups }
    }
}
