//! What a view is worth, by a picture in small.

use glam::DVec3;

use super::candidate::CandidateView;
use super::surroundings::{Front, Sighting, Surroundings};
use crate::render::rays::CameraRays;

/// Rows of the pictures by which candidates are judged.
const TRIAL_HEIGHT: u32 = 32;

/// Rows and columns from one ray whose front is asked for walls around it to the next.
const SPARSE: u32 = 5;

/// Worth of looking into a room or courtyard from above, where nobody stands.
const FROM_ABOVE: f64 = 0.4;

/// Luminance from which a surface counts as lit, as a share of the usual one.
const LIT: f64 = 0.11;

/// How much of a view's worth is lost if all of it is seen through the backs of walls.
const BACKS_PENALTY: f64 = 0.7;

/// Least cosine between a ray and a surface; what is seen more slantingly is hardly seen.
const LEAST_COSINE: f64 = 0.1;

/// What candidates are measured with.
pub(super) struct Judge<'a> {
    pub(super) surroundings: &'a Surroundings<'a>,
    pub(super) aspect: f64,
    /// Whether there is an inside, so that what is outside of it counts for nothing.
    pub(super) is_room: bool,
    /// Luminance, W/m², of which [`LIT`] is a share.
    pub(super) usual: f64,
}

/// Sums over the rays of a trial picture.
#[derive(Default)]
pub(super) struct TrialSums {
    rays: f64,
    filled: f64,
    near: f64,
    through_backs: f64,
    /// Areas of fronts, m², and luminances, W/m².
    seen: Vec<(f64, f64)>,
}

impl Judge<'_> {
    /// Worth of a view's [`TrialSums`], as far as it shows the inside if there is one.
    pub(super) fn score(&self, view: &CandidateView) -> f64 {
        let width = (f64::from(TRIAL_HEIGHT) * self.aspect).ceil() as u32;
        let rays = CameraRays::new(&view.camera, width, TRIAL_HEIGHT);
        let mut sums = TrialSums::default();
        let (mut asked, mut inside) = (0.0, 0.0);
        for row in 0..TRIAL_HEIGHT {
            for column in 0..width {
                let direction = rays.direction(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let solid_angle = rays.right.cross(rays.down).length() / direction.length().powi(3);
                let unit = direction.normalize();
                let sight = self.surroundings.look(rays.eye, unit);
                let front = sums.add(&sight, unit, solid_angle, view.near);
                let is_asked = row % SPARSE == SPARSE / 2 && column % SPARSE == SPARSE / 2;
                if let Some((front, area)) = front.filter(|_| self.is_room && is_asked) {
                    asked += area;
                    inside += area * self.surroundings.insideness(&front);
                }
            }
        }
        let share = if self.is_room && asked > 0.0 { inside / asked } else { 1.0 };
        let is_above = self.is_room && rays.eye.y > self.surroundings.high.y;
        sums.worth(self.usual) * share * if is_above { FROM_ABOVE } else { 1.0 }
    }
}

impl TrialSums {
    /// Counts what is met along a unit vector that stands for a solid angle, sr; returns the front and the area, m²,
    /// that is seen of it.
    pub(super) fn add(
        &mut self,
        sight: &Sighting,
        direction: DVec3,
        solid_angle: f64,
        near: f64,
    ) -> Option<(Front, f64)> {
        self.rays += 1.0;
        self.near += f64::from(u8::from(sight.distance < near));
        self.through_backs += f64::from(u8::from(sight.through_back));
        let front = sight.front?;
        self.filled += 1.0;
        let cosine = front.normal.dot(direction).abs().max(LEAST_COSINE);
        let area = solid_angle * front.distance.powi(2) / cosine;
        self.seen.push((area, front.luminance));
        Some((front, area))
    }

    /// Lit area seen × √(share of the picture filled), less for backs and near things; the usual luminance is `usual`,
    /// W/m².
    pub(super) fn worth(&self, usual: f64) -> f64 {
        let share = |count: f64| count / self.rays.max(1.0);
        self.lit_area(usual)
            * share(self.filled).sqrt()
            * (1.0 - BACKS_PENALTY * share(self.through_backs))
            * (1.0 - share(self.near)).powi(2)
    }

    /// Area, m², that is bright enough.
    fn lit_area(&self, usual: f64) -> f64 {
        let is_lit = |luminance: f64| luminance > 0.0 && luminance >= LIT * usual;
        self.seen.iter().filter(|(_, luminance)| is_lit(*luminance)).map(|(area, _)| area).sum()
    }
}
