//! A view of the scene.

use glam::DVec3;
use serde::Serialize;

/// A perspective view.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Camera {
    /// The file's name for it, empty if it has none.
    pub name: String,
    /// Where the eye is, m.
    pub eye: DVec3,
    /// A point the eye looks at, m; not the eye itself.
    pub target: DVec3,
    /// The direction that is up in the picture; not along the view.
    pub up: DVec3,
    /// Full vertical angle of view, radians, 0..π.
    pub vertical_fov: f64,
}
