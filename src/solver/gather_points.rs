//! Places from which light is gathered: those of vertices, and of many vertices of facets at once.

use std::collections::BTreeMap;

use glam::DVec3;
use smallvec::SmallVec;

use super::clusters::Clusters;
use crate::colour::Rgb;
use crate::form_factor::contour::vector_to_polygon;
use crate::geometry::Weld;
use crate::mesh::{Mesh, VertexId};
use crate::visibility::SurfacePoint;

/// How high over facets a gathering point is, in tolerances: well above ridges that it is a hair away from.
const LIFT: f64 = 50.0;

/// Vertices nearer to each other than this many tolerances are at one place.
pub(super) const ONE_PLACE: f64 = 200.0;

/// Cosine of the angle from the normal beyond which light is taken for less grazing than it is.
const GRAZING: f64 = 0.1;

/// A place to gather light at, once for all of some vertices.
#[derive(Clone, Debug)]
pub(super) struct GatherPoint {
    /// In their order; all of one cluster of facets, or a single one.
    pub(super) vertices: SmallVec<[VertexId; 1]>,
    pub(super) eye: DVec3,
    /// Unit normal.
    pub(super) normal: DVec3,
}

/// The gathering points of vertices: those of facets that are in one cluster and `near` each other, m, share one.
pub(super) fn gather_points(
    mesh: &Mesh,
    clusters: &Clusters,
    near: f64,
    vertices: &[VertexId],
) -> Vec<GatherPoint> {
    let sets = neighbours(mesh, clusters, near.max(ONE_PLACE * mesh.epsilon()), vertices);
    sets.into_iter().map(|set| GatherPoint::new(mesh, set)).collect()
}

/// Vertices, those of facets together that are in one cluster and `near` each other, m.
pub(super) fn neighbours(
    mesh: &Mesh,
    clusters: &Clusters,
    near: f64,
    vertices: &[VertexId],
) -> Vec<SmallVec<[VertexId; 1]>> {
    let mut weld = Weld::new(near);
    let mut shared: BTreeMap<(usize, u32), usize> = BTreeMap::new();
    let mut sets: Vec<SmallVec<[VertexId; 1]>> = Vec::new();
    for &vertex in vertices {
        let patch = mesh[vertex].patch;
        let set = if clusters.holds(patch) {
            let key = (clusters.of(patch), weld.number(mesh[vertex].site));
            *shared.entry(key).or_insert(sets.len())
        } else {
            sets.len()
        };
        sets.resize(sets.len().max(set + 1), SmallVec::new());
        sets[set].push(vertex);
    }
    sets
}

impl GatherPoint {
    fn new(mesh: &Mesh, vertices: SmallVec<[VertexId; 1]>) -> Self {
        let normal_of = |v: VertexId| mesh.plane(mesh[v].patch).normal;
        if let &[vertex] = vertices.as_slice() {
            return Self { eye: mesh.viewpoint(vertex), normal: normal_of(vertex), vertices };
        }
        let site = |v: VertexId| mesh[v].site;
        let middle = vertices.iter().map(|&v| site(v)).sum::<DVec3>() / vertices.len() as f64;
        let aside = |v: VertexId| site(v).distance_squared(middle);
        let nearest = vertices.iter().copied().min_by(|&a, &b| aside(a).total_cmp(&aside(b)));
        let at = nearest.map_or(middle, site);
        let here = |v: &&VertexId| site(**v).distance(at) <= ONE_PLACE * mesh.epsilon();
        let sum: DVec3 = vertices.iter().filter(here).map(|&v| normal_of(v)).sum();
        let normal = sum.normalize_or(normal_of(vertices[0]));
        Self { vertices, eye: at + normal * (LIFT * mesh.epsilon()), normal }
    }
}

/// Light from a polygon, all or part of it.
pub(super) struct IncidentLight<'a> {
    /// Irradiance at the place that it was gathered for, W/m².
    pub(super) light: Rgb,
    pub(super) corners: &'a [DVec3],
}

/// Irradiance by where it comes from, so that it can be told for normals that differ a little.
///
/// Light vectors as in [Arvo 1994]; exact for normals whose horizon cuts nothing that shines.
///
/// [Arvo 1994]: https://doi.org/10.1145/192161.192250
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LightVector {
    /// By channel, W/m².
    vectors: [DVec3; 3],
}

impl LightVector {
    /// Adds light that arrives at a point of a surface.
    pub(super) fn add(&mut self, at: SurfacePoint, arrival: &IncidentLight<'_>) {
        let SurfacePoint { position: place, normal } = at;
        let towards = vector_to_polygon(place, normal, arrival.corners).normalize_or(normal);
        let towards = towards / towards.dot(normal).max(GRAZING);
        for (vector, light) in self.vectors.iter_mut().zip(arrival.light.to_array()) {
            *vector += towards * light;
        }
    }

    /// Irradiance of a surface with this unit normal, W/m².
    pub(super) fn irradiance(&self, normal: DVec3) -> Rgb {
        Rgb::from_array(self.vectors.map(|vector| vector.dot(normal).max(0.0)))
    }
}
