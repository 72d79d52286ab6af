//! Rows of the exchange, made when they are needed.

use super::Shooting;
use crate::form_factor::hemicube::Hemicube;
use crate::mesh::PatchId;
use crate::solver::transport::{Row, row};

impl Shooting<'_, '_> {
    /// What emitters send past all fronts; of lights without a surface, all that arrives is emitted.
    ///
    /// Once there has been enough, what they send past is not known of all of them.
    pub(super) fn book_emitters(&mut self) {
        let (mesh, groups) = (self.mesh, self.groups);
        let shines = |patch: &&PatchId| mesh[**patch].exitance.max_element() > 0.0;
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
                let power = mesh[patch].exitance * mesh[patch].area;
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
        let scene = (self.surfaces, self.mesh, self.groups);
        let (delta, targets, occluders) = (&self.delta, &self.targets, self.occluders);
        self.observer.map(
            groups,
            |_| Hemicube::new(delta, targets, occluders),
            |hemicube, &shooter| take(row(scene, hemicube, shooter)),
        )
    }
}
