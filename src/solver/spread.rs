//! Light that is constant over elements, brought to vertices: for pictures of light on its way.

use glam::{DVec2, DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use rayon::prelude::*;

use super::interpolate::{REFLECTED, interpolate};
use crate::colour::Rgb;
use crate::geometry::hierarchy::{hierarchy, overlapping};
use crate::geometry::polygon::{distance, edges};
use crate::light::{ElementLight, VertexLight};
use crate::mesh::{Element, ElementId, Mesh, Vertex, VertexId};

/// Vertices nearer to an edge than this share of its length are on it.
const ON_EDGE: f64 = 1e-4;

/// Gives corners of evenly lit elements the mean of those around them, by area, and some ambient light; all other
/// vertices what is between.
///
/// Light that has reached a patch as a whole varies from patch to patch only, however small its leaves are; and a
/// corner on the edge of a larger element has light of that, too. Else light would ripple where patches or leaves of
/// different sizes meet.
pub(super) fn spread(light: &ElementLight, ambient: Rgb, mesh: &Mesh, vertices: &mut VertexLight) {
    let elements = light.evenly_lit(mesh);
    let mut sums = vec![(Rgb::ZERO, 0.0); mesh.vertices.len()];
    let mut add = |vertex: VertexId, element: ElementId| {
        let (sum, area) = &mut sums[vertex.index()];
        *sum += light.indirect[element.index()] * mesh[element].area;
        *area += mesh[element].area;
    };
    for &element in &elements {
        mesh[element].corners.iter().for_each(|&corner| add(corner, element));
    }
    for (vertex, element) in hanging(mesh, &elements) {
        add(vertex, element);
    }
    vertices.forget_indirect(|_| true);
    for (vertex, (sum, area)) in (0..).map(VertexId).zip(sums) {
        if area > 0.0 {
            vertices.set_indirect(vertex, sum / area + ambient);
        }
    }
    interpolate(mesh, vertices, REFLECTED);
}

/// Corners of some of the elements that are on edges of others, with these; none where a contact line runs: there,
/// light is another on each side.
fn hanging(mesh: &Mesh, elements: &[ElementId]) -> Vec<(VertexId, ElementId)> {
    let places = Places::new(mesh, elements);
    let mut corners: Vec<VertexId> =
        elements.iter().flat_map(|&element| mesh[element].corners.iter().copied()).collect();
    corners.sort_unstable();
    corners.dedup();
    corners.retain(|&corner| !mesh[corner].on_contact);
    let found = |&corner: &VertexId| places.hosts(corner).map(move |host| (corner, host));
    corners.par_iter().flat_map_iter(found).collect()
}

/// Elements by where they are.
struct Places<'a> {
    mesh: &'a Mesh,
    elements: &'a [ElementId],
    tree: Bvh2,
    /// Of the scene, m: coordinates of boxes are from there, so that they keep their precision.
    middle: DVec3,
}

impl<'a> Places<'a> {
    fn new(mesh: &'a Mesh, elements: &'a [ElementId]) -> Self {
        let corners = || mesh.patches.iter().flat_map(|patch| patch.corners.iter().copied());
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        // More than rounding to 32 bits.
        let margin = Vec3A::splat((1e-6 * low.distance(high)) as f32);
        let mut places = Self { mesh, elements, tree: Bvh2::default(), middle: low.midpoint(high) };
        let bounds = |&element: &ElementId| {
            let mut bounds = Aabb::INVALID;
            mesh[element].corners.iter().for_each(|&corner| {
                bounds.extend(places.at(corner));
            });
            Aabb::new(bounds.min - margin, bounds.max + margin)
        };
        let boxes: Vec<Aabb> = elements.iter().map(bounds).collect();
        places.tree = hierarchy(&boxes);
        places
    }

    fn at(&self, vertex: VertexId) -> Vec3A {
        let Vertex { patch, position, .. } = self.mesh[vertex];
        (self.mesh.plane(patch).lift(position) - self.middle).as_vec3a()
    }

    /// The elements of a vertex's surface that have it on an edge, and not as a corner.
    fn hosts(&self, vertex: VertexId) -> impl Iterator<Item = ElementId> {
        let (mesh, at) = (self.mesh, self.at(vertex));
        let Vertex { surface, position, .. } = mesh[vertex];
        let is_on =
            move |edge: [DVec2; 2]| distance(edge, position) <= ON_EDGE * edge[0].distance(edge[1]);
        let near = overlapping(&self.tree, Aabb::new(at, at)).into_iter();
        near.map(|index| self.elements[index as usize]).filter(move |&element| {
            let Element { patch, corners, .. } = &mesh[element];
            mesh[*patch].surface == surface
                && !corners.contains(&vertex)
                && edges(&mesh.outline(element)).any(is_on)
        })
    }
}
