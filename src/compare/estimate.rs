//! Radiosity at places, in rounds, with the standard error that the rounds' spread shows.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use fastrand::Rng;
use rayon::prelude::*;

use super::sampler::{Sampler, Site};
use crate::colour::Rgb;

/// How much to spend on truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Places all over the surfaces, about.
    pub area_points: usize,
    /// Places where shadow falls steeply, at most.
    pub shadow_points: usize,
    /// Paths from each place a round.
    pub paths: u32,
    /// Fewest rounds; their spread tells the error.
    pub rounds: usize,
    /// Good enough: root mean square of the standard errors, as a share of the mean radiosity.
    pub noise: f64,
    /// After this no round begins, once there are two.
    pub budget: Duration,
    /// Which random numbers.
    pub seed: u64,
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            area_points: 2000,
            shadow_points: 1000,
            paths: 64,
            rounds: 16,
            noise: 0.002,
            budget: Duration::from_secs(60),
            seed: 1,
        }
    }
}

/// Sums over the rounds at one place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    direct: Rgb,
    reflectance: Rgb,
    sum: Rgb,
    squares: Rgb,
    pub(super) escaped: f64,
}

/// Places whose light becomes known better round by round.
#[derive(Debug)]
pub(super) struct Estimate {
    pub(super) sums: Vec<Sums>,
    pub(super) rounds: usize,
}

impl Estimate {
    pub(super) fn new(sampler: &Sampler<'_>, sites: &[Site]) -> Self {
        let start = |site: &Site| Sums {
            direct: sampler.direct(site).irradiance,
            reflectance: sampler.reflectance(site),
            ..Sums::default()
        };
        Self { sums: sites.par_iter().map(start).collect(), rounds: 0 }
    }

    /// Adds rounds until `effort` is spent, the noise is small or `observe`, told of the share done, breaks
    /// off; and at least two in any case.
    pub(super) fn run(
        &mut self,
        (sampler, sites): (&Sampler<'_>, &[Site]),
        effort: &Effort,
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) {
        let start = Instant::now();
        loop {
            let spent = start.elapsed();
            let noise = self.noise();
            let done =
                (self.rounds >= effort.rounds && noise <= effort.noise) || spent >= effort.budget;
            // Errors fall as one over the square root of the rounds.
            let by_noise = if noise > 0.0 { (effort.noise / noise).powi(2) } else { 1.0 };
            let by_rounds = self.rounds as f64 / effort.rounds.max(1) as f64;
            let by_time = spent.as_secs_f64() / effort.budget.as_secs_f64().max(1e-9);
            let share = by_rounds.min(by_noise).max(by_time).min(1.0);
            if observe(share).is_break() || (done && self.rounds >= 2) {
                if self.rounds >= 2 {
                    return;
                }
            }
            self.round((sampler, sites), effort);
        }
    }

    /// One round more.
    pub(super) fn round(&mut self, (sampler, sites): (&Sampler<'_>, &[Site]), effort: &Effort) {
        let round = self.rounds as u64;
        self.sums.par_iter_mut().zip(sites).enumerate().for_each(|(number, (sums, site))| {
            let mut random = Rng::with_seed(mixed(&[effort.seed, round, number as u64]));
            let found = sampler.indirect(site, effort.paths, &mut random);
            sums.sum += found.indirect;
            sums.squares += found.indirect * found.indirect;
            sums.escaped += found.escaped;
        });
        self.rounds += 1;
    }

    /// Radiosity by reflection at a place, and its standard error, W/m².
    pub(super) fn radiosity(&self, number: usize) -> [Rgb; 2] {
        let (sums, rounds) = (&self.sums[number], self.rounds as f64);
        let mean = sums.sum / rounds;
        let variance =
            (sums.squares / rounds - mean * mean).max(Rgb::ZERO) / (rounds - 1.0).max(1.0);
        let error = variance.to_array().map(f64::sqrt);
        [sums.reflectance * (sums.direct + mean), sums.reflectance * Rgb::from(error)]
    }

    /// Root mean square of the standard errors over the mean radiosity; infinite before there are two rounds.
    fn noise(&self) -> f64 {
        if self.rounds < 2 || self.sums.is_empty() {
            return f64::INFINITY;
        }
        let count = self.sums.len() as f64;
        let (light, square) = (0..self.sums.len()).map(|k| self.radiosity(k)).fold(
            (0.0, 0.0),
            |(light, square), [radiosity, error]| {
                (light + radiosity.element_sum() / 3.0, square + error.length_squared() / 3.0)
            },
        );
        if light > 0.0 { (square / count).sqrt() / (light / count) } else { 0.0 }
    }
}

/// A seed from numbers, by the finalizer of `SplitMix64` ([Steele, Lea and Flood 2014]).
///
/// [Steele, Lea and Flood 2014]: https://doi.org/10.1145/2660193.2660195
pub(super) fn mixed(numbers: &[u64]) -> u64 {
    numbers.iter().fold(0, |seed, &number| {
        let z = (seed ^ number).wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    })
}
