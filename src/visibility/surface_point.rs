//! Points of surfaces, from which what is around is looked at.

use glam::DVec3;

use crate::geometry::HalfSpace;

/// A point on a surface, and which way the surface faces there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Where it is, m.
    pub position: DVec3,
    /// Unit normal of the surface.
    pub normal: DVec3,
}

impl SurfacePoint {
    /// The point at `position` on a surface with this unit `normal`.
    pub fn new(position: DVec3, normal: DVec3) -> Self {
        Self { position, normal }
    }

    /// What is above the surface's plane: all that the point may see.
    pub fn above(&self) -> HalfSpace {
        HalfSpace::new(self.position, self.normal)
    }
}
