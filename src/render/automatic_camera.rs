//! Finds a view that shows the light, by trying candidates in small.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use super::caster::{Caster, Hit, Sides};
use super::rays::Rays;
use super::shade::radiosity_at;
use crate::colour::luminance;
use crate::reconstruct::TriMesh;
use crate::scene::Camera;
use crate::tone::{Exposure, exposure_scale};

/// Rows of the pictures by which candidates are judged.
const TRIAL_HEIGHT: u32 = 32;

/// Vertical angle of view from outside, radians: 40°, which fits a room without bending it.
const OUTSIDE_FOV: f64 = 40.0 / 180.0 * PI;

/// Vertical angle of view from inside, radians: 70°, as wide as a room needs.
const INSIDE_FOV: f64 = 70.0 / 180.0 * PI;

/// Room left around what is seen from outside, as a factor on the distance.
const FRAME: f64 = 1.03;

/// Least cosine between a front and the direction to a viewer outside for it to count in framing;
/// below zero because perspective shows side walls.
const LEAST_FACING: f64 = -0.3;

/// Share of the best score at which an earlier candidate is preferred, so that rounding does not
/// choose the side from which a symmetric scene is seen.
const GOOD_ENOUGH: f64 = 0.98;

/// Exposed luminance from which a surface counts as lit: a tenth of the mean's.
const LIT: f64 = 0.025;

/// How much of a view's worth is lost if all of it is seen through the backs of walls.
const BACKS_PENALTY: f64 = 0.7;

/// Least cosine between a ray and a surface; what is seen more slantingly is hardly seen.
const LEAST_COSINE: f64 = 0.1;

/// Distance, as a share of the mesh's size, below which a surface stands in the way.
const TOO_NEAR: f64 = 0.06;

/// A view that looks into the room, or at the whole mesh if there is no room, for a picture of
/// width over height `aspect`.
///
/// Of views from all around and from inside, the one that sees the most lit area, fills the
/// picture, and looks through the fewest walls from behind.
pub fn automatic_camera(mesh: &TriMesh, aspect: f64) -> Camera {
    let aspect = if aspect.is_finite() { aspect.clamp(0.1, 10.0) } else { 1.0 };
    let judge = Judge {
        mesh,
        caster: Caster::new(mesh),
        exposure: exposure_scale(mesh, Exposure::Automatic),
        size: extent(mesh),
        aspect,
    };
    let mut candidates = outside_views(mesh, aspect);
    candidates.extend(inside_views(mesh));
    let scores: Vec<f64> = candidates.par_iter().map(|camera| judge.score(camera)).collect();
    let best = scores.iter().copied().fold(0.0, f64::max);
    let chosen = scores.iter().position(|&score| score >= GOOD_ENOUGH * best).unwrap_or(0);
    candidates.swap_remove(chosen)
}

fn extent(mesh: &TriMesh) -> f64 {
    let (low, high) = mesh.bounds();
    (high - low).max_element()
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
fn inside_views(mesh: &TriMesh) -> Vec<Camera> {
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

fn camera(eye: DVec3, target: DVec3, vertical_fov: f64) -> Camera {
    Camera { name: "automatic".to_owned(), eye, target, up: DVec3::Y, vertical_fov }
}

/// What a candidate is measured with.
struct Judge<'a> {
    mesh: &'a TriMesh,
    caster: Caster,
    exposure: f64,
    size: f64,
    aspect: f64,
}

/// Sums over the rays of a trial picture.
#[derive(Default)]
struct Tally {
    rays: f64,
    filled: f64,
    near: f64,
    through_backs: f64,
    /// Area of lit fronts, m².
    lit_area: f64,
}

impl Judge<'_> {
    /// Lit area seen × √(share of the picture filled), less for backs and near things.
    fn score(&self, camera: &Camera) -> f64 {
        let width = (f64::from(TRIAL_HEIGHT) * self.aspect).ceil() as u32;
        let rays = Rays::new(camera, width, TRIAL_HEIGHT);
        let mut tally = Tally::default();
        for row in 0..TRIAL_HEIGHT {
            for column in 0..width {
                let direction = rays.direction(f64::from(column) + 0.5, f64::from(row) + 0.5);
                self.count(&rays, direction, &mut tally);
            }
        }
        let share = |count: f64| count / tally.rays;
        tally.lit_area
            * share(tally.filled).sqrt()
            * (1.0 - BACKS_PENALTY * share(tally.through_backs))
            * (1.0 - share(tally.near)).powi(2)
    }

    fn count(&self, rays: &Rays, direction: DVec3, tally: &mut Tally) {
        let (eye, unit) = (rays.eye, direction.normalize());
        tally.rays += 1.0;
        let Some(hit) = self.caster.first(eye, unit, Sides::Both) else {
            return;
        };
        if hit.distance < TOO_NEAR * self.size {
            tally.near += 1.0;
        }
        let front = if hit.front {
            Some(hit)
        } else {
            tally.through_backs += 1.0;
            self.caster.first(eye, unit, Sides::Front)
        };
        let Some(front) = front else {
            return;
        };
        tally.filled += 1.0;
        if luminance(radiosity_at(self.mesh, &front)) * self.exposure >= LIT {
            let solid_angle = rays.right.cross(rays.down).length() / direction.length().powi(3);
            tally.lit_area += self.area_seen(&front, unit, solid_angle);
        }
    }

    /// Area, m², that a ray stands for: its solid angle, sr, projected on the triangle it meets.
    fn area_seen(&self, hit: &Hit, direction: DVec3, solid_angle: f64) -> f64 {
        let [a, b, c] =
            self.mesh.triangles[hit.triangle].map(|corner| self.mesh.positions[corner as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let cosine = normal.dot(direction).abs().max(LEAST_COSINE);
        solid_angle * hit.distance.powi(2) / cosine
    }
}
