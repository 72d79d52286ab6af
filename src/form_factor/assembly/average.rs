//! One exchange of the two estimates that sampling gives of it.

use std::ops::ControlFlow;

use super::row::{SparseRow, merged, rows_of};
use crate::form_factor::matrix::FormFactors;
use crate::form_factor::pair::{exchange, is_level};
use crate::mesh::Patch;
use crate::visibility::Occluders;

/// Exchanges above the diagonal in the first `count` rows, m²: exact where nothing stands between, else the mean of
/// the two estimates; of fewer rows, if `observe` breaks off.
pub(super) fn exchanges_of(
    patches: &[Patch],
    count: usize,
    occluders: &Occluders,
    factors: &FormFactors,
    observe: &mut impl FnMut(f64) -> ControlFlow<()>,
) -> Vec<SparseRow> {
    let transposed = factors.transposed();
    let row = |(): &mut (), i: usize| {
        let this = patches[i].polygon();
        let above = |&(j, _): &(usize, f64)| j > i;
        let there: SparseRow =
            factors.row(i).filter(above).map(|(j, f)| (j as u32, f * patches[i].area)).collect();
        let back = transposed.row(i).filter(above).map(|(j, f)| (j as u32, f * patches[j].area));
        let exact = |(j, sum): (u32, f64)| {
            let other = patches[j as usize].polygon();
            if is_level(this, other, occluders.epsilon()) {
                return (j, 0.0);
            }
            let clear = occluders.is_clear(this, other);
            (j, if clear { exchange(this, other) } else { 0.5 * sum })
        };
        merged(there, back).into_iter().map(exact).collect()
    };
    rows_of(count, || (), row, observe)
}
