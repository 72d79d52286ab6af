//! The one border between space and a surface's own coordinates.

use glam::{DVec2, DVec3};
use serde::Serialize;

/// A plane with an orthonormal frame; `u × v = normal`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Plane {
    /// The place with coordinates (0, 0), m.
    pub origin: DVec3,
    /// Unit vector of the first coordinate.
    pub u: DVec3,
    /// Unit vector of the second coordinate.
    pub v: DVec3,
    /// Unit normal, towards the front.
    pub normal: DVec3,
}

impl Plane {
    /// The plane through `origin` with unit `normal`, whose first axis runs along `direction` as
    /// far as it can.
    pub fn new(origin: DVec3, normal: DVec3, direction: DVec3) -> Self {
        let along = direction - normal * direction.dot(normal);
        let u = along.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        Self { origin, u, v: normal.cross(u), normal }
    }

    /// Coordinates of a point, dropping its height above the plane.
    pub fn flatten(&self, point: DVec3) -> DVec2 {
        let from_origin = point - self.origin;
        DVec2::new(from_origin.dot(self.u), from_origin.dot(self.v))
    }

    /// The point in space with these coordinates.
    pub fn lift(&self, point: DVec2) -> DVec3 {
        self.origin + self.u * point.x + self.v * point.y
    }

    /// Signed distance of a point from the plane, m; positive in front.
    pub fn height(&self, point: DVec3) -> f64 {
        (point - self.origin).dot(self.normal)
    }

    /// The same plane seen from behind.
    pub fn reversed(&self) -> Self {
        Self { u: self.v, v: self.u, normal: -self.normal, ..*self }
    }
}
