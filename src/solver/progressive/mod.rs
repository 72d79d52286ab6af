//! Exchange of reflected light by shooting: patch by patch, until little is left.
//!
//! Based on: [Cohen, Chen, Wallace and Greenberg 1988]. It is a relaxation of B = E + ρ F B, by default
//! Southwell's scaled by area: the patch with the most unshot power is next.
//! Emitters come first; their light has been carried exactly before, so their shots only book it.
//!
//! [Cohen, Chen, Wallace and Greenberg 1988]: https://doi.org/10.1145/54852.378487

mod conserve;
mod row_cache;
mod state;

mod shooting;

mod ambient;
mod rows;

use super::relaxation::{Convergence, Relaxation, RelaxationStep, RelaxationSystem};
use super::solution::Phase;
use super::stop::Stop;
use crate::colour::Rgb;
use crate::error::{Error, Result};
use crate::settings::Settings;

use conserve::Carried;
pub(super) use shooting::Shooting;
pub(super) use state::State;
use state::{ShootingRecord, last_kept};

impl Shooting<'_, '_> {
    /// Lets patches shoot until the unshot power is small, the shots are used up, or the observer has
    /// seen enough.
    pub(super) fn run(&mut self, settings: &Settings) -> Result<(Stop, Vec<RelaxationStep>)> {
        let relaxation = Relaxation::new(settings.method, settings.omega)?;
        let State { shots: emitters, energy, .. } = self.state;
        let start = energy.unshot_share().max(f64::MIN_POSITIVE);
        let mut convergence = Convergence::new(relaxation, self);
        let mut known = None;
        if let Some(kept) = last_kept(self.observer) {
            (convergence, known) = self.take_up(kept);
        }
        // What is made of the rest once there has been enough is not kept, but what there was by then is.
        let is_going_on = known.is_none() && !self.observer.is_over();
        let stop = known.unwrap_or_else(|| {
            relaxation.run(self, &mut convergence, |shooting, convergence| {
                let step = convergence.step();
                if step.unshot <= settings.unshot_limit {
                    return Some(Stop::Converged);
                }
                if settings.max_shots.is_some_and(|most| emitters + step.shots >= most) {
                    return Some(Stop::ShotLimit);
                }
                let done = (step.unshot / start).ln() / (settings.unshot_limit / start).ln();
                let _ = shooting.observer.tell(Phase::Shooting, done);
                if !shooting.observer.is_over() && shooting.observer.checkpoint.is_due() {
                    shooting.keep(convergence, None);
                }
                shooting.observer.is_over().then(|| shooting.observer.stop())
            })
        });
        if is_going_on && stop.is_cancelled() {
            self.keep(&convergence, None);
        }
        self.state.energy.unshot = self.unshot_power();
        self.spread_over_clusters();
        if stop == Stop::Diverged {
            return Err(diverged(settings));
        }
        if is_going_on && !stop.is_cancelled() {
            self.keep(&convergence, Some(stop));
        }
        Ok((stop, convergence.history))
    }

    /// Keeps the state in the checkpoint, once it has converged like this.
    fn keep(&mut self, convergence: &Convergence, stop: Option<Stop>) {
        let kept = (convergence, stop, &self.state, self.rows.ready());
        self.observer.checkpoint.keep(&kept);
    }

    /// Goes on from what was kept, with the rows that were there made anew if any will be needed.
    fn take_up(
        &mut self,
        (convergence, stop, state, ready): ShootingRecord,
    ) -> (Convergence, Option<Stop>) {
        if stop.is_none() {
            self.make_rows(&ready);
        }
        self.state = state;
        (convergence, stop)
    }

    /// Gives all patches of a cluster what they have received together.
    fn spread_over_clusters(&mut self) {
        for cluster in 0..self.context.clusters.len() {
            let [first, others @ ..] = self.context.clusters.members(cluster) else { continue };
            let light = self.state.received[self.mesh[*first].root.index()];
            for &other in others {
                self.state.received[self.mesh[other].root.index()] = light;
            }
        }
    }
}

impl RelaxationSystem for Shooting<'_, '_> {
    fn rows(&self) -> usize {
        self.areas.len()
    }

    fn area(&self, row: usize) -> f64 {
        self.areas[row]
    }

    fn residual(&self, row: usize) -> Rgb {
        self.state.unshot.radiosity[row]
    }

    fn emitted(&self) -> f64 {
        self.state.energy.emitted.element_sum()
    }

    fn snapshot_sweep(&mut self) {
        self.state.snapshot = Some(self.state.unshot.clone());
    }

    fn is_ready(&self, row: usize) -> bool {
        self.rows.has(row)
    }

    fn prepare(&mut self, rows: &[usize]) -> std::result::Result<(), Stop> {
        self.make_rows(rows);
        if self.rows.has(rows[0]) { Ok(()) } else { Err(self.observer.stop()) }
    }

    fn relax(&mut self, shooter: usize, omega: f64) -> Rgb {
        let released = self.release(shooter, omega);
        match self.context.clusters.members(shooter) {
            &[patch] => self.release_elements(patch, omega),
            // Clusters of facets are taken as one.
            facets => {
                let roots = facets.iter().map(|&facet| self.mesh[facet].root.index());
                roots.for_each(|root| self.released[root] = released);
            }
        }
        let power = released * self.areas[shooter];
        let row = self.rows.take(shooter);
        let Carried { scale, even, outside } = Carried::all(power, &row, &self.released);
        for link in &row.links {
            let power = (scale * self.released[link.source.index()] + even) * link.exchange_area;
            let cluster = self.context.clusters.of(self.mesh[link.receiver].patch);
            let shared = self.context.clusters.members(cluster).len() > 1;
            let area = if shared { self.areas[cluster] } else { self.mesh[link.receiver].area };
            // A cluster's light is kept with the first of its patches, and spread at last.
            self.state.received[link.receiver.index()] += power / area;
            self.state.unshot.irradiance[link.receiver.index()] += power / area;
            self.state.unshot.radiosity[cluster] +=
                self.reflectances[cluster] * power / self.areas[cluster];
            self.state.energy.absorbed += (Rgb::ONE - self.reflectances[cluster]) * power;
        }
        self.state.energy.escaped += power * row.escaped * outside;
        self.state.energy.on_backs += power * row.on_backs * outside;
        self.rows.put_back(shooter, row);
        self.state.shots += 1;
        released
    }
}

/// Advice for a relaxation that will not end.
fn diverged(settings: &Settings) -> Error {
    let (method, omega) = (settings.method.name(), settings.omega);
    let message = format!("{method} with {omega} lets the light grow without end; use 1 or less");
    Error::Setting { name: "omega", message }
}
