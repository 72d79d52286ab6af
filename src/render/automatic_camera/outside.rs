//! Views of a whole mesh, and into the box around it, that ask for no place to stand.

use std::f64::consts::PI;

use glam::DVec3;

use super::candidate::{CandidateView, INSIDE_FOV, camera};
use super::surroundings::{Surroundings, near};
use crate::reconstruct::TriMesh;
use crate::scene::Camera;

/// Vertical angle of view from outside, radians: 40°, which fits a room without bending it.
const OUTSIDE_FOV: f64 = 40.0 / 180.0 * PI;

/// Room left around what is seen from outside, as a factor on the distance.
const FRAME: f64 = 1.03;

/// Least cosine between a front and the direction to a viewer outside for it to count in framing;
/// below zero because perspective shows side walls.
const LEAST_FACING: f64 = -0.3;

/// Views from all around, then from the box's corners.
pub(super) fn views(surroundings: &Surroundings<'_>, aspect: f64) -> Vec<CandidateView> {
    let mesh = surroundings.mesh;
    let outside =
        outside_views(mesh, aspect).into_iter().map(|camera| CandidateView { camera, near: 0.0 });
    let box_views = box_views(mesh).into_iter().map(|camera| {
        let near = near(&surroundings.look_around(camera.eye));
        CandidateView { camera, near }
    });
    outside.chain(box_views).collect()
}

/// Views of the whole mesh: straight on from four sides, and from above all around.
fn outside_views(mesh: &TriMesh, aspect: f64) -> Vec<Camera> {
    let straight = (0..4).map(|quarter| (f64::from(quarter) * PI / 2.0, 0.0));
    let raised = [20.0_f64, 40.0].into_iter().flat_map(|elevation| {
        (0..8).map(move |eighth| (f64::from(eighth) * PI / 4.0, elevation.to_radians()))
    });
    straight
        .chain(raised)
        .map(|(azimuth, elevation)| framed(mesh, azimuth, elevation, aspect))
        .collect()
}

/// A view of all fronts that can be seen from a direction; azimuth 0 looks along −z, from the front
/// as modellers have it.
fn framed(mesh: &TriMesh, azimuth: f64, elevation: f64, aspect: f64) -> Camera {
    let back = DVec3::new(
        azimuth.sin() * elevation.cos(),
        elevation.sin(),
        azimuth.cos() * elevation.cos(),
    );
    let right = DVec3::Y.cross(back).normalize();
    let up = back.cross(right);
    let corners: Vec<DVec3> =
        fronts(mesh, back).map(|p| DVec3::new(p.dot(right), p.dot(up), p.dot(back))).collect();
    let low = corners.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = corners.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let centre = if corners.is_empty() { DVec3::ZERO } else { (low + high) / 2.0 };
    let slope = (OUTSIDE_FOV / 2.0).tan();
    let distance = corners
        .iter()
        .map(|corner| corner - centre)
        .map(|offset| (offset.x.abs() / aspect).max(offset.y.abs()) / slope + offset.z)
        .fold(0.0, f64::max);
    let distance = if distance > 0.0 { distance * FRAME } else { 1.0 };
    let target = centre.x * right + centre.y * up + centre.z * back;
    camera(target + distance * back, target, OUTSIDE_FOV)
}

/// Corners, m, of the triangles whose front may be seen from the direction `back`.
fn fronts(mesh: &TriMesh, back: DVec3) -> impl Iterator<Item = DVec3> {
    let corners = mesh.triangles.iter().map(|t| t.map(|corner| mesh.positions[corner as usize]));
    corners
        .filter(move |[a, b, c]| (b - a).cross(c - a).normalize_or_zero().dot(back) > LEAST_FACING)
        .flatten()
}

/// Views from the corners and the walls of the mesh's box to the opposite side, slightly down.
fn box_views(mesh: &TriMesh) -> Vec<Camera> {
    let (low, high) = mesh.bounds();
    let at = |x: f64, y: f64, z: f64| low + (high - low) * DVec3::new(x, y, z);
    let sides = [0.06, 0.5, 0.94];
    let mut views = Vec::new();
    for x in sides {
        for z in sides {
            let middle = x == 0.5 && z == 0.5;
            if !middle && high != low {
                views.push(camera(at(x, 0.62, z), at(1.0 - x, 0.42, 1.0 - z), INSIDE_FOV));
            }
        }
    }
    views
}
