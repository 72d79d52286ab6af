//! Which ray belongs to which place in the picture.

use glam::DVec3;

use crate::scene::Camera;

/// A camera with a picture's size.
pub(super) struct CameraRays {
    pub(super) eye: DVec3,
    /// Direction to the picture's top left corner, not of unit length.
    corner: DVec3,
    /// Change of direction a pixel to the right.
    pub(super) right: DVec3,
    /// Change of direction a pixel down.
    pub(super) down: DVec3,
}

impl CameraRays {
    /// Rays that exist for every camera: one that looks nowhere looks along −z.
    pub(super) fn new(camera: &Camera, width: u32, height: u32) -> Self {
        let forward = (camera.target - camera.eye).normalize_or(DVec3::NEG_Z);
        let side = forward.cross(camera.up).normalize_or(forward.any_orthonormal_vector());
        let up = side.cross(forward);
        let (width, height) = (f64::from(width.max(1)), f64::from(height.max(1)));
        let pixel = 2.0 * (camera.vertical_fov / 2.0).tan() / height;
        let (right, down) = (side * pixel, -up * pixel);
        let corner = forward - right * (width / 2.0) - down * (height / 2.0);
        Self { eye: camera.eye, corner, right, down }
    }

    /// Direction of the ray through `x` pixels from the left and `y` from the top; not of unit length.
    pub(super) fn direction(&self, x: f64, y: f64) -> DVec3 {
        self.corner + x * self.right + y * self.down
    }
}

/// A camera at the same place that sees, `zoom` times as large, what is around a place of a picture of
/// this `size`, pixels.
pub fn close_up(camera: &Camera, size: [u32; 2], [x, y]: [f64; 2], zoom: f64) -> Camera {
    let direction = CameraRays::new(camera, size[0], size[1]).direction(x, y);
    let half = (camera.vertical_fov / 2.0).tan() / zoom;
    Camera {
        target: camera.eye + direction.normalize_or(DVec3::NEG_Z),
        vertical_fov: 2.0 * half.atan(),
        ..camera.clone()
    }
}
