//! Exchanges with occluders between: adaptive integration over one of the two polygons.

use super::cell::CubatureCell;
use super::cubature::quadrilaterals;
use super::unoccluded::{exchange, in_front, is_level};
use super::view::{PairView, VisibleOfAll, add, share};
use crate::geometry::PlanarPolygon;
use crate::geometry::area_vector;
use crate::visibility::Occluders;

/// Most cells that two polygons are divided in.
const MOST_CELLS: usize = 512;

/// Share of both sides' errors that their difference may reach.
const DISTRUST: f64 = 0.5;

/// Exchanges below this many times the error that is allowed are looked at from four points alone.
const FAINT: f64 = 4.0;

/// Exchange A₁F₁₂, m², between what two convex polygons see of each other, to within about
/// `tolerance` times the smaller of their areas.
///
/// Where something may stand between: the exact form factor from a point to the visible part of the
/// other polygon, integrated over cells that are halved where its share of all bends. Both
/// polygons take the part of the eye, until they agree: a shadow between the points of one is in
/// plain view of the other. Of all lengths only ratios matter.
pub fn visible_exchange(
    occluders: &Occluders,
    a: PlanarPolygon<'_>,
    b: PlanarPolygon<'_>,
    tolerance: f64,
) -> f64 {
    if is_level(a, b, occluders.epsilon()) {
        return 0.0;
    }
    let tolerance = tolerance * area(a).min(area(b));
    let (Some(front_a), Some(front_b)) = (in_front(a, b), in_front(b, a)) else { return 0.0 };
    let (a, b) =
        (PlanarPolygon { corners: &front_a, ..a }, PlanarPolygon { corners: &front_b, ..b });
    let between = occluders.between(a, b);
    if between.hides_all() {
        return 0.0;
    }
    let all = exchange(a, b);
    if between.is_empty() || all == 0.0 {
        return all;
    }
    let [there, back] = [(a, b), (b, a)].map(|(from, to)| PairView { from, to, between: &between });
    if all <= FAINT * tolerance {
        let smaller = if area(a) < area(b) { there } else { back };
        return all * smaller.visible_share();
    }
    let integral = settled([there, back].map(Integral::new), all, tolerance);
    integral.visible(all, tolerance)
}

/// That of two integrals, from either side, which is better known, once both agree.
///
/// What all points on one side miss, those on the other see.
fn settled<'a>(mut sides: [Integral<'a>; 2], all: f64, tolerance: f64) -> Integral<'a> {
    loop {
        let errors = [0, 1].map(|k| sides[k].error());
        let uniform = [0, 1].map(|k| sides[k].is_uniform());
        let better = if uniform[0] == uniform[1] { errors[1] < errors[0] } else { uniform[0] };
        let better = usize::from(better);
        let shares = [0, 1].map(|k| share(sides[k].sum()));
        let apart = (shares[0] - shares[1]).abs() * all;
        let agree = apart <= tolerance + DISTRUST * (errors[0] + errors[1]);
        let cells = sides[0].cells.len() + sides[1].cells.len();
        if (agree && errors[better] <= tolerance) || cells >= MOST_CELLS {
            let [there, back] = sides;
            return if better == 0 { there } else { back };
        }
        if errors[better] > tolerance {
            sides[better].halve(CubatureCell::error);
        } else {
            sides.iter_mut().for_each(|side| side.halve(|cell| cell.exchange[1]));
        }
    }
}

fn area(polygon: PlanarPolygon<'_>) -> f64 {
    area_vector(polygon.corners).length()
}

/// An integral over a polygon.
struct Integral<'a> {
    view: PairView<'a>,
    cells: Vec<CubatureCell>,
}

impl<'a> Integral<'a> {
    fn new(view: PairView<'a>) -> Self {
        let cells = quadrilaterals(view.from.corners).map(|cell| CubatureCell::whole(&view, cell));
        Self { cells: cells.collect(), view }
    }

    /// How far the visible part may be wrong, m².
    fn error(&self) -> f64 {
        self.cells.iter().map(CubatureCell::error).sum()
    }

    /// True if from all points all, or nothing, is seen: then they may have missed what is small.
    fn is_uniform(&self) -> bool {
        const ROUNDING: f64 = 1e-9;
        let [visible, all] = self.sum();
        visible.min(all - visible) <= ROUNDING * all
    }

    fn sum(&self) -> VisibleOfAll {
        self.cells.iter().map(|cell| cell.exchange).fold([0.0; 2], add)
    }

    /// Halves the cell with the largest `measure`.
    fn halve(&mut self, measure: impl Fn(&CubatureCell) -> f64) {
        let order =
            |&i: &usize, &k: &usize| measure(&self.cells[i]).total_cmp(&measure(&self.cells[k]));
        let Some(most) = (0..self.cells.len()).max_by(order) else { return };
        let cell = self.cells.swap_remove(most);
        self.cells.extend(cell.halves(&self.view));
    }

    /// The visible part, given `all`.
    fn visible(&self, all: f64, tolerance: f64) -> f64 {
        let sum = self.sum();
        if self.cells.len() == 1 || (sum[1] - all).abs() <= tolerance {
            return all * share(sum);
        }
        let exact = |cell: &CubatureCell| match share(cell.exchange) {
            0.0 => 0.0,
            visible => visible * cell.unhidden(&self.view),
        };
        self.cells.iter().map(exact).sum::<f64>().min(all)
    }
}
