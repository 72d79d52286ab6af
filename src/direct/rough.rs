//! Direct light by few rays, for results that are wanted at once: coarse, with shadows, right on the mean.

use glam::DVec3;

use super::emitter::Emitter;
use super::emitters::Emitters;
use super::ids::EmitterId;
use super::punctual;
use super::unbiased::place_on;
use crate::colour::Rgb;
use crate::light::Direct;
use crate::visibility::{Occluders, SurfacePoint};

/// Rays from a place, at least: where there are fewer emitters, several go to each.
const RAYS: usize = 8;

/// The number of an emitter, what it sends to a place if nothing hides it, W/m², and where a ray to it ends.
type EmitterRay = (EmitterId, Rgb, DVec3);

impl Emitters {
    /// What arrives at a point of a surface, by rays to places on the emitters that `random` chooses, even in 0..1.
    ///
    /// What would arrive if nothing stood between is exact; of that counts what the rays reach. Of many emitters, those
    /// that send most are asked for all, each as often as it sends.
    pub fn rough(
        &self,
        occluders: &Occluders,
        receiver: SurfacePoint,
        mut random: impl FnMut() -> f64,
    ) -> Direct {
        let sent = self.sent(receiver, occluders, &mut random);
        let unoccluded: Rgb = sent.iter().map(|(_, light, _)| *light).sum();
        let all = unoccluded.element_sum();
        if all <= 0.0 {
            return Direct::default();
        }
        let mut irradiance = Rgb::ZERO;
        let (mut passed, start) = (0.0, random());
        for (number, light, end) in &sent {
            let strength = light.element_sum();
            // Those that hold one of equally many steps of all that is sent, from some start on.
            let steps = |sum: f64| (sum / all * RAYS as f64 + start).floor();
            let count = steps(passed + strength) - steps(passed);
            passed += strength;
            let is_own = |surface| self.list[number.index()].is_part(surface);
            if count > 0.0 && !occluders.blocks_beyond(receiver.position, *end, is_own) {
                irradiance += *light * (count * all / (strength * RAYS as f64));
            }
        }
        Direct { irradiance: irradiance.min(unoccluded), unoccluded }
    }

    /// What each emitter sends, or each of some parts of a few, and places on them.
    fn sent(
        &self,
        receiver: SurfacePoint,
        occluders: &Occluders,
        random: &mut impl FnMut() -> f64,
    ) -> Vec<EmitterRay> {
        let each = RAYS.div_ceil(self.list.len().max(1));
        let mut sent = Vec::new();
        for (number, emitter) in (0..).map(EmitterId).zip(&self.list) {
            if let Some(view) = emitter.view(receiver) {
                let light = view.unoccluded() / each as f64;
                let shift = [random(), random()];
                sent.extend((0..each).map(|k| {
                    let along = (k as f64 + shift[0]) / each as f64;
                    // Steps of the golden ratio are even, however many.
                    let across = (shift[1] + k as f64 * 0.618_033_988_749_895).fract();
                    (number, light, place_on(&view.polygon, [along, across]).0)
                }));
            } else if let Emitter::Point(point) = emitter
                && let Some((light, source)) = punctual::irradiance(point, receiver, self.blur)
            {
                sent.push((number, light, source.end(receiver.position, occluders)));
            }
        }
        sent
    }
}
