//! Exchanges with occluders between: adaptive integration over one of the two polygons.

use glam::DVec3;

use super::cubature::{at, quadrilaterals};
use super::{Round, exchange, in_front, is_level};
use crate::form_factor::contour::point_to_polygon_above;
use crate::scene::area_vector;
use crate::visibility::{Between, Facet, Occluders};

/// Most cells that a polygon is divided in.
const MOST_CELLS: usize = 100;

/// Exchange A₁F₁₂, m², between what two convex polygons see of each other, to within about
/// `tolerance` times the smaller of their areas.
///
/// Where something may stand between: the exact form factor from a point to the visible part of the
/// other polygon, integrated over cells that are divided where it bends. Visible and hidden part
/// are integrated side by side; what is known better decides, as together they are the
/// [`exchange`] that there would be with nothing between.
pub fn visible_exchange(occluders: &Occluders, a: Facet<'_>, b: Facet<'_>, tolerance: f64) -> f64 {
    if is_level(a, b, occluders.tolerance()) {
        return 0.0;
    }
    let (Some(front_a), Some(front_b)) = (in_front(a, b), in_front(b, a)) else { return 0.0 };
    let (a, b) = (Facet { corners: &front_a, ..a }, Facet { corners: &front_b, ..b });
    let between = occluders.between(a, b);
    if between.hides_all() {
        return 0.0;
    }
    let all = exchange(a, b);
    if between.is_empty() || all == 0.0 {
        return all;
    }
    let tolerance = tolerance * area(a).min(area(b));
    let clearance = |facet: Facet<'_>| {
        let round = Round::about(facet.corners);
        between.distance(round.centre) / round.radius
    };
    // Where occluders are far away, shadows have wide borders.
    let (from, to) = if clearance(a) > clearance(b) { (a, b) } else { (b, a) };
    let view = View { from, to, between: &between };
    let tolerance = tolerance * area(a).min(area(b));
    if all <= tolerance {
        return all * view.visible_share();
    }
    let mut integral = Integral::new(view);
    integral.refine(tolerance);
    integral.visible(all)
}

fn area(facet: Facet<'_>) -> f64 {
    area_vector(facet.corners).length()
}

/// One polygon as seen from points on another.
#[derive(Clone, Copy)]
struct View<'a> {
    from: Facet<'a>,
    to: Facet<'a>,
    between: &'a Between,
}

impl View<'_> {
    /// Form factors from a point to the visible and to the hidden part.
    fn look(&self, eye: DVec3) -> [f64; 2] {
        let factor =
            |polygon: &[DVec3]| point_to_polygon_above(eye, self.from.plane.normal, polygon);
        let visible =
            self.between.visible_part(eye, self.to).iter().map(|piece| factor(piece)).sum();
        [visible, (factor(self.to.corners) - visible).max(0.0)]
    }

    /// Share of the exchange that nothing hides, about.
    fn visible_share(&self) -> f64 {
        let cells = quadrilaterals(self.from.corners).map(|cell| self.over(&cell).1);
        let [visible, hidden] = cells.fold([0.0; 2], |sum, cell| [0, 1].map(|k| sum[k] + cell[k]));
        if visible > 0.0 { visible / (visible + hidden) } else { 0.0 }
    }

    /// The form factors at the four points of Gauss's rule for a cell, and its exchanges by it.
    fn over(&self, cell: &[DVec3; 4]) -> ([[f64; 2]; 4], [f64; 2]) {
        let points = POINTS.map(|[s, t]| at(cell, s, t));
        let factors = points.map(|(place, _)| self.look(place));
        let sum = |k: usize| (0..4).map(|i| 0.25 * points[i].1 * factors[i][k]).sum();
        (factors, [sum(0), sum(1)])
    }
}

/// Gauss's two by two points in the unit square, in the order of a quadrilateral's corners.
const POINTS: [[f64; 2]; 4] = {
    const LOW: f64 = 0.211_324_865_405_187_1;
    const HIGH: f64 = 1.0 - LOW;
    [[LOW, LOW], [HIGH, LOW], [HIGH, HIGH], [LOW, HIGH]]
};

/// A part of a polygon, with exchanges of its visible and its hidden part.
struct Cell {
    quarters: [Quarter; 4],
    /// How far the quarters are from what the cell as a whole makes one expect, m².
    errors: [f64; 2],
}

struct Quarter {
    corners: [DVec3; 4],
    factors: [[f64; 2]; 4],
    exchanges: [f64; 2],
}

impl Cell {
    /// Also where all quarters together agree with the whole, each is held to it: a shadow's edge
    /// may deceive a sum, but not all of its parts.
    fn new(view: &View<'_>, corners: &[DVec3; 4], factors: &[[f64; 2]; 4]) -> Self {
        let quarters = quarters(corners).map(|corners| {
            let (factors, exchanges) = view.over(&corners);
            Quarter { corners, factors, exchanges }
        });
        let error = |k: usize, nearest: usize| {
            let expected = interpolate(factors.map(|f| f[k]), nearest);
            let area = at(&quarters[nearest].corners, 0.5, 0.5).1;
            (quarters[nearest].exchanges[k] - expected * area).abs()
        };
        let overlooked = overlooked(view, corners, &quarters);
        let errors =
            [0, 1].map(|k| (0..4).map(|nearest| error(k, nearest)).sum::<f64>() + overlooked[k]);
        Self { quarters, errors }
    }
}

/// Exchanges, m², that all points may have missed, where they agree that nothing is visible, or that
/// nothing is hidden: what the cell's corners say otherwise.
fn overlooked(view: &View<'_>, corners: &[DVec3; 4], quarters: &[Quarter; 4]) -> [f64; 2] {
    /// Corners are looked from a little inside: on a border, what touches it has no side.
    const INSIDE: [f64; 2] = [0.005, 0.995];
    /// Form factors below this are rounding.
    const SILENT: f64 = 1e-12;
    /// Share of a cell along one side that no point stands for.
    const BEYOND: f64 = 0.05;
    let is_silent = [0, 1].map(|k| quarters.iter().flat_map(|q| &q.factors).all(|f| f[k] < SILENT));
    if !is_silent[0] && !is_silent[1] {
        return [0.0; 2];
    }
    let mut most = [0.0_f64; 2];
    for [s, t] in [[0, 0], [1, 0], [1, 1], [0, 1]] {
        let (place, area) = at(corners, INSIDE[s], INSIDE[t]);
        let factors = view.look(place);
        most = [0, 1].map(|k| most[k].max(factors[k] * area));
    }
    [0, 1].map(|k| if is_silent[k] { BEYOND * most[k] } else { 0.0 })
}

/// Mean over a quarter of the bilinear function through values at Gauss's points.
fn interpolate(values: [f64; 4], nearest: usize) -> f64 {
    // The quarter's centre lies at 1/2, the points at 1/√3 of the way from the centre.
    const NEAR: f64 = 0.933_012_701_892_219_3;
    const FAR: f64 = 1.0 - NEAR;
    let weights = [NEAR * NEAR, NEAR * FAR, FAR * FAR, FAR * NEAR];
    (0..4).map(|k| weights[k] * values[(nearest + k) % 4]).sum()
}

/// The four parts of a quadrilateral between its corners, the middles of its edges and its centre.
fn quarters(cell: &[DVec3; 4]) -> [[DVec3; 4]; 4] {
    const HALVES: [[f64; 2]; 2] = [[0.0, 0.5], [0.5, 1.0]];
    let place = |s: f64, t: f64| at(cell, s, t).0;
    let part = |[s0, s1]: [f64; 2], [t0, t1]: [f64; 2]| {
        [place(s0, t0), place(s1, t0), place(s1, t1), place(s0, t1)]
    };
    [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[s, t]: [usize; 2]| part(HALVES[s], HALVES[t]))
}

/// An integral over a polygon and what it may be wrong by.
struct Integral<'a> {
    view: View<'a>,
    cells: Vec<Cell>,
}

impl<'a> Integral<'a> {
    fn new(view: View<'a>) -> Self {
        let cells = quadrilaterals(view.from.corners);
        let cells = cells.map(|cell| Cell::new(&view, &cell, &view.over(&cell).0)).collect();
        Self { view, cells }
    }

    fn errors(&self) -> [f64; 2] {
        let sum = |k: usize| self.cells.iter().map(|cell| cell.errors[k]).sum();
        [sum(0), sum(1)]
    }

    /// Divides the worst cells until the error is below `tolerance`.
    fn refine(&mut self, tolerance: f64) {
        while self.cells.len() < MOST_CELLS {
            let [visible, hidden] = self.errors();
            if visible.min(hidden) <= tolerance {
                return;
            }
            let k = usize::from(hidden < visible);
            let worst = (0..self.cells.len())
                .max_by(|&i, &j| self.cells[i].errors[k].total_cmp(&self.cells[j].errors[k]))
                .expect("a polygon has cells");
            let cell = self.cells.swap_remove(worst);
            let part = |part: &Quarter| Cell::new(&self.view, &part.corners, &part.factors);
            self.cells.extend(cell.quarters.iter().map(part));
        }
    }

    /// The visible part, given `all`.
    fn visible(&self, all: f64) -> f64 {
        let quarters = || self.cells.iter().flat_map(|cell| &cell.quarters);
        let sum = |k: usize| quarters().map(|quarter| quarter.exchanges[k]).sum::<f64>();
        let [visible, hidden] = self.errors();
        if visible <= hidden { sum(0).min(all) } else { (all - sum(1)).max(0.0) }
    }
}
