//! Rows by looking from points of a patch: more points where their views differ.

use glam::DVec3;

use super::contacts::Contacts;
use super::row::SparseRow;
use crate::form_factor::hemicube;
use crate::form_factor::pair::{place_in, quadrilaterals};
use crate::mesh::Patch;
use crate::visibility::SurfacePoint;

/// A patch whose view changes by more than this share of all light between one set of points and the
/// next is looked from by four times as many.
const TOLERANCE: f64 = 0.05;

/// Most often that points are made four times as many.
const MOST_LEVELS: u32 = 4;

/// Something that a point sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeenPatch {
    pub(super) patch: u32,
    /// Form factor from the point to what it sees of the patch.
    pub(super) factor: f64,
    /// True if nothing hides any of it.
    pub(super) clear: bool,
}

/// A way to look from a point along its normal, the view turned about it by an angle, radians.
pub(super) trait PatchVisibility {
    /// The patches whose fronts are seen, ascending.
    fn seen_from(&mut self, eye: SurfacePoint, turn: f64) -> Vec<SeenPatch>;
}

/// Form factors from a patch: means over points that are added until the row keeps still.
///
/// What is clear from everywhere will be computed exactly and has no say.
pub(super) fn row(
    patches: &[Patch],
    contacts: &Contacts,
    index: usize,
    view: &mut impl PatchVisibility,
) -> SparseRow {
    let mut from_points = |level: u32| {
        let points = points(&patches[index], 1 << level);
        let free = points.into_iter().filter(|(eye, _)| contacts.covering(index, *eye).is_none());
        Sum::from_points(free, patches, index, view)
    };
    let mut before = from_points(0);
    for level in 1..=MOST_LEVELS {
        let finer = from_points(level);
        let change = finer.change(&before);
        before = finer;
        if change <= TOLERANCE {
            break;
        }
    }
    before.into_row()
}

/// Sums over points, one entry a patch.
struct Sum {
    factors: Vec<f64>,
    clear: Vec<bool>,
}

impl Sum {
    fn from_points(
        points: impl Iterator<Item = (DVec3, f64)>,
        patches: &[Patch],
        index: usize,
        view: &mut impl PatchVisibility,
    ) -> Self {
        let mut sum = Self { factors: vec![0.0; patches.len()], clear: vec![true; patches.len()] };
        for (k, (eye, weight)) in points.enumerate() {
            let eye = SurfacePoint::new(eye, patches[index].normal);
            for seen in view.seen_from(eye, turn(index + 7 * k)) {
                sum.factors[seen.patch as usize] += weight * seen.factor;
                sum.clear[seen.patch as usize] &= seen.clear;
            }
        }
        sum
    }

    /// Share of all light that arrives elsewhere than `before`.
    fn change(&self, before: &Self) -> f64 {
        let pairs =
            self.factors.iter().zip(&before.factors).zip(self.clear.iter().zip(&before.clear));
        let partly = pairs.filter(|(_, (now, then))| !(**now && **then));
        0.5 * partly.map(|((now, then), _)| (now - then).abs()).sum::<f64>()
    }

    fn into_row(self) -> SparseRow {
        let factors = self.factors.into_iter().enumerate();
        factors.filter(|&(_, f)| f > 0.0).map(|(j, factor)| (j as u32, factor)).collect()
    }
}

/// Points that stand for parts of a patch, `cells` along each side of its quadrilaterals, and the
/// parts' shares of its area.
pub(super) fn points(patch: &Patch, cells: u32) -> Vec<(DVec3, f64)> {
    let middle = |k: u32| (f64::from(k) + 0.5) / f64::from(cells);
    let mut points: Vec<(DVec3, f64)> = quadrilaterals(&patch.corners)
        .flat_map(|cell| {
            let grid = (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j)));
            grid.map(move |(i, j)| place_in(&cell, middle(i), middle(j)))
        })
        .collect();
    let total: f64 = points.iter().map(|(_, area)| area).sum();
    points.iter_mut().for_each(|(_, area)| *area /= total);
    points
}

/// Angle of the `index`-th view, radians, none along the walls of a room.
pub(super) fn turn(index: usize) -> f64 {
    hemicube::turn(index as f64 + 0.5)
}
