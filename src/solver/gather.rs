//! Indirect light at vertices: a last gathering, by a hemicube over each, of what the elements reflect.
//!
//! Based on: the local pass of [Lischinski, Tampieri and Greenberg 1993]. Shooting has settled how bright the elements are; seen
//! from a vertex that is all that is needed, and it is smoother than what any element holds.
//!
//! [Lischinski, Tampieri and Greenberg 1993]: https://doi.org/10.1145/166117.166143

use glam::DVec3;
use rayon::prelude::*;
use smallvec::SmallVec;

use super::ElementLight;
use super::direct_pass::World;
use super::transport::turn;
use crate::colour::Rgb;
use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::{DeltaFactors, Hemicube, Sight};
use crate::mesh::{ElementId, Mesh, VertexId};
use crate::surface::Surfaces;
use crate::visibility::Occluders;

/// Cells along the edge of the hemicubes over vertices: they measure visibility only, and vertices are many.
const RESOLUTION: usize = 64;

/// Gathers indirect light at points.
pub(super) struct Gatherer<'a> {
    surfaces: &'a Surfaces,
    occluders: &'a Occluders,
    light: &'a ElementLight,
    delta: DeltaFactors,
    /// Elements whose parts may change a result by more than this, W/m², are taken in parts.
    fine: f64,
}

impl<'a> Gatherer<'a> {
    pub(super) fn new(world: World<'a>, light: &'a ElementLight, fine: f64) -> Self {
        let World { surfaces, occluders, .. } = world;
        Self { surfaces, occluders, light, delta: DeltaFactors::new(RESOLUTION), fine }
    }

    /// Evaluates indirect light at those of the vertices that lack it; returns how many they were.
    pub(super) fn light(
        &self,
        mesh: &mut Mesh,
        vertices: impl IntoIterator<Item = VertexId>,
    ) -> usize {
        let mut dark: Vec<VertexId> =
            vertices.into_iter().filter(|&v| mesh[v].indirect.is_none()).collect();
        dark.sort_unstable();
        dark.dedup();
        let lit: Vec<Rgb> = dark
            .par_iter()
            .map_init(
                || Hemicube::new(&self.delta, self.occluders),
                |hemicube, &vertex| self.gather(mesh, hemicube, vertex),
            )
            .collect();
        for (&vertex, &irradiance) in dark.iter().zip(&lit) {
            mesh.vertices[vertex.index()].indirect = Some(irradiance);
        }
        dark.len()
    }

    /// Irradiance of a vertex by all reflected light, W/m².
    fn gather(&self, mesh: &Mesh, hemicube: &mut Hemicube<'_>, vertex: VertexId) -> Rgb {
        let site = mesh[vertex].site;
        let normal = self.surfaces.list[mesh[vertex].surface as usize].plane.normal;
        let sights = hemicube.look(&mesh.patches, (site, normal), turn(vertex.index()));
        let lit = sights.into_iter().filter(|sight| sight.front);
        lit.map(|sight| self.receive(mesh, hemicube, (site, normal), sight)).sum()
    }

    /// Irradiance by one patch, from elements small enough.
    fn receive(
        &self,
        mesh: &Mesh,
        hemicube: &mut Hemicube<'_>,
        (site, normal): (DVec3, DVec3),
        sight: Sight,
    ) -> Rgb {
        let plane = &self.surfaces.list[mesh[sight.patch].surface as usize].plane;
        let mut irradiance = Rgb::ZERO;
        let mut open: SmallVec<[ElementId; 32]> = SmallVec::new();
        let root = mesh[sight.patch].root;
        open.push(root);
        while let Some(source) = open.pop() {
            let element = &mesh[source];
            let corners: SmallVec<[DVec3; 8]> =
                element.corners.iter().map(|&v| plane.lift(mesh[v].position)).collect();
            let factor = point_to_polygon(site, normal, &corners);
            if factor * self.light.spread[source.index()] > self.fine && !element.is_leaf() {
                open.extend(element.children.iter().copied());
                continue;
            }
            let visible = match sight.visible {
                1.0 => 1.0,
                visible if source == root => visible,
                _ => hemicube.visible_share(sight.patch, &corners, plane.normal),
            };
            irradiance += self.light.reflected[source.index()] * (factor * visible);
        }
        irradiance
    }
}
