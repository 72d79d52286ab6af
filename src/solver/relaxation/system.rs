//! The assembled system: form factors, reflectances and exitances of n patches.

use super::check::{check_exitance, check_reflectance, check_row};
use super::residuals::{RelaxationStep, RelaxationSystem};
use super::run::{Convergence, Relaxation};
use crate::colour::Rgb;
use crate::error::Result;
use crate::form_factor::FormFactors;
use crate::solver::stop::Stop;

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

impl Criteria {
    fn judge(&self, step: &RelaxationStep) -> Option<Stop> {
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

/// M B = E with M = I − diag(ρ) F, all channels together.
#[derive(Clone, Debug)]
pub struct System {
    pub(super) factors: FormFactors,
    pub(super) reflectance: Vec<Rgb>,
    pub(super) exitance: Vec<Rgb>,
    /// By patch: who sees it.
    seen_by: FormFactors,
}

/// What came of a relaxation.
#[derive(Clone, Debug)]
pub struct Relaxed {
    /// B of each patch, W/m².
    pub radiosity: Vec<Rgb>,
    /// Why it ended.
    pub stop: Stop,
    /// The state before the first row was relaxed, and after each.
    pub history: Vec<RelaxationStep>,
}

impl System {
    /// From the form factors between n patches, and n reflectances ρ and exitances E, W/m².
    ///
    /// # Errors
    /// When light could grow without end, since a patch reflects as much as leaves it, or more; or when
    /// a reflectance is negative, or a number is none.
    pub fn new(factors: FormFactors, reflectance: Vec<Rgb>, exitance: Vec<Rgb>) -> Result<Self> {
        let n = factors.len();
        assert_eq!([reflectance.len(), exitance.len()], [n, n], "one of each for every patch");
        for patch in 0..n {
            let sum = factors.row(patch).map(|(_, factor)| factor.abs()).sum();
            check_reflectance(reflectance[patch], format_args!("patch {patch}"))?;
            check_row(patch, reflectance[patch], sum)?;
            check_exitance(patch, exitance[patch])?;
        }
        Ok(Self { seen_by: factors.transposed(), factors, reflectance, exitance })
    }

    /// Number of patches.
    pub fn len(&self) -> usize {
        self.factors.len()
    }

    /// True if there are no patches.
    pub fn is_empty(&self) -> bool {
        self.factors.is_empty()
    }

    /// The form factors.
    pub fn factors(&self) -> &FormFactors {
        &self.factors
    }

    /// r = E − M B, W/m², of radiosities B, W/m².
    pub fn residual(&self, radiosity: &[Rgb]) -> Vec<Rgb> {
        let row = |i: usize| {
            let received: Rgb = self.factors.row(i).map(|(j, factor)| factor * radiosity[j]).sum();
            self.exitance[i] + self.reflectance[i] * received - radiosity[i]
        };
        (0..self.len()).map(row).collect()
    }

    /// Relaxes the system, from darkness.
    pub fn relax(&self, relaxation: Relaxation, criteria: &Criteria) -> Relaxed {
        let mut state = SystemState::dark(self);
        let mut convergence = Convergence::new(relaxation, &state);
        let stop = relaxation.run(&mut state, &mut convergence, |_, convergence| {
            criteria.judge(&convergence.step())
        });
        let history = convergence.history;
        Relaxed { radiosity: state.radiosity, stop, history }
    }

    /// `M[i][i]`: 1, but for patches that see themselves.
    fn diagonal(&self, i: usize) -> Rgb {
        Rgb::ONE - self.reflectance[i] * self.factors.get(i, i)
    }
}

/// A system being relaxed.
struct SystemState<'a> {
    system: &'a System,
    radiosity: Vec<Rgb>,
    residual: Vec<Rgb>,
    /// What rows release, if that is not what they hold.
    remembered: Option<Vec<Rgb>>,
}

impl<'a> SystemState<'a> {
    fn dark(system: &'a System) -> Self {
        let radiosity = vec![Rgb::ZERO; system.len()];
        Self { system, radiosity, residual: system.exitance.clone(), remembered: None }
    }
}

impl RelaxationSystem for SystemState<'_> {
    fn rows(&self) -> usize {
        self.system.len()
    }

    fn area(&self, row: usize) -> f64 {
        self.system.factors.areas()[row]
    }

    fn residual(&self, row: usize) -> Rgb {
        self.residual[row]
    }

    fn emitted(&self) -> f64 {
        let areas = self.system.factors.areas().iter();
        areas.zip(&self.system.exitance).map(|(&area, e)| area * e.abs().element_sum()).sum()
    }

    fn snapshot_sweep(&mut self) {
        self.remembered = Some(self.residual.clone());
    }

    fn relax(&mut self, row: usize, omega: f64) -> Rgb {
        let held = self.remembered.as_ref().unwrap_or(&self.residual)[row];
        let released = omega * held;
        let change = released / self.system.diagonal(row);
        self.radiosity[row] += change;
        self.residual[row] -= released;
        for (receiver, factor) in self.system.seen_by.row(row) {
            if receiver != row {
                self.residual[receiver] += self.system.reflectance[receiver] * factor * change;
            }
        }
        change
    }
}
