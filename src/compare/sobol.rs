//! Random numbers that fill the space of paths evenly, the same whoever asks for them.

use fastrand::Rng;
use glam::DVec2;

/// Dimensions that are filled evenly: two directions and two places on lamps.
const EVEN: u32 = 8;

/// The numbers of one path: the first of a Sobol sequence with Owen's scrambling ([Burley 2020]), which fills all
/// dimensions evenly path by path, and pseudo-random ones beyond.
///
/// [Burley 2020]: https://jcgt.org/published/0009/04/01/
pub(super) struct SobolSequence {
    path: u32,
    seed: u32,
    dimension: u32,
    random: Rng,
}

impl SobolSequence {
    /// The numbers of path so and so of those with a seed.
    pub(super) fn new(seed: u64, path: u32) -> Self {
        let random = Rng::with_seed(mixed(&[seed, u64::from(path)]));
        Self { path, seed: (seed >> 32) as u32, dimension: 0, random }
    }

    /// A number even in 0..1.
    pub(super) fn number(&mut self) -> f64 {
        let dimension = self.dimension;
        self.dimension += 1;
        if dimension < EVEN {
            f64::from(sobol_burley::sample(self.path, dimension, self.seed))
        } else {
            self.random.f64()
        }
    }

    /// Two numbers.
    pub(super) fn pair(&mut self) -> DVec2 {
        DVec2::new(self.number(), self.number())
    }

    /// A number even in 0..1 that is no part of the sequence.
    pub(super) fn coin(&mut self) -> f64 {
        self.random.f64()
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
