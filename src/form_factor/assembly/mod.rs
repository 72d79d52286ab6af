//! All form factors of a scene's patches, by the method of one's choice.
//!
//! - `method`, `row`: what one chooses from, and what comes of it row by row
//! - `contacts`: patches face to face, which see nothing else
//! - `contour`: rows of exact exchanges
//! - `sampled`, `views`, `average`: rows by looking from points, through hemicubes and along rays, and one exchange
//!   of the two estimates
//! - `delta_sums`: rows by the cells of hemicubes alone
//! - `point`: the factors from a point

mod average;
mod contacts;
mod contour;
mod delta_sums;
mod method;
mod point;
mod row;
mod sampled;
mod views;

use std::ops::ControlFlow;

use super::hemicube::{DeltaFactors, Hemicube, HemicubeScene};
use super::matrix::FormFactors;
use super::rays::{Rays, Sphere};
use crate::mesh::Patch;
use crate::visibility::{Occluders, PatchHierarchy};
use crate::watch;

pub use method::{Assembled, FormFactorMethod};
pub use point::factors_at;

use average::exchanges_of;
use contacts::Contacts;
use contour::Exchanges;
use delta_sums::DeltaSums;
use row::{SparseRow, merged, rows_of};
use views::{HemicubeView, RayView};

/// Rows whose sums are nearer to one than this have no light on backs worth looking for.
const CLOSED: f64 = 4e-4;

/// Fewest cells along a hemicube's edge.
const LEAST_RESOLUTION: u32 = 32;

/// The form factors between all `patches`, telling `observe` how much is done, 0..=1; when that breaks
/// off, the rows that are missing are empty, and light on backs is not looked for any more.
///
/// By hemicubes and rays, each pair has two estimates; their mean is taken, so that matrices are
/// reciprocal and the sums of their rows tell how good they are. By sums over a hemicube's cells, rows are left as they
/// are: there, reciprocity tells.
pub fn assemble(
    patches: &[Patch],
    occluders: &Occluders,
    method: FormFactorMethod,
    mut observe: impl FnMut(f64) -> ControlFlow<()>,
) -> Assembled {
    let contacts = Contacts::find(patches, occluders);
    let exchanges = Exchanges::new(patches, occluders, &contacts);
    let areas: Vec<f64> = patches.iter().map(|patch| patch.area).collect();
    let [looked, all] = if method == FormFactorMethod::Contour { [0.9, 0.9] } else { [0.7, 0.9] };
    let mut look = |done| observe(looked * done);
    let mut rows = match method {
        FormFactorMethod::Contour => {
            rows_of(patches.len(), || (), |(), i| exchanges.row(i), &mut look)
        }
        FormFactorMethod::Hemicube(resolution) => {
            // Rows are looked at from four points or more: as many cells in all.
            let each = (resolution / 4 * 2).max(LEAST_RESOLUTION) as usize;
            let (delta, scene) = (DeltaFactors::new(each), HemicubeScene::new(patches));
            let view = || HemicubeView::new(patches, Hemicube::new(&delta, &scene, occluders));
            let row = |view: &mut HemicubeView<'_>, i| sampled::row(patches, &contacts, i, view);
            rows_of(patches.len(), view, row, &mut look)
        }
        FormFactorMethod::HemicubeSum(cells) => {
            return DeltaSums::new(patches, &contacts, occluders, cells).assembled(observe);
        }
        FormFactorMethod::Rays(count) => {
            let (sphere, hierarchy) = (Sphere::new(count as usize), PatchHierarchy::new(patches));
            let view = || RayView::new(patches, occluders, Rays::new(&sphere, &hierarchy));
            let row = |view: &mut RayView<'_>, i| sampled::row(patches, &contacts, i, view);
            rows_of(patches.len(), view, row, &mut look)
        }
    };
    let mut done = rows.len();
    if method != FormFactorMethod::Contour {
        rows.resize(patches.len(), SparseRow::new());
        let sampled = FormFactors::from_rows(areas.clone(), rows);
        let mut average = |share| observe(looked + (all - looked) * share);
        rows = exchanges_of(patches, done, occluders, &sampled, &mut average);
        done = rows.len();
    }
    rows.resize(patches.len(), SparseRow::new());
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
