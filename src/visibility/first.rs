//! What a ray meets first.

use glam::DVec3;
use obvhs::ray::RayHit;

use super::occluder::Occluder;
use super::occluders::Occluders;
use crate::geometry::hierarchy::ray;
use crate::surface::SurfaceId;

/// Where a ray meets an occluder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// The place, m.
    pub place: DVec3,
    /// Index into [`Surfaces::list`](crate::surface::Surfaces::list), of a double-sided polygon its first
    /// entry; of occluders from polygons, into those.
    pub surface: SurfaceId,
    /// True if the ray comes from the polygon's front.
    pub front: bool,
}

impl Occluders {
    /// What a ray from a place meets first; polygons that the place lies on are none of it.
    ///
    /// `direction` is a unit vector.
    pub fn first(&self, place: DVec3, direction: DVec3) -> Option<Met> {
        if self.polygons.is_empty() {
            return None;
        }
        let ray = ray(place - self.centre, direction, f32::INFINITY);
        let mut nearest: Option<(f64, usize)> = None;
        let mut ignored = RayHit::none();
        self.bvh.ray_traverse(ray, &mut ignored, |_, slot| {
            let met = self.polygons[slot].meet(place, direction, self.epsilon);
            let Some(distance) = met.filter(|&d| nearest.is_none_or(|(nearest, _)| d < nearest))
            else {
                return f32::INFINITY;
            };
            nearest = Some((distance, slot));
            // Beyond it by more than 32 bits round: boxes at the same distance are still to be entered.
            (distance + self.epsilon) as f32
        });
        nearest.map(|(distance, slot)| {
            let Occluder { surface, plane, .. } = self.polygons[slot];
            let front = plane.depth(place) > 0.0;
            Met { place: place + direction * distance, surface, front }
        })
    }
}

impl Occluder {
    /// Distance along a ray to the polygon, m, if the ray meets it.
    fn meet(&self, place: DVec3, direction: DVec3, epsilon: f64) -> Option<f64> {
        let (depth, slope) = (self.plane.depth(place), self.plane.normal.dot(direction));
        if depth.abs() <= epsilon || depth * slope >= 0.0 {
            return None;
        }
        let distance = -depth / slope;
        self.holds(place + direction * distance, epsilon).then_some(distance)
    }
}
