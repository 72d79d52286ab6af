//! The first patch along a ray.
//!
//! Neighbours share their edges: a ray counts as a hit up to a hair's breadth outside a polygon, so
//! that none slips through between two of them, even where a corner of one lies on an edge of the
//! other.

use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ray::RayHit;

use super::coplanar::{RECESS, hair};
use crate::geometry::hierarchy::{hierarchy, ray};
use crate::mesh::{Patch, PatchId};

/// How far outside an edge's plane through the eye a ray still hits, radians or somewhat more:
/// above the rounding of 32 bits, so that packets, too, are watertight.
pub(super) const EDGE: f64 = 4e-7;

/// Growth of boxes, as a share of the scene's extent: some times the rounding of 32 bits.
const PADDING: f64 = 4e-6;

/// The patches of a mesh, to look for along rays that start within the scene.
#[derive(Clone)]
pub struct PatchHierarchy {
    pub(super) bvh: Bvh2,
    /// In the order of the hierarchy's leaves.
    pub(super) quads: Vec<Quad>,
    /// Near the middle of the scene, m: the hierarchy works in 32 bits.
    pub(super) centre: DVec3,
    pub(super) hair: f64,
}

/// A patch, or a part of one with many corners.
#[derive(Clone, Debug)]
pub(super) struct Quad {
    /// x, y and z of its corners, m; a triangle's last corner twice.
    corners: [[f64; 4]; 3],
    normal: DVec3,
    patch: u32,
    two_sided: bool,
}

/// A quad as an eye sees it.
pub(super) struct ProjectedQuad {
    /// x, y and z of the normals of the planes through the eye and each edge, towards the inside.
    pub(super) edges: [[f64; 4]; 3],
    /// The ray along d meets the quad's plane at the parameter 1 / (d · plane).
    pub(super) plane: DVec3,
    pub(super) patch: u32,
}

impl std::fmt::Debug for PatchHierarchy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PatchHierarchy").field("quads", &self.quads.len()).finish_non_exhaustive()
    }
}

impl PatchHierarchy {
    /// The hierarchy of all `patches`.
    pub fn new(patches: &[Patch]) -> Self {
        let corners = || patches.iter().flat_map(|patch| patch.corners.iter().copied());
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let centre = if low.is_finite() { low.midpoint(high) } else { DVec3::ZERO };
        let extent = if low.is_finite() { low.distance(high) } else { 0.0 };
        let quads: Vec<Quad> =
            patches.iter().zip(0..).flat_map(|(p, k)| Quad::cover(p, k)).collect();
        let boxes: Vec<Aabb> =
            quads.iter().map(|quad| quad.bounds(centre, PADDING * extent)).collect();
        let bvh = hierarchy(&boxes);
        let quads = bvh.primitive_indices.iter().map(|&k| quads[k as usize].clone()).collect();
        Self { bvh, quads, centre, hair: hair(patches) }
    }

    /// The patch that a ray from `eye` along the unit vector `direction` meets first, and how far
    /// away, m.
    ///
    /// A patch whose plane holds the eye is not met, nor is a double-sided one's back, which has a
    /// patch of its own. Of patches in one place the front wins over the back, then the first in
    /// the list.
    pub fn first(&self, eye: DVec3, direction: DVec3) -> Option<(PatchId, f64)> {
        let (mut nearness, mut patch) = (0.0, u32::MAX);
        let ray = ray(eye - self.centre, direction, f32::INFINITY);
        self.bvh.ray_traverse(ray, &mut RayHit::none(), |_, slot| {
            let quad = &self.quads[slot];
            let met = quad.seen(eye, self.hair).map_or(0.0, |view| view.meet(direction));
            if met < nearness || met == 0.0 || (met == nearness && quad.patch > patch) {
                return f32::INFINITY;
            }
            (nearness, patch) = (met, quad.patch);
            (1.0 / met) as f32
        });
        (patch != u32::MAX).then(|| (PatchId(patch), 1.0 / nearness))
    }
}

impl Quad {
    /// Quads that together cover a patch: a fan around its first corner.
    fn cover(patch: &Patch, index: u32) -> impl Iterator<Item = Self> + '_ {
        let corners = &patch.corners;
        (1..corners.len().saturating_sub(1)).step_by(2).map(move |k| {
            let last = corners[(k + 2).min(corners.len() - 1)];
            let at = [corners[0], corners[k], corners[k + 1], last];
            Self {
                corners: std::array::from_fn(|axis| at.map(|corner| corner[axis])),
                normal: patch.normal,
                patch: index,
                two_sided: patch.two_sided,
            }
        })
    }

    fn bounds(&self, centre: DVec3, padding: f64) -> Aabb {
        let [x, y, z] = self.corners;
        let corners = [0, 1, 2, 3].map(|k| DVec3::new(x[k], y[k], z[k]) - centre);
        let low = corners.into_iter().fold(DVec3::INFINITY, DVec3::min) - padding;
        let high = corners.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max) + padding;
        let (low, high): (Vec3A, Vec3A) = (low.as_vec3a(), high.as_vec3a());
        Aabb::new(low, high)
    }

    /// The quad as `eye` sees it; `None` if it is edge-on, or the back of what has a patch there.
    #[inline(always)]
    pub(super) fn seen(&self, eye: DVec3, hair: f64) -> Option<ProjectedQuad> {
        let [x, y, z] = [0, 1, 2].map(|axis| self.corners[axis].map(|c| c - eye[axis]));
        let to_corner = DVec3::new(x[0], y[0], z[0]);
        let depth = to_corner.dot(self.normal);
        // The front is seen if its normal points to the eye.
        let back = depth > 0.0;
        if depth.abs() < hair || (back && self.two_sided) {
            return None;
        }
        let inward = if back { 1.0 } else { -1.0 };
        let recess = if back { RECESS } else { 1.0 };
        let cross = |p: [f64; 4], q: [f64; 4]| {
            std::array::from_fn(|k| inward * (p[k] * q[(k + 1) % 4] - q[k] * p[(k + 1) % 4]))
        };
        let edges = [cross(y, z), cross(z, x), cross(x, y)];
        Some(ProjectedQuad { edges, plane: self.normal * (recess / depth), patch: self.patch })
    }
}

impl ProjectedQuad {
    /// Reciprocal of the distance at which the ray along `d` meets the quad; 0 if it does not.
    fn meet(&self, d: DVec3) -> f64 {
        let [x, y, z] = &self.edges;
        let inside = (0..4).all(|k| {
            let size = x[k].abs() + y[k].abs() + z[k].abs();
            d.x * x[k] + d.y * y[k] + d.z * z[k] >= -EDGE * size
        });
        if inside { d.dot(self.plane).max(0.0) } else { 0.0 }
    }
}
