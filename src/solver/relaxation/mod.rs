//! The classic relaxations of M B = E, M = I − diag(ρ) F, row by row in residual form.
//!
//! B is the radiosity so far and r = E − M B what is still missing. Relaxing row i adds
//! ω `r_i` / `M_ii` to `B_i`, takes it from `r_i`, and gives every other row what it reflects of it.
//! Seen as light: a patch shoots what it has received and not yet sent on. The methods differ only
//! in which row is next ([`Method`]), after [Cohen, Chen, Wallace and Greenberg 1988] and
//! [Gortler, Cohen and Slusallek 1994].
//!
//! The same loop works on an assembled matrix, [`System`], and on the hierarchical exchange of
//! [`solve`](super::solve), whose rows are made when they are needed.
//!
//! [Cohen, Chen, Wallace and Greenberg 1988]: https://doi.org/10.1145/54852.378487
//! [Gortler, Cohen and Slusallek 1994]: https://doi.org/10.1109/38.329094

mod check;
mod direct;
mod order;
mod system;
mod trend;

use serde::{Deserialize, Serialize};

use super::solution::Stop;
use crate::colour::Rgb;
use crate::error::Result;
use crate::settings::{Method, check_omega};

pub(super) use check::check_reflectance;
use order::Order;
pub use system::{Relaxed, System};
use trend::Trend;

/// Rows made ready at once, ahead of their turn. A number of its own, so that threads change nothing.
const BATCH: usize = 48;

/// Which rows are relaxed, and by how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxation {
    method: Method,
    omega: f64,
}

/// When a relaxation of a [`System`] ends; zero for a difference that is not to end it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    /// Largest residual of any row and channel, W/m².
    pub residual: f64,
    /// Largest change of any radiosity in a sweep of as many rows as there are, W/m².
    pub change: f64,
    /// Most rows to relax.
    pub max_shots: usize,
}

/// The state of a relaxation between two rows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Rows relaxed so far.
    pub shots: usize,
    /// The row relaxed last; none before the first.
    pub row: Option<usize>,
    /// Largest residual of any row and channel, W/m².
    pub residual: f64,
    /// Largest change of any radiosity in the last full sweep of as many rows as there are, W/m²;
    /// infinite before there was one.
    pub change: f64,
    /// Magnitude of all residuals times their areas, as a share of the emitted power.
    pub unshot: f64,
}

/// A system in residual form, relaxed row by row.
pub(super) trait Residuals {
    /// Number of rows.
    fn rows(&self) -> usize;

    /// Area of a row's patch, m².
    fn area(&self, row: usize) -> f64;

    /// What is missing of the row's radiosity, W/m².
    fn residual(&self, row: usize) -> Rgb;

    /// Emitted power, the sum of the channels, W.
    fn emitted(&self) -> f64;

    /// Lets rows release what they hold now, and not what they hold when their turn comes.
    fn remember(&mut self);

    /// True if the row can be relaxed without [`Self::prepare`].
    fn is_ready(&self, _row: usize) -> bool {
        true
    }

    /// Makes rows ready, the first of them at least; none of them if it is told to stop.
    fn prepare(&mut self, _rows: &[usize]) {}

    /// Relaxes a row: releases `omega` times what it holds and delivers it. Returns the change of
    /// its radiosity, W/m².
    fn relax(&mut self, row: usize, omega: f64) -> Rgb;
}

impl Relaxation {
    /// A method, and the factor on every release: below 1 is under-, above 1 over-relaxation.
    ///
    /// Of a system with reciprocal form factors all methods converge with any ω between 0 and 2,
    /// except Jacobi's, which is only sure to with ω < 2 / (1 + largest reflectance).
    ///
    /// # Errors
    /// When `omega` is not between 0 and 2.
    pub fn new(method: Method, omega: f64) -> Result<Self> {
        check_omega(omega)?;
        Ok(Self { method, omega })
    }

    /// Relaxes row after row until `judge` says why to stop, or no end is in sight.
    pub(super) fn run<S: Residuals>(
        self,
        system: &mut S,
        course: &mut Course,
        mut judge: impl FnMut(&mut S, &Course) -> Option<Stop>,
    ) -> Stop {
        loop {
            let hopeless = |course: &Course| course.trend.verdict(&course.step());
            if let Some(stop) = judge(system, course).or_else(|| hopeless(course)) {
                return stop;
            }
            let row = match course.order.next(system) {
                Ok(row) => row,
                Err(stop) => return stop,
            };
            let change = system.relax(row, self.omega);
            course.history.push(course.trend.step(system, Some((row, change))));
        }
    }
}

/// How far a relaxation has come.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Course {
    order: Order,
    trend: Trend,
    /// The state at the start, and after each row.
    pub(super) history: Vec<Step>,
}

impl Course {
    /// At the start.
    pub(super) fn new(relaxation: Relaxation, system: &impl Residuals) -> Self {
        let mut trend = Trend::new(system.rows());
        let start = trend.step(system, None);
        Self { order: Order::new(relaxation.method), trend, history: vec![start] }
    }

    /// The state after the row relaxed last.
    pub(super) fn step(&self) -> Step {
        self.history[self.history.len() - 1]
    }
}

impl Criteria {
    fn judge(&self, step: &Step) -> Option<Stop> {
        if step.residual <= self.residual {
            Some(Stop::Converged)
        } else if step.change < self.change {
            Some(Stop::Unchanged)
        } else if step.shots >= self.max_shots {
            Some(Stop::ShotLimit)
        } else {
            None
        }
    }
}
