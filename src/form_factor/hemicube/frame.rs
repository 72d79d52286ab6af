//! The frame of a hemicube: its eye, and the axes that it is turned to.

use glam::{DMat3, DVec3, Vec3};

use crate::geometry::HalfSpace;
use crate::visibility::SurfacePoint;

/// Where a hemicube is, and how it is turned.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// The origin, m.
    pub(super) eye: DVec3,
    /// The rows are the hemicube's x, y and z.
    pub(super) axes: DMat3,
}

impl Frame {
    /// The frame of a hemicube over a point, turned about its normal by `turn` radians.
    pub(super) fn new(point: SurfacePoint, turn: f64) -> Self {
        Self { eye: point.position, axes: axes(point.normal, turn) }
    }

    /// The hemicube's z, a unit vector.
    #[inline(always)]
    pub(super) fn normal(&self) -> DVec3 {
        self.axes.row(2)
    }

    /// What is above the horizon.
    pub(super) fn above(&self) -> HalfSpace {
        HalfSpace::new(self.eye, self.normal())
    }

    /// The vector n with n · p = 1 on a plane in the frame, above which the eye is at this height, m.
    #[inline(always)]
    pub(super) fn plane(&self, normal: DVec3, height: f64) -> Vec3 {
        (self.axes * normal / -height).as_vec3()
    }
}

/// Rotation into axes about a normal, which are its rows: x, y and the normal as z.
pub(in crate::form_factor) fn axes(normal: DVec3, turn: f64) -> DMat3 {
    let (sine, cosine) = turn.sin_cos();
    let (x, y) = normal.any_orthonormal_pair();
    DMat3::from_cols(x * cosine + y * sine, y * cosine - x * sine, normal).transpose()
}

/// Angle by which the `index`-th hemicube is turned, radians: no two alike, so that their cells'
/// errors do not add up.
pub(crate) fn turn(index: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (index * GOLDEN).fract() * std::f64::consts::FRAC_PI_2
}
