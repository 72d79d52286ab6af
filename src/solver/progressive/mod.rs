//! Exchange of reflected light by shooting: patch by patch, until little is left.
//!
//! Based on: [Cohen, Chen, Wallace and Greenberg 1988]. It is a relaxation of B = E + ρ F B, by default
//! Southwell's scaled by area: the patch with the most unshot power is next.
//! Emitters come first; their light has been carried exactly before, so their shots only book it.
//!
//! [Cohen, Chen, Wallace and Greenberg 1988]: https://doi.org/10.1145/54852.378487

mod conserve;
mod shooting;

mod ambient;
mod rows;

mod state;

use super::relaxation::{Convergence, Relaxation, RelaxationStep, RelaxationSystem};
use super::solution::Phase;
use super::stop::Stop;
use crate::colour::Rgb;
use crate::error::{Error, Result};
use crate::settings::Settings;

use conserve::Carried;
pub(super) use shooting::Shooting;
use shooting::Unshot;
use state::last_state;

impl Shooting<'_, '_> {
    /// Lets patches shoot until the unshot power is small, the shots are used up, or the observer has
    /// seen enough.
    pub(super) fn run(&mut self, settings: &Settings) -> Result<(Stop, Vec<RelaxationStep>)> {
        let relaxation = Relaxation::new(settings.solver, settings.omega)?;
        let (emitters, start) = (self.shots, self.energy.unshot_share().max(f64::MIN_POSITIVE));
        let mut course = Convergence::new(relaxation, self);
        let mut known = None;
        if let Some(state) = last_state(self.observer) {
            (course, known) = self.take_up(state);
        }
        // What is made of the rest once there has been enough is not kept, but what there was by then is.
        let is_going_on = known.is_none() && self.observer.flow.is_continue();
        let stop = known.unwrap_or_else(|| {
            relaxation.run(self, &mut course, |shooting, course| {
                let step = course.step();
                if step.unshot <= settings.stop {
                    return Some(Stop::Converged);
                }
                if settings.max_shots.is_some_and(|most| emitters + step.shots >= most) {
                    return Some(Stop::ShotLimit);
                }
                let done = (step.unshot / start).ln() / (settings.stop / start).ln();
                let is_over = shooting.observer.tell(Phase::Shooting, done).is_break();
                if !is_over && shooting.observer.checkpoint.is_due() {
                    shooting.keep(course, None);
                }
                is_over.then_some(Stop::Cancelled)
            })
        });
        if is_going_on && stop == Stop::Cancelled {
            self.keep(&course, None);
        }
        self.energy.unshot = self.unshot_power();
        self.spread_over_groups();
        if stop == Stop::Diverged {
            return Err(diverged(settings));
        }
        if is_going_on && stop != Stop::Cancelled {
            self.keep(&course, Some(stop));
        }
        Ok((stop, course.history))
    }

    /// Gives all patches of a group what they have received together.
    fn spread_over_groups(&mut self) {
        for group in 0..self.groups.len() {
            let [first, others @ ..] = self.groups.members(group) else { continue };
            let light = self.received[self.mesh[*first].root.index()];
            for &other in others {
                self.received[self.mesh[other].root.index()] = light;
            }
        }
    }
}

impl RelaxationSystem for Shooting<'_, '_> {
    fn rows(&self) -> usize {
        self.unshot.len()
    }

    fn area(&self, row: usize) -> f64 {
        self.areas[row]
    }

    fn residual(&self, row: usize) -> Rgb {
        self.unshot[row]
    }

    fn emitted(&self) -> f64 {
        self.energy.emitted.element_sum()
    }

    fn remember(&mut self) {
        let (unshot, pending) = (self.unshot.clone(), self.pending.clone());
        self.remembered = Some(Unshot { unshot, pending });
    }

    fn is_ready(&self, row: usize) -> bool {
        self.rows[row].is_some()
    }

    fn prepare(&mut self, rows: &[usize]) {
        self.make_rows(rows);
    }

    fn relax(&mut self, shooter: usize, omega: f64) -> Rgb {
        let released = self.release(shooter, omega);
        match self.groups.members(shooter) {
            &[patch] => self.release_elements(patch, omega),
            // Groups of facets are taken as one.
            facets => {
                let roots = facets.iter().map(|&facet| self.mesh[facet].root.index());
                roots.for_each(|root| self.released[root] = released);
            }
        }
        let power = released * self.areas[shooter];
        let row = self.rows[shooter].take().unwrap_or_default();
        let Carried { scale, even, outside } = Carried::all(power, &row, &self.released);
        for link in &row.links {
            let power = (scale * self.released[link.source.index()] + even) * link.exchange;
            let group = self.groups.of(self.mesh[link.receiver].patch);
            let shared = self.groups.members(group).len() > 1;
            let area = if shared { self.areas[group] } else { self.mesh[link.receiver].area };
            // A group's light is kept with the first of its patches, and spread at last.
            self.received[link.receiver.index()] += power / area;
            self.pending[link.receiver.index()] += power / area;
            self.unshot[group] += self.reflectances[group] * power / self.areas[group];
            self.energy.absorbed += (Rgb::ONE - self.reflectances[group]) * power;
        }
        self.energy.escaped += power * row.escaped * outside;
        self.energy.on_backs += power * row.on_backs * outside;
        self.rows[shooter] = Some(row);
        self.shots += 1;
        released
    }
}

/// Advice for a relaxation that will not end.
fn diverged(settings: &Settings) -> Error {
    let (solver, omega) = (settings.solver.name(), settings.omega);
    let message = format!("{solver} with {omega} lets the light grow without end; use 1 or less");
    Error::Setting { name: "omega", message }
}
