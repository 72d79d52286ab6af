//! The classical hemicube, with all its errors.

use std::ops::ControlFlow;

use glam::DVec3;

use super::contacts::Contacts;
use super::method::Assembled;
use super::row::SparseRow;
use super::sampled::{points, turn};
use crate::form_factor::hemicube::{DeltaFactors, Hemicube, HemicubeScene};
use crate::form_factor::matrix::FormFactors;
use crate::mesh::Patch;
use crate::visibility::{Occluders, SurfacePoint};
use crate::watch;

/// Form factors by the cells of hemicubes alone.
pub(super) struct DeltaSums<'a> {
    patches: &'a [Patch],
    contacts: &'a Contacts,
    occluders: &'a Occluders,
    delta: DeltaFactors,
    scene: HemicubeScene,
}

/// The sums of the delta factors of the cells that see fronts, by patch, and of those that see backs.
pub(super) struct CellRow {
    pub(super) fronts: SparseRow,
    backs: f64,
}

impl CellRow {
    /// The last look of a hemicube.
    pub(super) fn of(hemicube: &Hemicube<'_>) -> Self {
        let (mut fronts, mut backs) = (SparseRow::new(), 0.0);
        for seen in hemicube.coverage_of(|_| true).filter(|seen| seen.kept > 0.0) {
            if seen.front {
                fronts.push((seen.patch.0, seen.kept));
            } else {
                backs += seen.kept;
            }
        }
        fronts.sort_by_key(|&(column, _)| column);
        Self { fronts, backs }
    }
}

impl<'a> DeltaSums<'a> {
    /// By hemicubes with this many cells along an edge.
    pub(super) fn new(
        patches: &'a [Patch],
        contacts: &'a Contacts,
        occluders: &'a Occluders,
        cells: u32,
    ) -> Self {
        let (delta, scene) = (DeltaFactors::new(cells as usize), HemicubeScene::new(patches));
        Self { patches, contacts, occluders, delta, scene }
    }

    /// The form factors between all patches; if `observe` breaks off, the rows that are missing are empty.
    pub(super) fn assembled(&self, mut observe: impl FnMut(f64) -> ControlFlow<()>) -> Assembled {
        let numbers: Vec<usize> = (0..self.patches.len()).collect();
        let hemicube = |_: &watch::Enough| Hemicube::new(&self.delta, &self.scene, self.occluders);
        let row = |hemicube: &mut Hemicube<'_>, &index: &usize| self.row(hemicube, index);
        let mut rows = watch::in_batches(&numbers, hemicube, row, &mut observe);
        let done = rows.len();
        rows.resize_with(numbers.len(), || CellRow { fronts: SparseRow::new(), backs: 0.0 });
        let on_backs = rows.iter().map(|row| row.backs).collect();
        let areas = self.patches.iter().map(|patch| patch.area).collect();
        let factors = FormFactors::from_rows(areas, rows.into_iter().map(|row| row.fronts));
        Assembled { factors, on_backs, rows: done }
    }

    /// What the centre of a patch sees, for all of it.
    fn row(&self, hemicube: &mut Hemicube<'_>, index: usize) -> CellRow {
        let patch = &self.patches[index];
        let centre: DVec3 = points(patch, 1).into_iter().map(|(place, share)| place * share).sum();
        if let Some(other) = self.contacts.covering(index, centre) {
            return CellRow { fronts: vec![(other, 1.0)], backs: 0.0 };
        }
        CellRow::of(hemicube.look(SurfacePoint::new(centre, patch.normal), turn(index)))
    }
}
