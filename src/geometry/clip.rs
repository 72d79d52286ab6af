//! Convex polygons in space, and cutting them by a plane.

use glam::DVec3;
use smallvec::SmallVec;

/// A convex planar polygon in space.
pub type Polygon = SmallVec<[DVec3; 8]>;

/// Pieces of a polygon; they do not overlap.
pub type Pieces = SmallVec<[Polygon; 2]>;

/// The half space in front of a plane.
#[derive(Clone, Copy, Debug)]
pub struct HalfSpace {
    /// Unit normal, into the half space.
    pub normal: DVec3,
    /// Distance of its border from the origin along the normal, m.
    pub offset: f64,
}

/// A convex polygon and the half space that its front faces.
#[derive(Clone, Copy, Debug)]
pub struct PlanarPolygon<'a> {
    /// Its corners, counter-clockwise seen from the front.
    pub corners: &'a [DVec3],
    /// In front of it.
    pub plane: HalfSpace,
}

impl<'a> PlanarPolygon<'a> {
    /// The polygon with these corners and unit `normal`.
    pub fn new(corners: &'a [DVec3], normal: DVec3) -> Self {
        Self { corners, plane: HalfSpace::new(corners[0], normal) }
    }
}

/// Error of a distance from a border, as a share of the coordinates it comes from.
const ROUNDING: f64 = 1e-14;

impl HalfSpace {
    /// The half space with unit `normal` and `point` on its border.
    pub fn new(point: DVec3, normal: DVec3) -> Self {
        Self { normal, offset: point.dot(normal) }
    }

    /// Distance of a point from the border, m; positive inside.
    pub fn depth(&self, point: DVec3) -> f64 {
        point.dot(self.normal) - self.offset
    }

    /// The other side.
    pub fn complement(&self) -> Self {
        Self { normal: -self.normal, offset: -self.offset }
    }

    /// The part of a polygon inside, empty if there is none.
    ///
    /// Corners that are outside by rounding alone are on the border: cut off, they would leave edges of no length, whose
    /// directions are noise.
    pub fn clip(&self, polygon: &[DVec3]) -> Polygon {
        let reach = |p: &DVec3| p.abs().max_element();
        let farthest = polygon.iter().map(reach).fold(self.offset.abs(), f64::max);
        let depth = |p: DVec3| {
            let depth = self.depth(p);
            if depth.abs() <= ROUNDING * farthest { 0.0 } else { depth }
        };
        let mut inside = Polygon::new();
        for (k, &corner) in polygon.iter().enumerate() {
            let next = polygon[(k + 1) % polygon.len()];
            let (from, to) = (depth(corner), depth(next));
            if from >= 0.0 {
                inside.push(corner);
            }
            if from * to < 0.0 {
                inside.push(corner.lerp(next, from / (from - to)));
            }
        }
        if inside.len() < 3 { Polygon::new() } else { inside }
    }
}
