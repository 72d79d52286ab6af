//! Places to stand: above floors, with walls around.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rayon::prelude::*;

use super::candidate::{CandidateView, INSIDE_FOV, camera};
use super::judge::TrialSums;
use super::surroundings::{AROUND, Sighting, Surroundings, near};

/// Places along the longer side of the mesh's footprint, and where those find too few inside: a house may stand in
/// a large garden.
const GRIDS: [u32; 2] = [14, 40];

/// Places inside that are enough.
const ENOUGH: usize = 6;

/// Most floors above one another that are looked at.
const STOREYS: usize = 12;

/// Height of the eye above the floor, m, where the room allows it.
const EYE_HEIGHT: f64 = 1.6;

/// Highest share of the headroom at which the eye is.
const HIGHEST: f64 = 0.62;

/// Lowest share of the headroom at which the eye is, and the same where the room is so high, m, that its unit is
/// hardly the metre.
const LOWEST: f64 = 0.05;
const LOWEST_IN_OTHER_UNITS: f64 = 0.4;
const UNLIKELY_HEADROOM: f64 = 30.0;

/// Headroom, m, that a person needs, and the share of the mesh's height that does in small meshes: the underside of
/// a table is no ceiling, nor is a hollow in a chair a room.
const LEAST_HEADROOM: f64 = 1.8;
const LEAST_SHARE_OF_HEIGHT: f64 = 0.6;

/// Share of level directions in which a wall stands around a place inside.
const ENCLOSED: f64 = 0.7;

/// Views that are judged closely.
const MOST_VIEWS: usize = 12;

/// Angles, degrees, below and above the horizon by which views are turned.
const PITCHES: [f64; 2] = [-8.0, 8.0];

/// Elevations, degrees, of the rays by which a view is judged quickly.
const ELEVATIONS: [f64; 3] = [-20.0, 0.0, 20.0];

/// Height of the ring that each of those stands for, radians.
const RING: f64 = 20.0 / 180.0 * PI;

/// A place inside.
struct Standpoint {
    eye: DVec3,
    /// Distance below which a surface stands in the way, m.
    near: f64,
}

/// What there is inside.
pub(super) struct Inside {
    /// The best views.
    pub(super) views: Vec<CandidateView>,
    /// Log-average of the luminance of what is seen from places there, W/m²: a room may be much dimmer than the
    /// garden around it.
    pub(super) usual: f64,
}

/// The views from places inside, for a picture of width over height `aspect`; `None` if nothing has walls around.
pub(super) fn inside(surroundings: &Surroundings<'_>, aspect: f64) -> Option<Inside> {
    let mut found = places(surroundings, GRIDS[0]);
    if found.len() < ENOUGH {
        found = places(surroundings, GRIDS[1]);
    }
    let around: Vec<Panorama> =
        found.par_iter().map(|place| Panorama::new(surroundings, place.eye)).collect();
    let seen = || around.iter().flat_map(Panorama::luminances);
    let usual = (seen().map(f64::ln).sum::<f64>() / seen().count().max(1) as f64).exp();
    let half_width = (aspect * (INSIDE_FOV / 2.0).tan()).atan();
    let best = |(place, around): (&Standpoint, &Panorama)| {
        around.best_direction(half_width, place.near, usual)
    };
    let mut ranked: Vec<_> = found.iter().zip(&around).map(|pair| (best(pair), pair.0)).collect();
    ranked.sort_by(|a, b| b.0.0.total_cmp(&a.0.0));
    ranked.truncate(MOST_VIEWS);
    let views =
        ranked.iter().flat_map(|((_, azimuth), place)| PITCHES.map(|p| place.view(*azimuth, p)));
    (!ranked.is_empty()).then(|| Inside { views: views.collect(), usual })
}

/// The places inside that a grid finds.
fn places(surroundings: &Surroundings<'_>, grid: u32) -> Vec<Standpoint> {
    columns(surroundings, grid)
        .par_iter()
        .flat_map_iter(|&top| floors(surroundings, top))
        .filter_map(|(floor, headroom)| Standpoint::new(surroundings, floor, headroom))
        .collect()
}

/// Points above the mesh, on a grid.
fn columns(surroundings: &Surroundings<'_>, grid: u32) -> Vec<DVec3> {
    let (low, extent) = (surroundings.low, surroundings.high - surroundings.low);
    let cell = extent.x.max(extent.z) / f64::from(grid);
    if !(cell > 0.0 && cell.is_finite()) {
        return Vec::new();
    }
    let [columns, rows] = [extent.x, extent.z].map(|side| (side / cell).ceil().max(1.0) as u32);
    let share = |index: u32, count: u32| (f64::from(index) + 0.5) / f64::from(count);
    let top = surroundings.high.y + 0.01 * surroundings.size();
    let at = |row, column| {
        let (x, z) = (share(column, columns) * extent.x, share(row, rows) * extent.z);
        DVec3::new(low.x + x, top, low.z + z)
    };
    (0..rows).flat_map(|row| (0..columns).map(move |column| at(row, column))).collect()
}

/// Floors below a point, each with the headroom above it, m.
fn floors(surroundings: &Surroundings<'_>, top: DVec3) -> Vec<(DVec3, f64)> {
    let least =
        LEAST_HEADROOM.min(LEAST_SHARE_OF_HEIGHT * (surroundings.high.y - surroundings.low.y));
    let mut floors = Vec::new();
    let mut from = top;
    for _ in 0..STOREYS {
        let sight = surroundings.look(from, DVec3::NEG_Y);
        if sight.distance.is_infinite() {
            break;
        }
        let place = from - sight.distance * DVec3::Y;
        if !sight.through_back {
            let above = surroundings.look(place + surroundings.clearance() * DVec3::Y, DVec3::Y);
            let headroom = above.distance.min(surroundings.high.y - place.y);
            // Under a ceiling seen from its back one is inside of something solid.
            if headroom > 0.0 && headroom >= least && !above.through_back {
                floors.push((place, headroom));
            }
        }
        from = place - surroundings.clearance() * DVec3::Y;
    }
    floors
}

impl Standpoint {
    /// A place at eye height above a floor, if walls stand around it.
    fn new(surroundings: &Surroundings<'_>, floor: DVec3, headroom: f64) -> Option<Self> {
        let lowest = if headroom > UNLIKELY_HEADROOM { LOWEST_IN_OTHER_UNITS } else { LOWEST };
        let height = EYE_HEIGHT.clamp(lowest * headroom, HIGHEST * headroom);
        let eye = floor + height * DVec3::Y;
        let sights = surroundings.look_around(eye);
        let walls = sights.iter().filter(|sight| sight.is_wall()).count();
        (walls as f64 >= ENCLOSED * sights.len() as f64).then(|| Self { eye, near: near(&sights) })
    }

    fn view(&self, azimuth: f64, pitch: f64) -> CandidateView {
        let target = self.eye + direction(azimuth, pitch.to_radians());
        CandidateView { camera: camera(self.eye, target, INSIDE_FOV), near: self.near }
    }
}

/// What is seen all around a place, a column of rays a direction.
struct Panorama(Vec<[PanoramaRay; ELEVATIONS.len()]>);

struct PanoramaRay {
    sight: Sighting,
    /// A unit vector.
    direction: DVec3,
    /// What the ray stands for, sr.
    solid_angle: f64,
}

/// Angle between columns, radians.
const STEP: f64 = TAU / AROUND as f64;

impl Panorama {
    fn new(surroundings: &Surroundings<'_>, eye: DVec3) -> Self {
        let ray = |column: u32, elevation: f64| {
            let direction = direction(STEP * f64::from(column), elevation.to_radians());
            let solid_angle = STEP * RING * elevation.to_radians().cos();
            PanoramaRay { sight: surroundings.look(eye, direction), direction, solid_angle }
        };
        Self((0..AROUND).map(|column| ELEVATIONS.map(|elevation| ray(column, elevation))).collect())
    }

    /// Of lit fronts, W/m².
    fn luminances(&self) -> impl Iterator<Item = f64> {
        let fronts = self.0.as_flattened().iter().filter_map(|ray| ray.sight.front);
        fronts.map(|front| front.luminance).filter(|&luminance| luminance > 0.0)
    }

    /// Worth and azimuth, radians, of the level view that shows the most; things nearer than `near`, m, stand in the
    /// way.
    fn best_direction(&self, half_width: f64, near: f64, usual: f64) -> (f64, f64) {
        let count = self.0.len();
        let reach = ((half_width / STEP).floor() as usize).min(count / 2 - 1);
        let worth = |middle: usize| {
            let mut sums = TrialSums::default();
            for column in middle + count - reach..=middle + count + reach {
                for ray in &self.0[column % count] {
                    sums.add(&ray.sight, ray.direction, ray.solid_angle, near);
                }
            }
            sums.worth(usual)
        };
        let all = (0..count).map(|middle| (worth(middle), STEP * middle as f64));
        all.fold((0.0, 0.0), |best, next| if next.0 > best.0 { next } else { best })
    }
}

fn direction(azimuth: f64, elevation: f64) -> DVec3 {
    let (z, x) = azimuth.sin_cos();
    DVec3::new(x * elevation.cos(), elevation.sin(), z * elevation.cos())
}
