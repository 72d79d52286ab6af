//! A view that may be chosen.

use std::f64::consts::PI;

use glam::DVec3;

use crate::scene::Camera;

/// Vertical angle of view from inside, radians: 70°, as wide as a room needs.
pub(super) const INSIDE_FOV: f64 = 70.0 / 180.0 * PI;

/// A candidate.
pub(super) struct CandidateView {
    pub(super) camera: Camera,
    /// Distance below which a surface stands in the way, m.
    pub(super) near: f64,
}

/// A camera that keeps its head up.
pub(super) fn camera(eye: DVec3, target: DVec3, vertical_fov: f64) -> Camera {
    Camera { name: "automatic".to_owned(), eye, target, up: DVec3::Y, vertical_fov }
}
