//! Direct light by a ray to each lamp: right on the mean, and cheap.

use std::borrow::Cow;

use glam::DVec3;

use super::{AreaLamp, Lamps};
use crate::colour::Rgb;
use crate::visibility::Occluders;

/// Lamps that send less than this share of the light are looked at as much more seldom.
const WORTH_A_RAY: f64 = 0.1;

impl Lamps {
    /// What arrives at a place with unit `normal`, W/m², on the mean over the values that `random` gives, even
    /// in 0..1; it may be below zero.
    ///
    /// What would arrive if nothing stood between is exact, and a ray to a place on the lamp tells of what is
    /// hidden. So there is no noise where nothing is.
    pub fn glimpse(
        &self,
        occluders: &Occluders,
        (place, normal): (DVec3, DVec3),
        mut random: impl FnMut() -> f64,
    ) -> Rgb {
        let mut light = Rgb::ZERO;
        let mut hidden = |lamp: &AreaLamp, above: &[DVec3], share: f64| {
            let (at, area) = place_on(above, [random(), random()]);
            let chance = (share / WORTH_A_RAY).min(1.0);
            let looks = chance >= 1.0 || random() < chance;
            if looks && occluders.blocks(place, at) {
                area * lamp.kernel(place, normal, at) / chance
            } else {
                0.0
            }
        };
        let reached: Vec<_> =
            self.areas.iter().map(|lamp| (lamp, lamp.reach(place, normal))).collect();
        let sent = |(lamp, above): &(&AreaLamp, Cow<'_, [DVec3]>)| {
            if above.is_empty() {
                Rgb::ZERO
            } else {
                lamp.exitance * lamp.glow.weight((place, normal), above)
            }
        };
        let sent: Vec<Rgb> = reached.iter().map(sent).collect();
        let all = sent.iter().sum::<Rgb>().element_sum();
        for ((lamp, above), sent) in reached.iter().zip(&sent) {
            if sent.element_sum() > 0.0 {
                light += *sent - lamp.exitance * hidden(lamp, above, sent.element_sum() / all);
            }
        }
        light + self.points_shine(occluders, place, normal).irradiance
    }
}

impl AreaLamp {
    /// Weight of a small piece of the lamp over its area, 1/m²: cos cos / (π d²) where it glows evenly.
    fn kernel(&self, place: DVec3, normal: DVec3, at: DVec3) -> f64 {
        let way = at - place;
        let square = way.length_squared();
        let cosines = way.dot(normal).max(0.0) * (-way.dot(self.front.normal)).max(0.0);
        if square > 0.0 {
            self.glow.radiance(way / square.sqrt()) * cosines
                / (std::f64::consts::PI * square * square)
        } else {
            0.0
        }
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
