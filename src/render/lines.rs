//! How much of a place in the picture a mesh line covers.

use glam::DVec3;

use super::caster::MeshHit;
use super::rays::CameraRays;
use crate::reconstruct::TriMesh;

/// Height of a triangle in the picture, pixels, below which its lines fade, so that fine meshes
/// turn grey instead of black.
const FULL_STRENGTH: f64 = 6.0;

/// Coverage, 0..=1, by the edges of the triangle that the ray along `direction` meets.
///
/// An edge's function d·(P×Q) is linear in the direction d and so in the picture's coordinates:
/// divided by its gradient it is the distance in pixels. Lines fall off linearly to one pixel on
/// either side, which looks one pixel wide; neighbours draw half a line each.
pub(super) fn line_coverage(
    mesh: &TriMesh,
    rays: &CameraRays,
    direction: DVec3,
    hit: &MeshHit,
) -> f64 {
    let [a, b, c] =
        mesh.triangles[hit.triangle].map(|corner| mesh.positions[corner as usize] - rays.eye);
    let mut nearest = f64::INFINITY;
    let mut lowest = f64::INFINITY;
    for (edge, weight) in
        [(c.cross(b), hit.weights.x), (a.cross(c), hit.weights.y), (b.cross(a), hit.weights.z)]
    {
        let gradient = rays.right.dot(edge).hypot(rays.down.dot(edge));
        let distance = (direction.dot(edge) / gradient).abs();
        nearest = nearest.min(distance);
        if weight > 0.0 {
            lowest = lowest.min(distance / weight);
        }
    }
    (1.0 - nearest).clamp(0.0, 1.0) * (lowest / FULL_STRENGTH).min(1.0)
}
