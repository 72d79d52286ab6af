//! Which sides of faces light from outside meets where it enters a room.
//!
//! Outside says nothing: a room modelled from inside shows its back to the sun, and rightly so.

use glam::DVec3;
use rayon::prelude::*;

use super::sides::{on_sphere, spread};
use super::sight::Sight;
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
pub(super) fn entering(scene: &Scene, sight: &Sight<'_>) -> [usize; 2] {
    let far = |light: &&Light| {
        matches!(light, Light::Directional { .. } | Light::Sun { .. } | Light::Sky { .. })
    };
    let lights: Vec<&Light> = scene.lights.iter().map(|named| &named.light).filter(far).collect();
    if lights.is_empty() {
        return [0; 2];
    }
    let places = places(sight, PLACES);
    let entered: Vec<[bool; 2]> = places
        .par_iter()
        .enumerate()
        .map(|(index, &(place, normal))| {
            [normal, -normal].map(|up| {
                sees_light(sight, &lights, index, (place, up))
                    && is_enclosed(sight, index, (place, up))
            })
        })
        .collect();
    [0, 1].map(|side| entered.iter().filter(|sides| sides[side]).count())
}

/// Places on faces and the faces' unit normals; more on larger ones, as the square roots of their areas, so that
/// a plain round a house does not get them all.
fn places(sight: &Sight<'_>, count: usize) -> Vec<(DVec3, DVec3)> {
    let weight = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).length().sqrt();
    let total: f64 = sight.triangles().map(|(_, corners)| weight(corners)).sum();
    let (mut passed, mut places) = (0.0, Vec::with_capacity(count));
    for (_, corners) in sight.triangles() {
        passed += weight(corners);
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        while (places.len() as f64 + 0.5) / (count as f64) < passed / total {
            let [s, t, ..] = spread(places.len());
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            places.push((a + s * (b - a) + t * (c - a), normal));
        }
    }
    places
}

fn sees_light(
    sight: &Sight<'_>,
    lights: &[&Light],
    index: usize,
    (place, up): (DVec3, DVec3),
) -> bool {
    (0..LOOKS).any(|look| {
        let number = LOOKS * index + look;
        let towards = match *lights[number % lights.len()] {
            Light::Directional { direction, .. } | Light::Sun { direction, .. } => -direction,
            _ => {
                let [u, v, ..] = spread(number);
                on_sphere((1.0 + u) / 2.0, v)
            }
        };
        towards.dot(up) > 0.0 && sight.first(place, towards).is_none()
    })
}

fn is_enclosed(sight: &Sight<'_>, index: usize, (place, up): (DVec3, DVec3)) -> bool {
    let meets_wall = |look: &usize| {
        let [.., u, v] = spread(AROUND * index + look);
        sight.first(place, (up + on_sphere(u, v)).normalize_or(up)).is_some()
    };
    (0..AROUND).filter(meets_wall).count() >= ENCLOSED
}
