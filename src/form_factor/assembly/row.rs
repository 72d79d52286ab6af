//! Rows of a sparse matrix while it is put together.

use std::ops::ControlFlow;

use crate::watch;

/// A row: (column, factor or exchange), columns ascending.
pub(super) type SparseRow = Vec<(u32, f64)>;

/// Sums of the values of two lists with ascending columns.
pub(super) fn merged(first: SparseRow, second: impl Iterator<Item = (u32, f64)>) -> SparseRow {
    let mut both = first;
    both.extend(second);
    both.sort_by_key(|&(column, _)| column);
    both.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        kept.1 += if same { next.1 } else { 0.0 };
        same
    });
    both
}

/// The rows 0..`count`, all threads at work, until `observe` breaks
/// off.
pub(super) fn rows_of<T>(
    count: usize,
    tool: impl Fn() -> T + Sync + Send,
    row: impl Fn(&mut T, usize) -> SparseRow + Sync + Send,
    observe: &mut impl FnMut(f64) -> ControlFlow<()>,
) -> Vec<SparseRow> {
    let numbers: Vec<usize> = (0..count).collect();
    watch::in_batches(&numbers, |_| tool(), |tool, &number| row(tool, number), observe)
}
