//! Rows of the exchange, made when they are needed.

use super::shooting::Shooting;
use crate::colour::{Rgb, strength};
use crate::direct::Sent;
use crate::form_factor::hemicube::Hemicube;
use crate::light::VertexLight;
use crate::mesh::PatchId;
use crate::solver::arrival::{ERROR, arrival};
use crate::solver::context::Context;
use crate::solver::links::Row;
use crate::solver::transport::Transport;

impl Shooting<'_, '_> {
    /// What lights at points send out and past all fronts, and what fronts absorb of all direct light.
    ///
    /// Of light from infinitely far, all that arrives is emitted.
    pub(super) fn book_direct_light(&mut self, context: Context<'_>, vertices: &VertexLight) {
        let (mesh, surfaces) = (self.mesh, self.surfaces);
        let is_back = |surface: u32| !surfaces.list[surface as usize].two_sided;
        let Sent { emitted, escaped, on_backs } =
            context.light.lamps().sent_by_points(self.occluders, is_back);
        self.energy.emitted += emitted;
        self.energy.escaped += escaped;
        self.energy.on_backs += on_backs;
        // Once there has been enough, what the elements know will do.
        let error = if self.observer.flow.is_break() { f64::INFINITY } else { ERROR };
        let error = error * strength(self.energy.emitted);
        let arrival = arrival(context, mesh, vertices, &self.light, error);
        for (&reflectance, &received) in self.optics.reflectance.iter().zip(&arrival) {
            self.energy.absorbed += (Rgb::ONE - reflectance) * received;
        }
        if surfaces.lights.iter().any(|named| named.light.position().is_none()) {
            let elsewhere = self.energy.escaped + self.energy.on_backs;
            let arrived: Rgb = arrival.iter().sum();
            self.energy.emitted = self.energy.emitted.max(arrived + elsewhere);
        }
    }

    /// What emitters send past all fronts.
    ///
    /// Once there has been enough, what they send past is not known of all of them.
    pub(super) fn book_emitters(&mut self) {
        let (mesh, optics, groups) = (self.mesh, self.optics, self.groups);
        let shines = |patch: &&PatchId| optics.shines(**patch);
        let emitters: Vec<usize> = (0..groups.len())
            .filter(|&group| groups.members(group).iter().any(|patch| shines(&patch)))
            .collect();
        let past = |row: Row| (row.escaped, row.on_backs, row.factors);
        let rows = self.rows_of(&emitters, past);
        self.hemicubes += rows.len();
        let rows = rows.into_iter().chain(std::iter::repeat((0.0, 0.0, 0)));
        for (&emitter, (escaped, on_backs, factors)) in emitters.iter().zip(rows) {
            self.factors += factors;
            for &patch in groups.members(emitter).iter().filter(shines) {
                let power = optics.exitance[patch.index()] * mesh[patch].area;
                self.energy.emitted += power;
                self.energy.escaped += power * escaped;
                self.energy.on_backs += power * on_backs;
                self.shots += 1;
            }
        }
    }

    /// Makes the rows that are missing of some groups; none if there has been enough before all are made.
    pub(super) fn make_rows(&mut self, shooters: &[usize]) {
        if self.kept > self.most_kept {
            self.rows.fill(None);
            self.kept = 0;
        }
        let missing: Vec<usize> =
            shooters.iter().copied().filter(|&shooter| self.rows[shooter].is_none()).collect();
        let rows = self.rows_of(&missing, |mut row| {
            row.links.shrink_to_fit();
            row
        });
        if rows.len() < missing.len() {
            return;
        }
        self.hemicubes += rows.len();
        for (shooter, row) in missing.into_iter().zip(rows) {
            self.kept += row.links.len();
            self.factors += row.factors;
            self.rows[shooter] = Some(row);
        }
    }

    /// What `take` keeps of the rows of some groups, in their order; of the first only, if there has been enough.
    fn rows_of<R: Send>(
        &mut self,
        groups: &[usize],
        take: impl Fn(Row) -> R + Sync + Send,
    ) -> Vec<R> {
        let Self { mesh, ref glares, .. } = *self;
        let transport = Transport { mesh, groups: self.groups, glares };
        let (delta, targets, occluders) = (&self.delta, &self.targets, self.occluders);
        self.observer.map(
            groups,
            |_| Hemicube::new(delta, targets, occluders),
            |hemicube, &shooter| take(transport.row(hemicube, shooter)),
        )
    }
}
