//! Shafts: the convex hull of two bodies, outside of which nothing can stand between them.
//!
//! Based on: [Haines and Wallace 1991], with the planes of the exact hull instead of those of two boxes.
//!
//! [Haines and Wallace 1991]: https://doi.org/10.1007/978-3-642-57963-9_11

use glam::DVec3;
use smallvec::SmallVec;

use crate::geometry::{HalfSpace, PlanarPolygon};

/// A convex body: a point, a planar polygon or a box.
#[derive(Clone, Debug)]
pub struct ConvexBody {
    corners: SmallVec<[DVec3; 8]>,
    /// Its edges, as pairs of corners.
    edges: SmallVec<[[u8; 2]; 12]>,
    /// What it faces, if it does not look to all sides.
    front: Option<HalfSpace>,
}

/// Everything between two bodies, or between a point and a polygon.
#[derive(Clone, Debug)]
pub struct Shaft {
    sides: SmallVec<[HalfSpace; 16]>,
    low: DVec3,
    high: DVec3,
}

impl ConvexBody {
    /// A polygon that faces what is in front of it.
    pub fn polygon(polygon: PlanarPolygon<'_>) -> Self {
        let n = polygon.corners.len() as u8;
        Self {
            corners: polygon.corners.into(),
            edges: (0..n).map(|k| [k, (k + 1) % n]).collect(),
            front: Some(polygon.plane),
        }
    }

    /// A point that looks to all sides.
    pub fn point(at: DVec3) -> Self {
        Self { corners: smallvec::smallvec![at], edges: SmallVec::new(), front: None }
    }

    /// The box between opposite corners, looking to all sides.
    pub fn cuboid(low: DVec3, high: DVec3) -> Self {
        let corner = |k: usize| {
            DVec3::select(glam::BVec3::new(k & 1 != 0, k & 2 != 0, k & 4 != 0), high, low)
        };
        let edge = |from: u8| {
            let along = [1, 2, 4].into_iter().filter(move |axis| from & axis == 0);
            along.map(move |axis| [from, from | axis])
        };
        Self {
            corners: (0..8).map(corner).collect(),
            edges: (0..8).flat_map(edge).collect(),
            front: None,
        }
    }

    /// Its corners, m.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// The plane of a polygon, in front of which is what it faces.
    pub fn front(&self) -> Option<HalfSpace> {
        self.front
    }

    /// Opposite corners of the box around it, m.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let corners = || self.corners.iter().copied();
        (
            corners().fold(DVec3::INFINITY, DVec3::min),
            corners().fold(DVec3::NEG_INFINITY, DVec3::max),
        )
    }
}

impl Shaft {
    /// Everything between two bodies and in front of both; distances up to `epsilon`, m, count as zero.
    pub fn between(a: &ConvexBody, b: &ConvexBody, epsilon: f64) -> Self {
        let corners = || a.corners.iter().chain(&b.corners).copied();
        let mut sides: SmallVec<[HalfSpace; 16]> = SmallVec::new();
        sides.extend(a.front.into_iter().chain(b.front));
        sides.extend(supports(a, b, epsilon));
        sides.extend(supports(b, a, epsilon));
        Self {
            sides,
            low: corners().fold(DVec3::INFINITY, DVec3::min),
            high: corners().fold(DVec3::NEG_INFINITY, DVec3::max),
        }
    }

    /// Everything between a point and a polygon, which must lie above the eye's horizon and not in one plane with it.
    pub(super) fn from_eye(eye: DVec3, source: PlanarPolygon<'_>) -> Self {
        let mut sides: SmallVec<[HalfSpace; 16]> =
            cone(eye, source.corners, source.plane.depth(eye)).collect();
        sides.push(source.plane);
        let corners = || source.corners.iter().copied().chain([eye]);
        Self {
            sides,
            low: corners().fold(DVec3::INFINITY, DVec3::min),
            high: corners().fold(DVec3::NEG_INFINITY, DVec3::max),
        }
    }

    /// The half spaces whose intersection it is.
    pub(super) fn sides(&self) -> &[HalfSpace] {
        &self.sides
    }

    /// False only if no part of the box is inside.
    pub(super) fn meets_box(&self, low: DVec3, high: DVec3, epsilon: f64) -> bool {
        let reaches = |side: &HalfSpace| {
            let furthest = DVec3::select(side.normal.cmpge(DVec3::ZERO), high, low);
            side.depth(furthest) > epsilon
        };
        self.low.cmple(high).all() && self.high.cmpge(low).all() && self.sides.iter().all(reaches)
    }

    /// False only if no part of the polygon is inside.
    pub(super) fn meets(&self, polygon: &[DVec3], epsilon: f64) -> bool {
        let reaches = |side: &HalfSpace| polygon.iter().any(|&p| side.depth(p) > epsilon);
        self.sides.iter().all(reaches)
    }
}

/// The half spaces of all rays from `eye` through a polygon that it sees from the front (`height`
/// positive) or back.
fn cone(eye: DVec3, polygon: &[DVec3], height: f64) -> impl Iterator<Item = HalfSpace> + '_ {
    let inward = -height.signum();
    (0..polygon.len()).filter_map(move |k| {
        let (a, b) = (polygon[k] - eye, polygon[(k + 1) % polygon.len()] - eye);
        // An edge that points at the eye bounds nothing.
        (a.cross(b) * inward).try_normalize().map(|normal| HalfSpace::new(eye, normal))
    })
}

/// The half spaces that hold both bodies and have an edge of the first and a corner of the second
/// on their border.
fn supports<'a>(
    a: &'a ConvexBody,
    b: &'a ConvexBody,
    epsilon: f64,
) -> impl Iterator<Item = HalfSpace> + 'a {
    let through = move |[from, to]: [u8; 2], corner: DVec3| {
        let (from, to) = (a.corners[from as usize], a.corners[to as usize]);
        let plane = HalfSpace::new(from, (to - from).cross(corner - from).try_normalize()?);
        let (mut low, mut high) = (0.0_f64, 0.0_f64);
        for &p in a.corners.iter().chain(&b.corners) {
            low = low.min(plane.depth(p));
            high = high.max(plane.depth(p));
            if low < -epsilon && high > epsilon {
                return None;
            }
        }
        Some(if low >= -epsilon { plane } else { plane.complement() })
    };
    a.edges
        .iter()
        .flat_map(move |&edge| b.corners.iter().filter_map(move |&corner| through(edge, corner)))
}
