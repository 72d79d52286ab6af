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
use crate::surface::SurfaceId;

impl Shooting<'_, '_> {
    /// What lights at points send out and past all fronts, and what fronts absorb of all direct light.
    ///
    /// Of light from infinitely far, all that arrives is emitted.
    pub(super) fn book_direct_light(&mut self, vertices: &VertexLight) {
        let (mesh, context) = (self.mesh, self.context);
        let surfaces = context.surfaces;
        let is_back = |surface: SurfaceId| !surfaces[surface].two_sided;
        let Sent { emitted, escaped, on_backs } =
            context.light.emitters().sent_by_points(context.occluders, is_back);
        self.state.energy.emitted += emitted;
        self.state.energy.escaped += escaped;
        self.state.energy.on_backs += on_backs;
        // Once there has been enough, what the elements know will do.
        let error = if self.observer.is_over() { f64::INFINITY } else { ERROR };
        let error = error * strength(self.state.energy.emitted);
        let (arrival, work) = arrival(context, mesh, vertices, &self.light, error);
        self.direct_work = work;
        for (&reflectance, &received) in context.optics.reflectance.iter().zip(&arrival) {
            self.state.energy.absorbed += (Rgb::ONE - reflectance) * received;
        }
        if surfaces.lights.iter().any(|named| named.light.position().is_none()) {
            let elsewhere = self.state.energy.escaped + self.state.energy.on_backs;
            let arrived: Rgb = arrival.iter().sum();
            self.state.energy.emitted = self.state.energy.emitted.max(arrived + elsewhere);
        }
    }

    /// What emitters send past all fronts.
    ///
    /// Once there has been enough, what they send past is not known of all of them.
    pub(super) fn book_emitters(&mut self) {
        let (mesh, optics, clusters) = (self.mesh, self.context.optics, self.context.clusters);
        let shines = |patch: &&PatchId| optics.shines(**patch);
        let emitters: Vec<usize> = (0..clusters.len())
            .filter(|&cluster| clusters.members(cluster).iter().any(|patch| shines(&patch)))
            .collect();
        let past = |row: Row| (row.escaped, row.on_backs, row.factors);
        let rows = self.rows_of(&emitters, past);
        self.state.hemicubes += rows.len();
        let rows = rows.into_iter().chain(std::iter::repeat((0.0, 0.0, 0)));
        for (&emitter, (escaped, on_backs, factors)) in emitters.iter().zip(rows) {
            self.state.factors += factors;
            for &patch in clusters.members(emitter).iter().filter(shines) {
                let power = optics.exitance[patch.index()] * mesh[patch].area;
                self.state.energy.emitted += power;
                self.state.energy.escaped += power * escaped;
                self.state.energy.on_backs += power * on_backs;
                self.state.shots += 1;
            }
        }
    }

    /// Makes the rows that are missing of some clusters; none if there has been enough before all are made.
    pub(super) fn make_rows(&mut self, shooters: &[usize]) {
        self.rows.make_room();
        let missing: Vec<usize> =
            shooters.iter().copied().filter(|&shooter| !self.rows.has(shooter)).collect();
        let rows = self.rows_of(&missing, |mut row| {
            row.links.shrink_to_fit();
            row
        });
        if rows.len() < missing.len() {
            return;
        }
        self.state.hemicubes += rows.len();
        for (shooter, row) in missing.into_iter().zip(rows) {
            self.state.factors += row.factors;
            self.rows.keep(shooter, row);
        }
    }

    /// What `take` keeps of the rows of some clusters, in their order; of the first only, if there has been enough.
    fn rows_of<R: Send>(
        &mut self,
        shooters: &[usize],
        take: impl Fn(Row) -> R + Sync + Send,
    ) -> Vec<R> {
        let Self { mesh, ref glares, .. } = *self;
        let Context { clusters, occluders, .. } = self.context;
        let transport = Transport { mesh, clusters, glares };
        let (delta, targets) = (&self.delta, &self.targets);
        self.observer.map(
            shooters,
            |_| Hemicube::new(delta, targets, occluders),
            |hemicube, &shooter| take(transport.row(hemicube, shooter)),
        )
    }
}
