//! Finds a view that shows the light, by trying candidates in small.
//!
//! A mesh in which one can stand with walls around is a room, a house or a courtyard: what counts is how
//! much is seen of what has walls around it, and there are views from eye height above its floors. Any
//! other mesh is a thing, seen from outside.
//!
//! - `surroundings`: what stands around a place
//! - `candidate`, `judge`: a view, and what it is worth
//! - `outside`, `places`: views of the whole, and from places on floors

mod candidate;
mod judge;
mod outside;
mod places;
mod surroundings;

use glam::DVec3;
use rayon::prelude::*;

use crate::reconstruct::TriMesh;
use crate::scene::Camera;

use candidate::{CandidateView, INSIDE_FOV};
use judge::Judge;
use surroundings::Surroundings;

/// Share of the best score at which an earlier candidate is preferred, so that rounding does not
/// choose the side from which a symmetric scene is seen.
const GOOD_ENOUGH: f64 = 0.98;

/// The same of views of the whole against those from places on floors: what shows as much at a
/// glance, without a standpoint to find, is the plainer picture.
const GOOD_OVERVIEW: f64 = 0.8;

/// A view that looks into the room, or at the whole mesh if there is no room, for a picture of
/// width over height `aspect`.
///
/// Of views from all around, from the corners of the mesh's box and from eye height above floors, the
/// one that sees the most lit area, fills the picture, has nothing right before it and looks through
/// the fewest walls from behind. Where there is a room, area counts as far as walls stand around it.
pub fn automatic_camera(mesh: &TriMesh, aspect: f64) -> Camera {
    let aspect = if aspect.is_finite() { aspect.clamp(0.1, 10.0) } else { 1.0 };
    let surroundings = Surroundings::new(mesh);
    let inside = places::inside(&surroundings, aspect);
    let is_room = inside.is_some();
    let (standing, usual) =
        inside.map_or((Vec::new(), surroundings.usual), |inside| (inside.views, inside.usual));
    let judge = Judge { surroundings: &surroundings, aspect, is_room, usual };
    let [overview, standing] =
        [outside::views(&surroundings, aspect), standing].map(|mut views: Vec<CandidateView>| {
            let scores: Vec<f64> = views.par_iter().map(|view| judge.score(view)).collect();
            let best = scores.iter().copied().fold(0.0, f64::max);
            let chosen = scores.iter().position(|&score| score >= GOOD_ENOUGH * best)?;
            Some((views.swap_remove(chosen).camera, best))
        });
    let camera = match (overview, standing) {
        (Some((_, whole)), Some((camera, best))) if whole < GOOD_OVERVIEW * best => Some(camera),
        (overview, _) => overview.map(|(camera, _)| camera),
    };
    camera.unwrap_or_else(|| candidate::camera(DVec3::Z, DVec3::ZERO, INSIDE_FOV))
}
