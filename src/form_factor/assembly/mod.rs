//! All form factors of a scene's patches, by the method of one's choice.

mod contour;

use std::ops::{ControlFlow, Range};

use rayon::prelude::*;

use super::FormFactors;
use crate::mesh::Patch;
use crate::visibility::Occluders;

/// How form factors are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Exact formulas, integrated over one of two patches where something stands between them.
    Contour,
}

/// Rows computed between two reports of progress. A number of its own, so that threads change nothing.
const BATCH: usize = 64;

/// A row: (column, factor), columns ascending.
type Row = Vec<(u32, f64)>;

/// The form factors between all `patches`, `observe`d with the share that is done, 0..=1; when that
/// breaks off, the rows that are missing are empty.
pub fn assemble(
    patches: &[Patch],
    occluders: &Occluders,
    method: Method,
    mut observe: impl FnMut(f64) -> ControlFlow<()>,
) -> FormFactors {
    let mut rows: Vec<Row> = Vec::with_capacity(patches.len());
    match method {
        Method::Contour => {
            let exchanges = contour::Exchanges::new(patches, occluders);
            in_batches(patches.len(), &mut rows, |i| exchanges.row(i), &mut observe);
        }
    }
    rows.resize(patches.len(), Row::new());
    let areas: Vec<f64> = patches.iter().map(|patch| patch.area).collect();
    mirror(&mut rows, &areas);
    FormFactors::from_rows(areas, rows)
}

/// Computes rows 0..`count`, all threads at work, until `observe` breaks off.
fn in_batches(
    count: usize,
    rows: &mut Vec<Row>,
    row: impl Fn(usize) -> Row + Sync,
    observe: &mut impl FnMut(f64) -> ControlFlow<()>,
) {
    while rows.len() < count {
        let batch: Range<usize> = rows.len()..(rows.len() + BATCH).min(count);
        if observe(batch.start as f64 / count as f64).is_break() {
            return;
        }
        let done: Vec<Row> = batch.into_par_iter().map(&row).collect();
        rows.extend(done);
    }
}

/// Completes exchanges above the diagonal to form factors on both of its sides.
fn mirror(rows: &mut [Row], areas: &[f64]) {
    let mut below = vec![Row::new(); rows.len()];
    for (i, row) in rows.iter_mut().enumerate() {
        for (j, value) in row {
            below[*j as usize].push((i as u32, *value / areas[*j as usize]));
            *value /= areas[i];
        }
    }
    for (row, mut below) in rows.iter_mut().zip(below) {
        below.append(row);
        *row = below;
    }
}
