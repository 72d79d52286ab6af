//! How a relaxation goes: what is left, and whether it ever ends.

use serde::{Deserialize, Serialize};

use super::residuals::{RelaxationStep, RelaxationSystem};
use crate::colour::Rgb;
use crate::solver::stop::Stop;

/// A residual grown by this factor will not come down again.
const GROWN: f64 = 1e6;

/// Sweeps without a new lowest residual after which none is expected. A white room, ρ = 0.99, has
/// one in every sweep.
const PATIENCE: usize = 100;

/// Keeps the books from step to step.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct StallDetector {
    rows: usize,
    /// Share unshot at the start.
    start: f64,
    /// Least share unshot so far, and after how many rows.
    least: (f64, usize),
    shots: usize,
    /// Largest change in the sweep under way.
    largest: f64,
    /// Largest change in the last full sweep.
    change: f64,
}

impl StallDetector {
    pub(super) fn new(rows: usize) -> Self {
        let least = (f64::INFINITY, 0);
        Self { rows, start: 0.0, least, shots: 0, largest: 0.0, change: f64::INFINITY }
    }

    /// The state after a row has changed by so much, W/m²; at the start, after none.
    pub(super) fn step(
        &mut self,
        system: &impl RelaxationSystem,
        relaxed: Option<(usize, Rgb)>,
    ) -> RelaxationStep {
        if let Some((_, change)) = relaxed {
            self.shots += 1;
            self.largest = self.largest.max(change.abs().max_element());
            if self.shots.is_multiple_of(self.rows) {
                self.change = std::mem::take(&mut self.largest);
            }
        }
        let (residual, unshot) = left(system);
        if relaxed.is_none() {
            self.start = unshot;
        }
        if unshot < self.least.0 {
            self.least = (unshot, self.shots);
        }
        let row = relaxed.map(|(row, _)| row);
        RelaxationStep { shots: self.shots, row, residual, change: self.change, unshot }
    }

    /// Whether there is no end in sight.
    pub(super) fn verdict(&self, step: &RelaxationStep) -> Option<Stop> {
        let sane = step.unshot.is_finite() && step.unshot <= GROWN * self.start;
        let falls = step.shots - self.least.1 <= PATIENCE * self.rows;
        (!sane || !falls).then_some(Stop::Diverged)
    }
}

/// The largest residual, W/m², and the share of the emitted power unshot.
fn left(system: &impl RelaxationSystem) -> (f64, f64) {
    let (mut largest, mut power) = (0.0_f64, Rgb::ZERO);
    for row in 0..system.rows() {
        let residual = system.residual(row).abs();
        largest = residual.max_element().max(largest);
        power += residual * system.area(row);
    }
    let emitted = system.emitted();
    (largest, if emitted > 0.0 { power.element_sum() / emitted } else { 0.0 })
}
