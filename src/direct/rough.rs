//! Direct light by few rays, for results that are wanted at once: coarse, with shadows, right on the mean.

use glam::DVec3;

use super::Lamps;
use super::glimpse::place_on;
use super::punctual::{self, Source};
use crate::colour::Rgb;
use crate::mesh::Direct;
use crate::visibility::Occluders;

/// Rays from a place, at least: where there are fewer lamps, several go to each.
const RAYS: usize = 8;

/// What a lamp sends to a place if nothing hides it, W/m², and where a ray to it ends.
type Sent = (Rgb, DVec3);

impl Lamps {
    /// What arrives at a place with unit `normal`, by rays to places on the lamps that `random` chooses, even in 0..1.
    ///
    /// What would arrive if nothing stood between is exact; of that counts what the rays reach. Of many lamps, those
    /// that send most are asked for all, each as often as it sends.
    pub fn rough(
        &self,
        occluders: &Occluders,
        (place, normal): (DVec3, DVec3),
        mut random: impl FnMut() -> f64,
    ) -> Direct {
        let sent = self.sent((place, normal), occluders.extent(), &mut random);
        let unoccluded: Rgb = sent.iter().map(|(light, _)| *light).sum();
        let all = unoccluded.element_sum();
        if all <= 0.0 {
            return Direct::default();
        }
        let mut irradiance = Rgb::ZERO;
        let (mut passed, start) = (0.0, random());
        for (light, end) in &sent {
            let strength = light.element_sum();
            // Those that hold one of equally many steps of all that is sent, from some start on.
            let steps = |sum: f64| (sum / all * RAYS as f64 + start).floor();
            let count = steps(passed + strength) - steps(passed);
            passed += strength;
            if count > 0.0 && !occluders.blocks(place, *end) {
                irradiance += *light * (count * all / (strength * RAYS as f64));
            }
        }
        Direct { irradiance: irradiance.min(unoccluded), unoccluded }
    }

    /// What each lamp sends, or each of some parts of a few, and places on them.
    fn sent(
        &self,
        receiver: (DVec3, DVec3),
        far: f64,
        random: &mut impl FnMut() -> f64,
    ) -> Vec<Sent> {
        let (place, normal) = receiver;
        let each = RAYS.div_ceil(self.areas.len().max(1));
        let mut sent = Vec::new();
        for lamp in &self.areas {
            let above = lamp.reach(place, normal);
            if above.is_empty() {
                continue;
            }
            let light = lamp.exitance * (lamp.glow.weight(receiver, &above) / each as f64);
            let shift = [random(), random()];
            sent.extend((0..each).map(|k| {
                let along = (k as f64 + shift[0]) / each as f64;
                // Steps of the golden ratio are even, however many.
                let across = (shift[1] + k as f64 * 0.618_033_988_749_895).fract();
                (light, place_on(&above, [along, across]).0)
            }));
        }
        for point in &self.points {
            if let Some((light, source)) = punctual::irradiance(point, place, normal) {
                sent.push(match source {
                    Source::Position(position) => (light, position),
                    Source::Direction(direction) => (light, place + direction * far),
                });
            }
        }
        sent
    }
}
