//! Exchanges with occluders between: adaptive integration over one of the two polygons.

use glam::DVec3;

use super::cubature::{at, quadrilaterals};
use super::{exchange, in_front};
use crate::form_factor::contour::point_to_polygon_above;
use crate::visibility::{Between, Facet, Occluders};

/// Most cells that a polygon is divided in.
const MOST_CELLS: usize = 1000;

/// Exchange A₁F₁₂, m², between what two convex polygons see of each other, to within about
/// `tolerance` times the smaller of their areas.
///
/// Where something may stand between: the exact form factor from a point to the visible part of the
/// other polygon, integrated over cells that are divided where it bends. Visible and hidden part
/// are integrated side by side; what is known better decides, as together they are the
/// [`exchange`] that there would be with nothing between.
pub fn visible_exchange(occluders: &Occluders, a: Facet<'_>, b: Facet<'_>, tolerance: f64) -> f64 {
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
    let mut from_a = Integral::new(View { from: a, to: b, between: &between });
    if from_a.error() <= tolerance {
        return from_a.visible(all);
    }
    let mut from_b = Integral::new(View { from: b, to: a, between: &between });
    let better = if from_a.error() <= from_b.error() { &mut from_a } else { &mut from_b };
    better.refine(tolerance);
    better.visible(all)
}

fn area(facet: Facet<'_>) -> f64 {
    super::vector_area(facet.corners).length()
}

/// One polygon as seen from points on another.
#[derive(Clone, Copy)]
struct View<'a> {
    from: Facet<'a>,
    to: Facet<'a>,
    between: &'a Between<'a>,
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

    /// Exchanges over a cell by Gauss's rule of two by two points.
    fn over(&self, cell: &[DVec3; 4]) -> [f64; 2] {
        const NODES: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
        let mut sums = [0.0; 2];
        for s in NODES {
            for t in NODES {
                let (place, area) = at(cell, s, t);
                let factors = self.look(place);
                sums = [0, 1].map(|k| sums[k] + 0.25 * area * factors[k]);
            }
        }
        sums
    }
}

/// A part of a polygon, with exchanges of its visible and its hidden part.
struct Cell {
    quarters: [([DVec3; 4], [f64; 2]); 4],
    /// Differences between the cell taken whole and in quarters.
    errors: [f64; 2],
}

impl Cell {
    fn new(view: &View<'_>, corners: &[DVec3; 4], whole: [f64; 2]) -> Self {
        let quarters = quarters(corners).map(|quarter| (quarter, view.over(&quarter)));
        let sum = |k: usize| quarters.iter().map(|(_, values)| values[k]).sum::<f64>();
        Self { quarters, errors: [0, 1].map(|k| (whole[k] - sum(k)).abs()) }
    }

    fn error(&self) -> f64 {
        self.errors[0].max(self.errors[1])
    }
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
        let cells = cells.map(|cell| Cell::new(&view, &cell, view.over(&cell))).collect();
        Self { view, cells }
    }

    fn errors(&self) -> [f64; 2] {
        let sum = |k: usize| self.cells.iter().map(|cell| cell.errors[k]).sum();
        [sum(0), sum(1)]
    }

    fn error(&self) -> f64 {
        self.errors().into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Divides the worst cells until the error is below `tolerance`.
    fn refine(&mut self, tolerance: f64) {
        while self.error() > tolerance && self.cells.len() < MOST_CELLS {
            let worst = (0..self.cells.len())
                .max_by(|&i, &j| self.cells[i].error().total_cmp(&self.cells[j].error()))
                .expect("a polygon has cells");
            let cell = self.cells.swap_remove(worst);
            let parts = cell.quarters.iter();
            self.cells.extend(parts.map(|(quarter, whole)| Cell::new(&self.view, quarter, *whole)));
        }
    }

    /// The visible part, given `all`.
    fn visible(&self, all: f64) -> f64 {
        let quarters = || self.cells.iter().flat_map(|cell| &cell.quarters);
        let sum = |k: usize| quarters().map(|(_, values)| values[k]).sum::<f64>();
        let [visible, hidden] = self.errors();
        if visible <= hidden { sum(0).min(all) } else { (all - sum(1)).max(0.0) }
    }
}
