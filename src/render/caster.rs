//! Finds the first triangle along a ray, without gaps between neighbours.

use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;

use crate::geometry::hierarchy::{hierarchy, ray};
use crate::reconstruct::TriMesh;

/// Growth of the boxes around triangles, as a share of the mesh's size: far above the rounding of
/// f32, far below a pixel.
const PADDING: f64 = 1e-5;

/// How far outside a triangle, in barycentric coordinates, a ray still hits it: above the rounding
/// of f64, so that no ray slips between neighbours.
const EDGE: f64 = 1e-9;

/// Thickness of a sheet, as a share of the distance: above the rounding of f64.
const SHEET: f64 = 1e-9;

/// Which sides of the triangles stop a ray.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum VisibleSides {
    Front,
    Both,
}

/// Where a ray meets the mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeshHit {
    /// Index into [`TriMesh::triangles`].
    pub(super) triangle: usize,
    /// Distance from the eye, m.
    pub(super) distance: f64,
    /// Barycentric coordinates, at least zero, with sum 1.
    pub(super) weights: DVec3,
    /// True if the ray comes from the triangle's front.
    pub(super) front: bool,
}

impl MeshHit {
    /// Of the two sides of a sheet, which are equally far, the front comes first.
    fn is_before(&self, other: &Self) -> bool {
        match self.front == other.front {
            true => self.distance < other.distance,
            false if self.front => self.distance <= other.distance * (1.0 + SHEET),
            false => self.distance * (1.0 + SHEET) < other.distance,
        }
    }
}

/// The triangles of a mesh in a tree of boxes, moved and scaled into the unit cube around the
/// origin, where f32 is at its best.
pub(super) struct Caster {
    tree: Bvh2,
    /// In the order of the tree's leaves.
    triangles: Vec<IndexedTriangle>,
    centre: DVec3,
    size: f64,
}

struct IndexedTriangle {
    corners: [DVec3; 3],
    index: usize,
}

impl Caster {
    pub(super) fn new(mesh: &TriMesh) -> Self {
        let (low, high) = mesh.bounds();
        let centre = (low + high) / 2.0;
        let size = Some((high - low).max_element()).filter(|size| *size > 0.0).unwrap_or(1.0);
        let corners = |triangle: usize| {
            mesh.triangles[triangle].map(|c| (mesh.positions[c as usize] - centre) / size)
        };
        let boxes: Vec<Aabb> =
            (0..mesh.triangles.len()).map(|index| padded_box(corners(index))).collect();
        let tree = hierarchy(&boxes);
        let triangles = tree
            .primitive_indices
            .iter()
            .map(|&index| IndexedTriangle {
                corners: corners(index as usize),
                index: index as usize,
            })
            .collect();
        Self { tree, triangles, centre, size }
    }

    /// The nearest triangle from `eye` along the unit vector `direction`.
    pub(super) fn first(
        &self,
        eye: DVec3,
        direction: DVec3,
        sides: VisibleSides,
    ) -> Option<MeshHit> {
        self.first_of(eye, direction, sides, |_| true)
    }

    /// The same of the triangles that are there at the place where they are met.
    pub(super) fn first_of(
        &self,
        eye: DVec3,
        direction: DVec3,
        sides: VisibleSides,
        is_there: impl Fn(&MeshHit) -> bool,
    ) -> Option<MeshHit> {
        let eye = (eye - self.centre) / self.size;
        // All triangles are within the unit sphere: the ray starts where it may enter it.
        let skipped = (-eye.dot(direction) - 1.0).max(0.0);
        let origin = eye + skipped * direction;
        let mut nearest: Option<MeshHit> = None;
        let ray = ray(origin, direction, f32::INFINITY);
        let mut ignored = obvhs::ray::RayHit::none();
        self.tree.ray_traverse(ray, &mut ignored, |_, slot| {
            let hit = self.triangles[slot].meet(origin, direction, sides);
            let is_nearer =
                |hit: &MeshHit| nearest.is_none_or(|n| hit.is_before(&n)) && is_there(hit);
            let Some(hit) = hit.filter(is_nearer) else {
                return f32::INFINITY;
            };
            nearest = Some(hit);
            hit.distance as f32
        });
        nearest.map(|hit| MeshHit { distance: (hit.distance + skipped) * self.size, ..hit })
    }
}

impl IndexedTriangle {
    /// Edge functions as triple products: an edge has bitwise opposite values in its two triangles.
    fn meet(&self, origin: DVec3, direction: DVec3, sides: VisibleSides) -> Option<MeshHit> {
        let [a, b, c] = self.corners.map(|corner| corner - origin);
        let edges = DVec3::new(
            direction.dot(c.cross(b)),
            direction.dot(a.cross(c)),
            direction.dot(b.cross(a)),
        );
        let sum = edges.element_sum();
        let front = sum > 0.0;
        if sum == 0.0 || (sides == VisibleSides::Front && !front) {
            return None;
        }
        let weights = edges / sum;
        if weights.min_element() < -EDGE {
            return None;
        }
        let normal = (b - a).cross(c - a);
        let distance = a.dot(normal) / direction.dot(normal);
        if !(distance > 0.0 && distance.is_finite()) {
            return None;
        }
        let weights = weights.max(DVec3::ZERO);
        let weights = weights / weights.element_sum();
        Some(MeshHit { triangle: self.index, distance, weights, front })
    }
}

fn padded_box([a, b, c]: [DVec3; 3]) -> Aabb {
    let low: Vec3A = (a.min(b).min(c) - PADDING).as_vec3a();
    let high: Vec3A = (a.max(b).max(c) + PADDING).as_vec3a();
    Aabb::new(low, high)
}
