//! Exposure by what a camera sees.

use rayon::prelude::*;

use super::caster::{Caster, VisibleSides};
use super::rays::CameraRays;
use super::shade::radiosity_at;
use crate::colour::luminance;
use crate::reconstruct::TriMesh;
use crate::scene::Camera;
use crate::tone::{Exposure, UNLIT, exposure_of_view};

/// Rows of rays by which a view is metered.
const ROWS: u32 = 48;

/// How many times brighter than half of what is seen a place may be before it counts as no more: a lamp.
const LAMP: f64 = 8.0;

/// The exposure of a picture of width over height `aspect`, by the surfaces that `camera` sees.
///
/// Automatic exposure of the mesh, moved as little as brings the log-average luminance of what is seen to within
/// 2/3 EV of middle grey. Sky and sun are not metered; lamps count as eight times the median, however bright they
/// are, and what is darker than a thousandth of the mean is left out.
pub fn exposure_seen(mesh: &TriMesh, camera: &Camera, aspect: f64) -> Exposure {
    let aspect = if aspect.is_finite() { aspect.clamp(0.1, 10.0) } else { 1.0 };
    let width = (f64::from(ROWS) * aspect).ceil() as u32;
    let rays = CameraRays::new(camera, width, ROWS);
    let caster = Caster::new(mesh);
    let look = |index: u32| {
        let (column, row) = (index % width, index / width);
        let direction = rays.direction(f64::from(column) + 0.5, f64::from(row) + 0.5);
        let hit = caster.first(rays.eye, direction.normalize(), VisibleSides::Front)?;
        Some(luminance(radiosity_at(mesh, &hit)))
    };
    let seen: Vec<f64> = (0..width * ROWS).into_par_iter().filter_map(look).collect();
    exposure_of_view(mesh, log_average(seen))
}

/// Of what is lit, lamps held back.
fn log_average(mut seen: Vec<f64>) -> Option<f64> {
    seen.retain(|&luminance| luminance > 0.0);
    seen.sort_by(f64::total_cmp);
    let lamp = LAMP * seen.get(seen.len() / 2)?;
    seen.iter_mut().for_each(|luminance| *luminance = luminance.min(lamp));
    let unlit = UNLIT * seen.iter().sum::<f64>() / seen.len() as f64;
    seen.retain(|&luminance| luminance > unlit);
    Some((seen.iter().map(|luminance| luminance.ln()).sum::<f64>() / seen.len() as f64).exp())
}
