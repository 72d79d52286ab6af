//! What stands around a place.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::colour::luminance;
use crate::reconstruct::TriMesh;
use crate::render::caster::{Caster, MeshHit, VisibleSides};
use crate::render::shade::radiosity_at;
use crate::tone::log_average_luminance;

/// Level directions in which walls are looked for around a point of a surface.
const COMPASS: u32 = 8;

/// Level directions in which an eye looks around.
pub(super) const AROUND: u32 = 24;

/// Distance below which a surface stands in the way, as a share of that within which three quarters of what is around
/// are: an eye in a corner has walls beside it.
const TOO_NEAR: f64 = 0.25;

/// How far the directions from a surface lean off the surface, so that they do not run along it.
const LEAN: f64 = 0.15;

/// Distance from a surface, as a share of the mesh's size, at which a ray begins.
const CLEARANCE: f64 = 1e-5;

/// Share of the mesh's usual luminance below which a surface is in the dark: a room may be much
/// dimmer than the sunlit garden around it, but not without light.
const DARK: f64 = 1e-5;

/// Shares of directions with walls below which a point is in the open, and from which it is inside.
const OPEN_AND_ENCLOSED: [f64; 2] = [0.4, 0.7];

/// A mesh that can be looked at from anywhere.
pub(super) struct Surroundings<'a> {
    pub(super) mesh: &'a TriMesh,
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    caster: Caster,
    /// Log-average of the luminance of the mesh's radiosity, W/m².
    pub(super) usual: f64,
}

/// What a ray meets.
#[derive(Clone, Copy, Default)]
pub(super) struct Sighting {
    /// Distance to the first surface, from whichever side, m; infinite if there is none.
    pub(super) distance: f64,
    /// Whether that is seen from its back.
    pub(super) through_back: bool,
    /// The first front.
    pub(super) front: Option<Front>,
}

/// A front that is seen.
#[derive(Clone, Copy)]
pub(super) struct Front {
    pub(super) place: DVec3,
    pub(super) normal: DVec3,
    /// Distance, m.
    pub(super) distance: f64,
    /// Of its radiosity, W/m²; 0 in the dark.
    pub(super) luminance: f64,
}

impl<'a> Surroundings<'a> {
    pub(super) fn new(mesh: &'a TriMesh) -> Self {
        let (low, high) = mesh.bounds();
        let usual = log_average_luminance(mesh).unwrap_or_default();
        Self { mesh, low, high, caster: Caster::new(mesh), usual }
    }

    /// Longest side of the mesh's box, m.
    pub(super) fn size(&self) -> f64 {
        (self.high - self.low).max_element()
    }

    /// Distance from a surface at which a ray begins, m.
    pub(super) fn clearance(&self) -> f64 {
        CLEARANCE * self.size()
    }

    /// What is met along a unit vector.
    pub(super) fn look(&self, eye: DVec3, direction: DVec3) -> Sighting {
        let Some(hit) = self.caster.first(eye, direction, VisibleSides::Both) else {
            return Sighting { distance: f64::INFINITY, ..Sighting::default() };
        };
        let front = match hit.front {
            true => Some(hit),
            false => self.caster.first(eye, direction, VisibleSides::Front),
        };
        let front = front.map(|front| self.front(eye, direction, &front));
        Sighting { distance: hit.distance, through_back: !hit.front, front }
    }

    fn front(&self, eye: DVec3, direction: DVec3, hit: &MeshHit) -> Front {
        let corners = self.mesh.triangles[hit.triangle];
        let [a, b, c] = corners.map(|corner| self.mesh.positions[corner as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let luminance = luminance(radiosity_at(self.mesh, hit));
        let luminance = if luminance > DARK * self.usual { luminance } else { 0.0 };
        Front { place: eye + hit.distance * direction, normal, distance: hit.distance, luminance }
    }

    /// What is met all around at the height of an eye.
    pub(super) fn look_around(&self, eye: DVec3) -> Vec<Sighting> {
        compass(AROUND).map(|direction| self.look(eye, direction)).collect()
    }

    /// How much a point of a surface is inside of something, 0..=1, by the walls around it; what is
    /// above does not matter, a courtyard is a room.
    pub(super) fn insideness(&self, front: &Front) -> f64 {
        let start = front.place + self.clearance() * front.normal;
        let ahead = compass(COMPASS)
            .filter(|direction| direction.dot(front.normal) > -LEAN / 2.0)
            .map(|direction| (direction + LEAN * front.normal).normalize());
        let (mut directions, mut walls) = (0.0, 0.0);
        for direction in ahead {
            let sight = self.look(start, direction);
            directions += 1.0;
            walls += f64::from(u8::from(sight.is_wall()));
        }
        let [open, enclosed] = OPEN_AND_ENCLOSED;
        ((walls / directions - open) / (enclosed - open)).clamp(0.0, 1.0)
    }
}

impl Sighting {
    /// Whether a lit front is the first thing met.
    pub(super) fn is_wall(&self) -> bool {
        !self.through_back && self.front.is_some_and(|front| front.luminance > 0.0)
    }
}

/// Distance, m, below which something stands in the way of an eye that meets this all around; 0 in the open.
pub(super) fn near(around: &[Sighting]) -> f64 {
    let mut distances: Vec<f64> = around.iter().map(|sight| sight.distance).collect();
    distances.sort_by(f64::total_cmp);
    distances
        .get(distances.len() / 2)
        .filter(|half| half.is_finite())
        .map_or(0.0, |half| TOO_NEAR * half)
}

/// Level directions all around.
fn compass(count: u32) -> impl Iterator<Item = DVec3> {
    let direction = move |k: u32| {
        let (z, x) = (TAU * f64::from(k) / f64::from(count)).sin_cos();
        DVec3::new(x, 0.0, z)
    };
    (0..count).map(direction)
}
