//! Which row is next.

use serde::{Deserialize, Serialize};

use super::residuals::RelaxationSystem;
use crate::settings::Method;
use crate::solver::stop::Stop;

/// Rows made ready at once, ahead of their turn. A number of its own, so that threads change nothing.
const BATCH: usize = 48;

/// The order of a method.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Order {
    method: Method,
    /// Rows taken so far.
    taken: usize,
}

impl Order {
    pub(super) fn new(method: Method) -> Self {
        Self { method, taken: 0 }
    }

    /// The next row, made ready together with those likely to follow; or else why there is none.
    pub(super) fn next(&mut self, system: &mut impl RelaxationSystem) -> Result<usize, Stop> {
        if self.method == Method::Jacobi && self.taken.is_multiple_of(system.rows().max(1)) {
            system.snapshot_sweep();
        }
        let row = *self.ahead(system, 1).first().ok_or(Stop::Converged)?;
        if !system.is_ready(row) {
            let ahead = self.ahead(system, BATCH);
            system.prepare(&ahead)?;
        }
        self.taken += 1;
        Ok(row)
    }

    /// The next rows, as things stand.
    fn ahead(&self, system: &impl RelaxationSystem, count: usize) -> Vec<usize> {
        let rows = system.rows();
        let count = count.min(rows);
        let strength = |row: usize| system.residual(row).abs().element_sum();
        match self.method {
            Method::Jacobi | Method::GaussSeidel => {
                (self.taken..self.taken + count).map(|turn| turn % rows).collect()
            }
            Method::Southwell => largest(rows, count, strength),
            Method::Progressive => largest(rows, count, |row| strength(row) * system.area(row)),
        }
    }
}

/// The rows with the largest values, the largest first; equals in their order.
fn largest(rows: usize, count: usize, value: impl Fn(usize) -> f64) -> Vec<usize> {
    let by_value = |&a: &usize, &b: &usize| value(b).total_cmp(&value(a)).then(a.cmp(&b));
    if count == 1 {
        // Each value is asked for once: this goes over all rows for each of them.
        let first =
            |best: (usize, f64), next: (usize, f64)| if next.1 > best.1 { next } else { best };
        let best = (0..rows).map(|row| (row, value(row))).reduce(first);
        return best.map(|(row, _)| row).into_iter().collect();
    }
    let mut order: Vec<usize> = (0..rows).collect();
    if count < rows {
        order.select_nth_unstable_by(count, by_value);
        order.truncate(count);
    }
    order.sort_unstable_by(by_value);
    order
}
