//! How much of an emitter is seen, by rays: more of them along the borders of what is.
//!
//! Each cell of the emitter has a ray to its middle. Where those of neighbours differ, cells are quartered, and of
//! these, those whose quarters differ, until what the cells on the border may hide is less than the error allowed.

use glam::DVec3;

use super::view::{EmitterView, Seen};
use crate::visibility::Occluders;

/// Most rays to an emitter before no more cells are quartered.
const MOST_RAYS: u64 = 288;

/// Most rows of cells on each triangle to begin with: more would not find what fewer miss at a tenth of the cost.
const MOST_ROWS: f64 = 4.0;

impl EmitterView<'_> {
    /// What is not hidden, by rays: right to within `error` of the exitance, unless that takes too many.
    pub(super) fn sampled(&self, occluders: &Occluders, error: f64) -> Seen {
        Sampling::new(self, occluders, error).run()
    }

    /// What is not hidden, by a ray to each of the cells in so many rows on each of its triangles.
    pub(super) fn sampled_evenly(&self, occluders: &Occluders, rows: u32) -> Seen {
        Sampling::evenly(self, occluders, rows).all_cells()
    }
}

/// A triangle of an emitter, and the ray to its middle.
#[derive(Clone, Copy)]
struct EmitterCell {
    corners: [DVec3; 3],
    weight: f64,
    seen: bool,
}

/// Rays from a place to an emitter.
pub(super) struct Sampling<'a> {
    view: &'a EmitterView<'a>,
    occluders: &'a Occluders,
    /// Of the weight.
    error: f64,
    rows: u32,
    rays: u64,
}

impl<'a> Sampling<'a> {
    /// Looks until the weight of what is seen is right to within `error`.
    pub(super) fn new(view: &'a EmitterView<'a>, occluders: &'a Occluders, error: f64) -> Self {
        // The mean of n cells that are either seen or not is off by half their spread over √n.
        let cells = (view.weight / (2.0 * error.max(f64::MIN_POSITIVE))).powi(2);
        let triangles = (view.polygon.len() - 2) as f64;
        let rows = (cells / triangles).sqrt().ceil().clamp(1.0, MOST_ROWS) as u32;
        Self { view, occluders, error, rows, rays: 0 }
    }

    /// Looks at cells in so many rows on each triangle, and at no others.
    pub(super) fn evenly(view: &'a EmitterView<'a>, occluders: &'a Occluders, rows: u32) -> Self {
        Self { view, occluders, error: f64::INFINITY, rows, rays: 0 }
    }

    /// What is seen, from as many cells as it takes.
    pub(super) fn run(mut self) -> Seen {
        let cells = self.first_cells();
        let whole: f64 = cells.iter().map(|cell| cell.weight).sum();
        let is_mixed = cells.iter().any(|cell| cell.seen != cells[0].seen);
        let is_open = |cell: &&EmitterCell| is_mixed && cell.is_on_border(&cells);
        let (mut open, settled): (Vec<EmitterCell>, Vec<EmitterCell>) =
            cells.iter().partition(is_open);
        let mut settled = seen_of(&settled);
        while spread(&open) > self.error && self.rays < MOST_RAYS {
            let mut next = Vec::with_capacity(2 * open.len());
            for cell in &open {
                let quarters = self.quarters(cell);
                if quarters.iter().all(|quarter| quarter.seen == cell.seen) {
                    settled += seen_of(&quarters);
                } else {
                    next.extend(quarters);
                }
            }
            open = next;
        }
        self.seen(settled + seen_of(&open), whole)
    }

    /// What is seen of the cells that there are at first.
    pub(super) fn all_cells(mut self) -> Seen {
        let cells = self.first_cells();
        let whole = cells.iter().map(|cell| cell.weight).sum();
        self.seen(seen_of(&cells), whole)
    }

    /// Cells are taken to glow evenly: together they are made to weigh what the polygon does.
    fn seen(&self, seen: f64, whole: f64) -> Seen {
        let share = if whole > 0.0 { seen / whole } else { 1.0 };
        Seen { weight: share * self.view.weight, rays: self.rays }
    }

    fn first_cells(&mut self) -> Vec<EmitterCell> {
        let (polygon, rows) = (&self.view.polygon, self.rows);
        let triangles = (1..polygon.len() - 1).map(|k| [polygon[0], polygon[k], polygon[k + 1]]);
        triangles.flat_map(|triangle| rows_of(triangle, rows)).map(|c| self.cell(c)).collect()
    }

    fn cell(&mut self, corners: [DVec3; 3]) -> EmitterCell {
        self.rays += 1;
        let middle = corners.iter().sum::<DVec3>() / 3.0;
        let seen = self.view.sees(self.occluders, middle);
        EmitterCell { corners, weight: self.view.weight_of(&corners), seen }
    }

    /// The quarters of a cell; the middle one has the cell's own ray.
    fn quarters(&mut self, cell: &EmitterCell) -> [EmitterCell; 4] {
        let [a, b, c] = cell.corners;
        let [d, e, f] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
        let middle = [d, e, f];
        let weight = self.view.weight_of(&middle);
        let own = EmitterCell { corners: middle, weight, seen: cell.seen };
        [self.cell([a, d, f]), self.cell([d, b, e]), self.cell([f, e, c]), own]
    }
}

impl EmitterCell {
    /// True if one of the cells that have an edge in common with it is seen and the other is not.
    fn is_on_border(&self, cells: &[Self]) -> bool {
        let near = 1e-6 * self.corners[0].distance(self.corners[1]);
        let holds = |other: &Self, corner: &DVec3| {
            other.corners.iter().any(|&p| p.distance_squared(*corner) <= near * near)
        };
        let touches =
            |other: &Self| self.corners.iter().filter(|corner| holds(other, corner)).count() >= 2;
        cells.iter().any(|other| other.seen != self.seen && touches(other))
    }
}

fn seen_of(cells: &[EmitterCell]) -> f64 {
    cells.iter().filter(|cell| cell.seen).map(|cell| cell.weight).sum()
}

/// Standard deviation of what is seen of cells through which a border runs anywhere: that of even numbers.
fn spread(cells: &[EmitterCell]) -> f64 {
    (cells.iter().map(|cell| cell.weight * cell.weight).sum::<f64>() / 12.0).sqrt()
}

/// Equal triangles in so many rows that make up one.
fn rows_of([a, b, c]: [DVec3; 3], rows: u32) -> impl Iterator<Item = [DVec3; 3]> {
    let (u, v) = ((b - a) / f64::from(rows), (c - a) / f64::from(rows));
    let places = (0..rows).flat_map(move |row| (0..rows - row).map(move |column| (row, column)));
    places.flat_map(move |(row, column)| {
        let corner = a + u * f64::from(column) + v * f64::from(row);
        let between = (column + row + 1 < rows).then(|| [corner + u, corner + u + v, corner + v]);
        [Some([corner, corner + u, corner + v]), between].into_iter().flatten()
    })
}
