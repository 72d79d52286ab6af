//! What all passes are given.

use super::clusters::Clusters;
use super::gather_points::ONE_PLACE;
use crate::direct::DirectLight;
use crate::light::Optics;
use crate::surface::Surfaces;
use crate::visibility::Occluders;

/// What light meets on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Context<'a> {
    pub(super) surfaces: &'a Surfaces,
    pub(super) occluders: &'a Occluders,
    pub(super) optics: &'a Optics,
    pub(super) light: &'a DirectLight,
    /// What shoots as one.
    pub(super) clusters: &'a Clusters,
    /// Vertices of facets nearer to each other than this, m, are at one place.
    pub(super) near: f64,
}

/// What reflected light meets on its way to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct GatherContext<'a> {
    pub(super) surfaces: &'a Surfaces,
    pub(super) occluders: &'a Occluders,
    pub(super) clusters: &'a Clusters,
}

impl<'a> Context<'a> {
    pub(super) fn new(
        surfaces: &'a Surfaces,
        optics: &'a Optics,
        light: &'a DirectLight,
        clusters: &'a Clusters,
    ) -> Self {
        let near = ONE_PLACE * surfaces.epsilon;
        Self { surfaces, occluders: light.occluders(), optics, light, clusters, near }
    }

    /// What reflected light is gathered in.
    pub(super) fn to_gather(self) -> GatherContext<'a> {
        let Self { surfaces, occluders, clusters, .. } = self;
        GatherContext { surfaces, occluders, clusters }
    }
}
