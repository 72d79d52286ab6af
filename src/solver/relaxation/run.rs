//! The loop that all methods share.

use serde::{Deserialize, Serialize};

use super::order::Order;
use super::residuals::{RelaxationStep, RelaxationSystem};
use super::stall_detector::StallDetector;
use crate::error::Result;
use crate::settings::{Method, check_omega};
use crate::solver::stop::Stop;

/// Which rows are relaxed, and by how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxation {
    method: Method,
    omega: f64,
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
    pub(in crate::solver) fn run<S: RelaxationSystem>(
        self,
        system: &mut S,
        convergence: &mut Convergence,
        mut judge: impl FnMut(&mut S, &Convergence) -> Option<Stop>,
    ) -> Stop {
        loop {
            let hopeless =
                |convergence: &Convergence| convergence.stall.verdict(&convergence.step());
            if let Some(stop) = judge(system, convergence).or_else(|| hopeless(convergence)) {
                return stop;
            }
            let row = match convergence.order.next(system) {
                Ok(row) => row,
                Err(stop) => return stop,
            };
            let change = system.relax(row, self.omega);
            convergence.history.push(convergence.stall.step(system, Some((row, change))));
        }
    }
}

/// How far a relaxation has come.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::solver) struct Convergence {
    order: Order,
    stall: StallDetector,
    /// The state at the start, and after each row.
    pub(in crate::solver) history: Vec<RelaxationStep>,
}

impl Convergence {
    /// At the start.
    pub(in crate::solver) fn new(relaxation: Relaxation, system: &impl RelaxationSystem) -> Self {
        let mut stall = StallDetector::new(system.rows());
        let start = stall.step(system, None);
        Self { order: Order::new(relaxation.method), stall, history: vec![start] }
    }

    /// The state after the row relaxed last.
    pub(in crate::solver) fn step(&self) -> RelaxationStep {
        self.history[self.history.len() - 1]
    }
}
