//! All form factors of a scene's patches, by the method of one's choice.

mod contacts;
mod contour;
mod point;
mod sampled;
mod views;

use std::ops::ControlFlow;

use super::FormFactors;
use super::hemicube::{DeltaFactors, Targets};
use super::pair::{exchange, is_level};
use super::rays::Sphere;
use crate::mesh::Patch;
use crate::visibility::{Occluders, PatchHierarchy, PlanarPolygon};
use crate::watch;

pub use point::factors_at;

/// How form factors are found.
///
/// Where nothing stands between two patches, all methods use the exact formula; they differ in how
/// they find what is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Exactly: what occluders hide is cut away, and the rest integrated.
    Contour,
    /// By hemicubes with this many cells, an even number, along an edge: from a point; over a patch, by
    /// four of half as many, or more where views differ.
    Hemicube(u32),
    /// By spheres of this many rays.
    Rays(u32),
}

/// The form factors of a scene.
#[derive(Clone, Debug)]
pub struct Assembled {
    /// The matrix.
    pub factors: FormFactors,
    /// Share of each patch's light that meets the black backs of others.
    pub on_backs: Vec<f64>,
    /// Rows that were finished; the others are empty.
    pub rows: usize,
}

/// Rows whose sums are nearer to one than this have no light on backs worth looking for.
const CLOSED: f64 = 4e-4;

/// Fewest cells along a hemicube's edge.
const LEAST_RESOLUTION: u32 = 32;

/// A row: (column, factor or exchange), columns ascending.
type Row = Vec<(u32, f64)>;

/// The form factors between all `patches`, telling `observe` how much is done, 0..=1; when that breaks
/// off, the rows that are missing are empty, and light on backs is not looked for any more.
///
/// By hemicubes and rays, each pair has two estimates; their mean is taken, so that all matrices are
/// reciprocal and the sums of their rows tell how good they are.
pub fn assemble(
    patches: &[Patch],
    occluders: &Occluders,
    method: Method,
    mut observe: impl FnMut(f64) -> ControlFlow<()>,
) -> Assembled {
    let contacts = contacts::Contacts::find(patches, occluders);
    let exchanges = contour::Exchanges::new(patches, occluders, &contacts);
    let mut rows: Vec<Row> = Vec::with_capacity(patches.len());
    let areas: Vec<f64> = patches.iter().map(|patch| patch.area).collect();
    let [looked, all] = if method == Method::Contour { [0.9, 0.9] } else { [0.7, 0.9] };
    let mut look = |done| observe(looked * done);
    match method {
        Method::Contour => {
            in_batches(patches.len(), &mut rows, || (), |(), i| exchanges.row(i), &mut look);
        }
        Method::Hemicube(resolution) => {
            // Rows are looked at from four points or more: as many cells in all.
            let each = (resolution / 4 * 2).max(LEAST_RESOLUTION) as usize;
            let (delta, targets) = (DeltaFactors::new(each), Targets::new(patches));
            let looker = || views::Cells::new(patches, occluders, (&delta, &targets));
            let row = |look: &mut views::Cells<'_>, i| sampled::row((patches, &contacts), i, look);
            in_batches(patches.len(), &mut rows, looker, row, &mut look);
        }
        Method::Rays(count) => {
            let (sphere, hierarchy) = (Sphere::new(count as usize), PatchHierarchy::new(patches));
            let looker = || views::Sphere::new(patches, occluders, (&sphere, &hierarchy));
            let row = |look: &mut views::Sphere<'_>, i| sampled::row((patches, &contacts), i, look);
            in_batches(patches.len(), &mut rows, looker, row, &mut look);
        }
    }
    let mut done = rows.len();
    if method != Method::Contour {
        rows.resize(patches.len(), Row::new());
        let sampled = FormFactors::from_rows(areas.clone(), rows);
        let mut average = |share| observe(looked + (all - looked) * share);
        rows = exchanges_of((patches, done), occluders, &sampled, &mut average);
        done = rows.len();
    }
    rows.resize(patches.len(), Row::new());
    for (i, row) in rows.iter_mut().enumerate() {
        *row = merged(std::mem::take(row), contacts.row(i).into_iter());
        row.shrink_to_fit();
    }
    let factors = FormFactors::from_exchanges(areas, rows, done);
    let sums: Vec<(usize, f64)> = factors.row_sums().into_iter().enumerate().collect();
    let on_backs = |(): &mut (), &(i, sum): &(usize, f64)| {
        if i < done && sum < 1.0 - CLOSED { exchanges.on_backs(i).min(1.0 - sum) } else { 0.0 }
    };
    let mut look = |share| observe(all + (1.0 - all) * share);
    let mut on_backs = watch::in_batches(&sums, |_| (), on_backs, &mut look);
    on_backs.resize(patches.len(), 0.0);
    Assembled { factors, on_backs, rows: done }
}

fn facet(patch: &Patch) -> PlanarPolygon<'_> {
    PlanarPolygon::new(&patch.corners, patch.normal)
}

/// Computes rows 0..`count`, all threads at work, until `observe` breaks off.
fn in_batches<T>(
    count: usize,
    rows: &mut Vec<Row>,
    tool: impl Fn() -> T + Sync + Send,
    row: impl Fn(&mut T, usize) -> Row + Sync + Send,
    observe: &mut impl FnMut(f64) -> ControlFlow<()>,
) {
    let numbers: Vec<usize> = (0..count).collect();
    *rows = watch::in_batches(&numbers, |_| tool(), |tool, &number| row(tool, number), observe);
}

/// Exchanges above the diagonal in the first `count` rows, m²: exact where nothing stands between, else the mean of
/// the two estimates; of fewer rows, if `observe` breaks off.
fn exchanges_of(
    (patches, count): (&[Patch], usize),
    occluders: &Occluders,
    factors: &FormFactors,
    observe: &mut impl FnMut(f64) -> ControlFlow<()>,
) -> Vec<Row> {
    let transposed = factors.transposed();
    let row = |(): &mut (), i: usize| {
        let this = facet(&patches[i]);
        let above = |&(j, _): &(usize, f64)| j > i;
        let there: Row =
            factors.row(i).filter(above).map(|(j, f)| (j as u32, f * patches[i].area)).collect();
        let back = transposed.row(i).filter(above).map(|(j, f)| (j as u32, f * patches[j].area));
        let exact = |(j, sum): (u32, f64)| {
            let other = facet(&patches[j as usize]);
            if is_level(this, other, occluders.tolerance()) {
                return (j, 0.0);
            }
            let clear = occluders.is_clear(this, other);
            (j, if clear { exchange(this, other) } else { 0.5 * sum })
        };
        merged(there, back).into_iter().map(exact).collect()
    };
    let mut rows = Vec::new();
    in_batches(count, &mut rows, || (), row, observe);
    rows
}

/// Sums of the values of two lists with ascending columns.
fn merged(first: Row, second: impl Iterator<Item = (u32, f64)>) -> Row {
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
