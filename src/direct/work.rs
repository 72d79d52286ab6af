//! What evaluating direct light took, in counts that are the same on every machine.

use std::iter::Sum;
use std::ops::{Add, AddAssign};

use serde::{Deserialize, Serialize};

use crate::light::Direct;

/// Counts of evaluations of direct light and of shadow rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorkCounters {
    /// Pairs of a place and an emitter, or convex piece of one, that shines there unless something hides it.
    pub evaluations: u64,
    /// Rays: to lights that are points, and to others where exact cutting has given up.
    pub rays: u64,
}

/// Light that arrives at a place, and what it took to find it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Evaluated {
    /// The light.
    pub light: Direct,
    /// What it took.
    pub work: WorkCounters,
}

impl Add for WorkCounters {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { evaluations: self.evaluations + other.evaluations, rays: self.rays + other.rays }
    }
}

impl AddAssign for WorkCounters {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sum for WorkCounters {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), Self::add)
    }
}
