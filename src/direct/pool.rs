//! Many emitters of which none matters by itself: looked at together, by rays to some of them.

use glam::DVec3;

use super::ids::EmitterId;
use crate::colour::Rgb;

/// Most rays to all of them.
const MOST_RAYS: f64 = 256.0;

/// One of the emitters.
#[derive(Clone, Copy, Debug)]
struct Share {
    /// What arrives if nothing stands between, W/m².
    light: Rgb,
    /// Mean of the channels.
    strength: f64,
    /// A place on it.
    at: DVec3,
    emitter: EmitterId,
}

/// Emitters whose light is summed up, in an order in which neighbours are near each other.
#[derive(Debug, Default)]
pub(super) struct Pool {
    shares: Vec<Share>,
    strength: f64,
}

impl Pool {
    pub(super) fn push(&mut self, emitter: EmitterId, light: Rgb, at: DVec3) {
        let strength = light.element_sum() / 3.0;
        self.strength += strength;
        self.shares.push(Share { light, strength, at, emitter });
    }

    /// What arrives of all of them, W/m², and the rays that it took: right to within about `error`, W/m².
    ///
    /// Each ray stands for an equal part of the light, so that none is left out: systematic sampling of the sum, with a
    /// standard deviation of at most half of it over √n. Where there are fewer emitters than rays, each has its own.
    pub(super) fn shine(&self, error: f64, sees: impl Fn(EmitterId, DVec3) -> bool) -> (Rgb, u64) {
        if self.strength <= 0.0 {
            return (Rgb::ZERO, 0);
        }
        let rays = (self.strength / (2.0 * error.max(f64::MIN_POSITIVE))).powi(2).ceil();
        if rays >= self.shares.len() as f64 {
            let seen = self.shares.iter().filter(|share| sees(share.emitter, share.at));
            return (seen.map(|share| share.light).sum(), self.shares.len() as u64);
        }
        let part = self.strength / rays.clamp(1.0, MOST_RAYS);
        let (mut light, mut looked, mut next, mut sum) = (Rgb::ZERO, 0, 0.5 * part, 0.0);
        for share in &self.shares {
            sum += share.strength;
            let parts = ((sum - next) / part).ceil().max(0.0);
            if parts > 0.0 {
                next += parts * part;
                looked += 1;
                if sees(share.emitter, share.at) {
                    light += share.light * (parts * part / share.strength);
                }
            }
        }
        (light, looked)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_all_seen_arrives_whole(strengths in prop::collection::vec(1e-6..1.0f64, 1..400), error in 1e-9..1.0f64) {
            let mut pool = Pool::default();
            for (emitter, &strength) in strengths.iter().enumerate() {
                pool.push(EmitterId(emitter as u32), Rgb::splat(strength), DVec3::ZERO);
            }
            let (light, rays) = pool.shine(error, |_, _| true);
            let all: f64 = strengths.iter().sum();
            prop_assert!((light.x - all).abs() <= 1e-9 * all, "{} of {all}", light.x);
            prop_assert!(rays as usize <= strengths.len());
        }

        #[test]
        fn half_of_equal_lamps_send_half(count in 2..300u32, error in 0.001..0.1f64) {
            let mut pool = Pool::default();
            let share = Rgb::splat(1.0 / f64::from(count));
            (0..count).map(EmitterId).for_each(|emitter| pool.push(emitter, share, DVec3::ZERO));
            let (light, rays) = pool.shine(error, |emitter, _| emitter.0 < count / 2);
            let right = f64::from(count / 2) / f64::from(count);
            let most = 1.0 / rays as f64;
            prop_assert!((light.x - right).abs() <= most, "{} for {right} by {rays} rays", light.x);
        }
    }
}
