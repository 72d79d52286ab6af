//! Which sides of faces light from outside meets where it enters a room.
//!
//! Outside says nothing: a room modelled from inside shows its back to the sun, and rightly so.

use glam::DVec3;
use rayon::prelude::*;

use super::ray_casting::{ProbeRay, RayCaster};
use super::sequence::{on_sphere, on_triangle, spread};
use super::{Light, Scene};

/// Directions in which a place looks for light.
const LOOKS: usize = 4;

/// Directions in which a place looks for walls around it.
const AROUND: usize = 8;

/// Of these, as many must meet one: outside, the ground fills half the view from a wall.
const ENCLOSED: usize = 6;

/// Places to look from.
const PLACES: usize = 1024;

/// Fewer places than this are chance.
pub(super) const FEWEST_ENTERED: usize = 4;

/// Numbers of places in rooms that light from outside reaches straight, on fronts and on backs.
pub(super) fn entering(scene: &Scene, caster: &RayCaster<'_>) -> [usize; 2] {
    let far = |light: &&Light| {
        matches!(light, Light::Directional { .. } | Light::Sun { .. } | Light::Sky { .. })
    };
    let lights: Vec<&Light> = scene.lights.iter().map(|named| &named.light).filter(far).collect();
    if lights.is_empty() {
        return [0; 2];
    }
    let entered: Vec<[bool; 2]> = look_points(caster, PLACES)
        .par_iter()
        .map(|front| {
            let back = &LookPoint { up: -front.up, ..*front };
            [front, back].map(|out| out.sees_light(caster, &lights) && out.is_enclosed(caster))
        })
        .collect();
    [0, 1].map(|side| entered.iter().filter(|sides| sides[side]).count())
}

/// A place on a face, to look from.
struct LookPoint {
    /// Which of the places it is: each has directions of its own.
    index: usize,
    place: DVec3,
    /// Unit normal of the side that looks.
    up: DVec3,
}

/// Places on the fronts of faces; more on larger ones, as the square roots of their areas, so that
/// a plain round a house does not get them all.
fn look_points(caster: &RayCaster<'_>, count: usize) -> Vec<LookPoint> {
    let weight = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).length().sqrt();
    let total: f64 = caster.triangles().map(|(_, corners)| weight(corners)).sum();
    let (mut passed, mut look_points) = (0.0, Vec::with_capacity(count));
    for (_, corners) in caster.triangles() {
        passed += weight(corners);
        let [a, b, c] = corners;
        let up = (b - a).cross(c - a).normalize_or_zero();
        while (look_points.len() as f64 + 0.5) / (count as f64) < passed / total {
            let index = look_points.len();
            let [s, t, ..] = spread(index);
            look_points.push(LookPoint { index, place: on_triangle(corners, s, t), up });
        }
    }
    look_points
}

impl LookPoint {
    fn sees_light(&self, caster: &RayCaster<'_>, lights: &[&Light]) -> bool {
        (0..LOOKS).any(|look| {
            let number = LOOKS * self.index + look;
            let direction = match *lights[number % lights.len()] {
                Light::Directional { direction, .. } | Light::Sun { direction, .. } => -direction,
                _ => {
                    let [u, v, ..] = spread(number);
                    on_sphere((1.0 + u) / 2.0, v)
                }
            };
            let ray = ProbeRay { start: self.place, direction };
            direction.dot(self.up) > 0.0 && caster.first(&ray).is_none()
        })
    }

    fn is_enclosed(&self, caster: &RayCaster<'_>) -> bool {
        let meets_wall = |look: &usize| {
            let [.., u, v] = spread(AROUND * self.index + look);
            let direction = (self.up + on_sphere(u, v)).normalize_or(self.up);
            caster.first(&ProbeRay { start: self.place, direction }).is_some()
        };
        (0..AROUND).filter(meets_wall).count() >= ENCLOSED
    }
}
