//! A system in residual form, and how far its relaxation has come.

use serde::{Deserialize, Serialize};

use crate::colour::Rgb;
use crate::solver::stop::Stop;

/// The state of a relaxation between two rows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RelaxationStep {
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
pub(in crate::solver) trait RelaxationSystem {
    /// Number of rows.
    fn rows(&self) -> usize;

    /// Area of a row's patch, m².
    fn area(&self, row: usize) -> f64;

    /// What is missing of the row's radiosity, W/m².
    fn residual(&self, row: usize) -> Rgb;

    /// Emitted power, the sum of the channels, W.
    fn emitted(&self) -> f64;

    /// Lets rows release what they hold now, and not what they hold when their turn comes.
    fn snapshot_sweep(&mut self);

    /// True if the row can be relaxed without [`Self::prepare`].
    fn is_ready(&self, _row: usize) -> bool {
        true
    }

    /// Makes rows ready, the first of them at least; or tells why it has stopped with none of them ready.
    fn prepare(&mut self, _rows: &[usize]) -> Result<(), Stop> {
        Ok(())
    }

    /// Relaxes a row: releases `omega` times what it holds and delivers it. Returns the change of
    /// its radiosity, W/m².
    fn relax(&mut self, row: usize, omega: f64) -> Rgb;
}
