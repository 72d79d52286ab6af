//! Direct light by a ray to each emitter: right on the mean, and cheap.

use glam::DVec3;

use super::emitter::Emitter;
use super::emitters::Emitters;
use super::punctual;
use super::view::EmitterView;
use crate::colour::Rgb;
use crate::visibility::{Occluders, SurfacePoint};

/// Emitters that send less than this share of the light are looked at as much more seldom.
const WORTH_A_RAY: f64 = 0.1;

impl Emitters {
    /// What arrives at a point of a surface, W/m², on the mean over the values that `random` gives, even
    /// in 0..1; it may be below zero.
    ///
    /// What would arrive if nothing stood between is exact, and a ray to a place on the emitter tells of what is
    /// hidden. So there is no noise where nothing is.
    pub fn sample_unbiased(
        &self,
        occluders: &Occluders,
        receiver: SurfacePoint,
        mut random: impl FnMut() -> f64,
    ) -> Rgb {
        let views: Vec<EmitterView<'_>> =
            self.list.iter().filter_map(|emitter| emitter.view(receiver)).collect();
        let all: f64 = views.iter().map(|view| view.unoccluded().element_sum()).sum();
        let mut light = Rgb::ZERO;
        for view in &views {
            let sent = view.unoccluded();
            let (at, area) = place_on(&view.polygon, [random(), random()]);
            let chance = (sent.element_sum() / all / WORTH_A_RAY).min(1.0);
            let looks = chance >= 1.0 || random() < chance;
            let is_hidden = looks && !view.sees(occluders, at);
            let hidden = if is_hidden { area * view.kernel(at) / chance } else { 0.0 };
            light += sent - view.exitance * hidden;
        }
        for emitter in &self.list {
            if let Emitter::Point(point) = emitter
                && let Some(direct) = punctual::shine(point, occluders, receiver)
            {
                light += direct.irradiance;
            }
        }
        light
    }
}

/// A place on a convex polygon, even by area, from two numbers even in 0..1; and the polygon's area, m².
pub(super) fn place_on(polygon: &[DVec3], [u, v]: [f64; 2]) -> (DVec3, f64) {
    let first = polygon[0];
    let fan = || polygon.windows(2).skip(1).map(|pair| [pair[0] - first, pair[1] - first]);
    let area = |[a, b]: [DVec3; 2]| a.cross(b).length() / 2.0;
    let total: f64 = fan().map(area).sum();
    let mut left = u * total;
    let mut at = first;
    for sides in fan() {
        let own = area(sides);
        // Even on the triangle: the square root makes strips of equal area.
        let across = (left / own).clamp(0.0, 1.0).sqrt();
        at = first + (sides[0] * (1.0 - v) + sides[1] * v) * across;
        if left <= own {
            break;
        }
        left -= own;
    }
    (at, total)
}
