//! All that stands in the way of light, in a bounding volume hierarchy.

use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use smallvec::SmallVec;

use super::ids::OccluderId;
use super::occluder::Occluder;
use crate::geometry::hierarchy::{hierarchy, ray};
use crate::geometry::{HalfSpace, PlanarPolygon};
use crate::surface::{SurfaceId, Surfaces};

/// All that blocks light: convex pieces of the surfaces, from both sides.
#[derive(Clone)]
pub struct Occluders {
    /// In the order of the hierarchy's leaves.
    pub(super) polygons: Vec<Occluder>,
    pub(super) bvh: Bvh2,
    /// Near the middle of the scene, m: the hierarchy works in 32 bits.
    pub(super) centre: DVec3,
    extent: f64,
    pub(super) epsilon: f64,
}

impl std::fmt::Debug for Occluders {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Occluders").field("polygons", &self.polygons.len()).finish_non_exhaustive()
    }
}

/// Beyond what 32 bits round places to, as a share of the extent.
const ROUNDING: f64 = 1e-6;

impl Occluders {
    /// The occluders of a scene.
    pub fn new(surfaces: &Surfaces) -> Self {
        Self::of(Occluder::all_of(surfaces).collect(), surfaces.epsilon)
    }

    /// Convex planar polygons as occluders; distances up to `epsilon`, m, count as zero.
    ///
    /// Polygons without area are left out.
    pub fn from_polygons(polygons: &[&[DVec3]], epsilon: f64) -> Self {
        let normal = |p: &[DVec3]| (p[1] - p[0]).cross(p[2] - p[0]).try_normalize();
        let occluder = |(number, p): (usize, &&[DVec3])| {
            let plane = HalfSpace::new(p[0], normal(p)?);
            Some(Occluder { corners: (*p).into(), plane, surface: SurfaceId(number as u32) })
        };
        Self::of(polygons.iter().enumerate().filter_map(occluder).collect(), epsilon)
    }

    fn of(polygons: Vec<Occluder>, epsilon: f64) -> Self {
        let corners = || polygons.iter().flat_map(|p| p.corners.iter().copied());
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let centre = if low.is_finite() { low.midpoint(high) } else { DVec3::ZERO };
        let extent = if low.is_finite() { low.distance(high) } else { 0.0 };
        // Grown so that rounding to 32 bits loses nothing, however far out.
        let margin = Vec3A::splat((epsilon * 5.0).max(ROUNDING * extent) as f32);
        let boxes: Vec<Aabb> = polygons
            .iter()
            .map(|polygon| {
                let at = polygon.corners.iter().map(|&p| (p - centre).as_vec3a());
                let tight = Aabb::from_points(&at.collect::<SmallVec<[Vec3A; 8]>>());
                Aabb::new(tight.min - margin, tight.max + margin)
            })
            .collect();
        let bvh = hierarchy(&boxes);
        let ordered = bvh.primitive_indices.iter().map(|&k| polygons[k as usize].clone()).collect();
        Self { polygons: ordered, bvh, centre, extent, epsilon }
    }

    /// Distances that count as zero, m.
    pub fn epsilon(&self) -> f64 {
        self.epsilon
    }

    /// A distance from within the scene to beyond all of it, m.
    pub fn extent(&self) -> f64 {
        2.0 * self.extent
    }

    /// Number of occluders.
    pub fn len(&self) -> usize {
        self.polygons.len()
    }

    /// True if nothing hides anything.
    pub fn is_empty(&self) -> bool {
        self.polygons.is_empty()
    }

    /// An occluder as a polygon.
    pub fn polygon(&self, id: OccluderId) -> PlanarPolygon<'_> {
        self.polygons[id.index()].polygon()
    }

    /// True if an occluder crosses the segment from `a` to `b`, its ends left out.
    pub fn blocks(&self, a: DVec3, b: DVec3) -> bool {
        self.blocks_beyond(a, b, |_| false)
    }

    /// The same for occluders of whose surfaces `ignored` is false.
    pub fn blocks_beyond(&self, a: DVec3, b: DVec3, ignored: impl Fn(SurfaceId) -> bool) -> bool {
        if self.polygons.is_empty() {
            return false;
        }
        // With a unit direction: the hierarchy takes components below 1e-7 for zero, whatever the
        // scene's size.
        let along = (b - a).normalize_or_zero();
        let ray = ray(a - self.centre, along, a.distance(b) as f32);
        !self.bvh.ray_traverse_miss(ray, |_, slot| {
            let occluder = &self.polygons[slot];
            let blocks = occluder.crosses(a, b, self.epsilon) && !ignored(occluder.surface);
            if blocks { 0.0 } else { f32::INFINITY }
        })
    }

    /// Calls `visit` for the occluders in boxes that `enter` lets in, until it returns false.
    pub(super) fn for_each(
        &self,
        enter: impl FnMut(DVec3, DVec3) -> bool,
        visit: impl FnMut(OccluderId, &Occluder) -> bool,
    ) {
        let root: &[u32] = if self.polygons.is_empty() { &[] } else { &[0] };
        self.for_each_under(root, enter, visit);
    }

    /// The same for those under some nodes of the hierarchy.
    pub(super) fn for_each_under(
        &self,
        nodes: &[u32],
        mut enter: impl FnMut(DVec3, DVec3) -> bool,
        mut visit: impl FnMut(OccluderId, &Occluder) -> bool,
    ) {
        let mut stack: SmallVec<[u32; 96]> = nodes.iter().rev().copied().collect();
        while let Some(index) = stack.pop() {
            let (low, high) = self.bounds_of(index);
            if !enter(low, high) {
                continue;
            }
            let node = &self.bvh.nodes[index as usize];
            if !node.is_leaf() {
                stack.extend([node.first_index + 1, node.first_index]);
                continue;
            }
            for index in node.first_index..node.first_index + node.prim_count {
                if !visit(OccluderId(index), &self.polygons[index as usize]) {
                    return;
                }
            }
        }
    }

    /// Opposite corners of a node's box, m.
    pub(super) fn bounds_of(&self, node: u32) -> (DVec3, DVec3) {
        let bounds = self.bvh.nodes[node as usize].aabb();
        (bounds.min.as_dvec3() + self.centre, bounds.max.as_dvec3() + self.centre)
    }
}
