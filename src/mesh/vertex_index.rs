//! Finds the vertex at a place.

use glam::DVec2;

use super::landmarks::Landmarks;
use crate::geometry::polygon;
use crate::geometry::{Cells, Plane, cell_key};
use crate::settings::Settings;
use crate::surface::{Contact, Surface, SurfaceId, Surfaces};

/// But none is moved farther than so many of the shortest sides that elements may have.
const FARTHEST: f64 = 4.0;

/// Vertices of a surface are farther apart than so many epsilons, and than this share of its width if that is less:
/// more than twice what counts as one place in the triangle mesh, so that no two of a surface become one there.
const APART: f64 = 25.0;
const APART_FOR_WIDTH: f64 = 0.01;

/// Sine of the least angle by which an outline bends at a corner.
const STRAIGHT: f64 = 1e-6;

/// Finds the vertex at a place.
#[derive(Clone, Debug)]
pub(super) struct VertexIndex {
    pub(super) by_surface: Vec<SurfaceVertices>,
    /// Vertices by surface and place on it; at one place, where a contact line runs through it, one for each patch.
    pub(super) cells: Cells,
    /// Places of vertices of all surfaces.
    pub(super) landmarks: Landmarks,
    /// Shortest side that elements may have, m.
    pub(super) shortest: f64,
    pub(super) epsilon: f64,
}

/// What of a surface its vertices depend on.
#[derive(Clone, Debug)]
pub(super) struct SurfaceVertices {
    pub(super) plane: Plane,
    /// Its vertices are farther apart than that, m.
    pub(super) apart: f64,
    /// Contact lines, and corners at which the surface bends round something: light may be another on
    /// each side.
    pub(super) contacts: Vec<Contact>,
}

impl VertexIndex {
    pub(super) fn new(surfaces: &Surfaces, settings: &Settings) -> Self {
        let epsilon = surfaces.epsilon;
        let sheet = |surface: &Surface| SurfaceVertices {
            plane: surface.plane,
            apart: apart(surfaces, surface),
            contacts: surface.contacts.iter().copied().chain(inner_corners(surface)).collect(),
        };
        let by_surface = surfaces.list.iter().map(sheet).collect();
        let shortest = settings.min_element.metres(surfaces.extent);
        let landmarks = Landmarks::new(epsilon, (FARTHEST * shortest).max(epsilon));
        Self { by_surface, cells: Cells::default(), landmarks, shortest, epsilon }
    }

    /// The cell around a place on a surface.
    pub(super) fn key(&self, surface: SurfaceId, place: DVec2) -> u64 {
        cell_key(surface.0, place.extend(0.0), self.by_surface[surface.index()].apart)
    }
}

/// How far apart the vertices of a surface are at least, m.
pub(super) fn apart(surfaces: &Surfaces, surface: &Surface) -> f64 {
    let edges = surface.rings.iter().flat_map(|ring| polygon::edges(ring));
    let perimeter: f64 = edges.map(|[a, b]| a.distance(b)).sum();
    let width = 2.0 * surface.area() / perimeter.max(f64::MIN_POSITIVE);
    (APART * surfaces.epsilon).min(APART_FOR_WIDTH * width).max(surfaces.epsilon)
}

/// The corners of a surface of more than 180°, as lines without length.
fn inner_corners(surface: &Surface) -> impl Iterator<Item = Contact> + '_ {
    surface.rings.iter().flat_map(|ring| {
        let n = ring.len();
        (0..n).filter_map(move |k| {
            let [before, at, after] = [ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]];
            let turn = (at - before).normalize_or_zero().perp_dot((after - at).normalize_or_zero());
            (turn < -STRAIGHT).then_some(Contact { segment: [at, at], gap: 0.0 })
        })
    })
}
