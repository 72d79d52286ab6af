//! Rows by looking from points of a patch: more points where their views differ.

use glam::DVec3;

use super::{Row, facet};
use crate::form_factor::pair::{exchange, place_in, quadrilaterals};
use crate::mesh::Patch;

/// A patch whose view changes by more than this share of all light between one set of points and the
/// next is looked from by four times as many.
const TOLERANCE: f64 = 0.05;

/// Most often that points are made four times as many.
const MOST_LEVELS: u32 = 4;

/// Patches nearer to each other than this share of their size touch.
const TOUCHING: f64 = 1e-6;

/// Something that a point sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) patch: u32,
    /// Form factor from the point to what it sees of the patch.
    pub(super) factor: f64,
    /// True if nothing hides any of it.
    pub(super) clear: bool,
}

/// A way to look from a point with a unit normal, the view turned about it by an angle, radians.
pub(super) trait Look {
    /// The patches whose fronts are seen, ascending.
    fn look(&mut self, eye: DVec3, normal: DVec3, turn: f64) -> Vec<Seen>;
}

/// Form factors from a patch: means over points that are added until the row keeps still.
///
/// What is clear from everywhere will be computed exactly and has no say.
pub(super) fn row(patches: &[Patch], index: usize, look: &mut impl Look) -> Row {
    let count = patches.len();
    let patch = &Looking { patch: &patches[index], covers: covers(patches, index) };
    let mut before = Sum::from_points(patch, (index, 0), count, look);
    for level in 1..=MOST_LEVELS {
        if before.partly_hidden() <= TOLERANCE {
            break;
        }
        let finer = Sum::from_points(patch, (index, level), count, look);
        let change = finer.change(&before);
        before = finer;
        if change <= TOLERANCE {
            break;
        }
    }
    before.into_row()
}

/// A patch to look from, and what lies on it.
struct Looking<'a> {
    patch: &'a Patch,
    covers: Vec<Cover<'a>>,
}

/// A patch in the same plane that faces the other way: from where it covers nothing else is seen.
struct Cover<'a> {
    index: u32,
    patch: &'a Patch,
    /// Share that it covers.
    factor: f64,
}

impl Cover<'_> {
    fn holds(&self, point: DVec3) -> bool {
        let (corners, normal) = (&self.patch.corners, self.patch.normal);
        (0..corners.len()).all(|k| {
            let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
            (to - from).cross(point - from).dot(normal) >= 0.0
        })
    }
}

/// The patches that lie face to face on one of them; the two sides of one polygon do not.
fn covers<'a>(patches: &'a [Patch], index: usize) -> Vec<Cover<'a>> {
    let patch = &patches[index];
    let nearness = TOUCHING * patch.area.sqrt();
    let lies_on = |other: &Patch| {
        other.normal.dot(patch.normal) < -1.0 + TOUCHING
            && (other.corners[0] - patch.corners[0]).dot(patch.normal).abs() < nearness
            && !(other.two_sided && patch.two_sided)
    };
    let cover = |(other, index): (&'a Patch, u32)| {
        let factor = exchange(facet(patch), facet(other)) / patch.area;
        (factor > 0.0).then_some(Cover { index, patch: other, factor })
    };
    let on_it = patches.iter().zip(0..).filter(|(other, _)| lies_on(other));
    on_it.filter_map(cover).collect()
}

/// Sums over points, one entry a patch.
struct Sum {
    factors: Vec<f64>,
    clear: Vec<bool>,
}

impl Sum {
    fn from_points(
        Looking { patch, covers }: &Looking<'_>,
        (index, level): (usize, u32),
        count: usize,
        look: &mut impl Look,
    ) -> Self {
        let mut sum = Self { factors: vec![0.0; count], clear: vec![true; count] };
        for cover in covers {
            sum.factors[cover.index as usize] = cover.factor;
        }
        let points = points(patch, 1 << level);
        for (k, (eye, weight)) in points.into_iter().enumerate() {
            if covers.iter().any(|cover| cover.holds(eye)) {
                continue;
            }
            for seen in look.look(eye, patch.normal, turn(index + 7 * k)) {
                sum.factors[seen.patch as usize] += weight * seen.factor;
                sum.clear[seen.patch as usize] &= seen.clear;
            }
        }
        sum
    }

    /// Light that arrives at what is only seen in parts.
    fn partly_hidden(&self) -> f64 {
        let hidden = self.factors.iter().zip(&self.clear).filter(|(_, clear)| !**clear);
        hidden.map(|(factor, _)| factor).sum()
    }

    /// Share of all light that arrives elsewhere than `before`.
    fn change(&self, before: &Self) -> f64 {
        let pairs =
            self.factors.iter().zip(&before.factors).zip(self.clear.iter().zip(&before.clear));
        let partly = pairs.filter(|(_, (now, then))| !(**now && **then));
        0.5 * partly.map(|((now, then), _)| (now - then).abs()).sum::<f64>()
    }

    fn into_row(self) -> Row {
        let factors = self.factors.into_iter().enumerate();
        factors.filter(|&(_, f)| f > 0.0).map(|(j, factor)| (j as u32, factor)).collect()
    }
}

/// Points that stand for parts of a patch, `cells` along each side of its quadrilaterals, and the
/// parts' shares of its area.
fn points(patch: &Patch, cells: u32) -> Vec<(DVec3, f64)> {
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

/// Angle of the `index`-th view, radians: no two alike, so that their errors do not add up, and none
/// along the walls of a room.
pub(super) fn turn(index: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    ((index as f64 + 0.5) * GOLDEN).fract() * std::f64::consts::FRAC_PI_2
}
