//! Finds the places in the middle of edges, so that no vertex is left hanging: neither
//! within a surface nor where surfaces meet.

use std::collections::HashMap;

use glam::DVec3;

use crate::surface::Weld;

/// Cells along the scene's diagonal; an edge passes few of them.
const CELLS: f64 = 160.0;

/// By how much of the way from the nearer end a place on an edge may be aside of it.
const SLOPE: f64 = 0.1;

/// The corners of all leaves, each place once, found by where they are.
#[derive(Debug)]
pub(crate) struct Places {
    points: Vec<DVec3>,
    cells: HashMap<[i32; 3], Vec<u32>>,
    cell_size: f64,
    tolerance: f64,
}

impl Places {
    pub(crate) fn new(weld: &Weld, extent: f64, tolerance: f64) -> Self {
        let points = weld.places().to_vec();
        let mut places =
            Self { points, cells: HashMap::new(), cell_size: extent / CELLS, tolerance };
        for (number, &point) in places.points.iter().enumerate() {
            let cell = cell(point / places.cell_size);
            places.cells.entry(cell).or_default().push(number as u32);
        }
        places
    }

    /// Where a place is, m.
    pub(crate) fn at(&self, place: u32) -> DVec3 {
        self.points[place as usize]
    }

    /// The places strictly between two others, in their order from `a` to `b`.
    pub(crate) fn between(&self, a: u32, b: u32) -> Vec<u32> {
        let (from, to) = (self.at(a), self.at(b));
        let length = from.distance(to);
        let along = (to - from) / length;
        let margin = DVec3::splat(self.tolerance);
        let low = cell((from.min(to) - margin) / self.cell_size);
        let high = cell((from.max(to) + margin) / self.cell_size);
        let measured = |place: u32| {
            let offset = self.at(place) - from;
            let position = offset.dot(along);
            let aside = (offset - along * position).length();
            // Beside an end, what is on another edge from there must not count.
            let most = self.tolerance.min(SLOPE * position.min(length - position));
            let between = place != a && place != b && aside <= most;
            between.then_some((position, place))
        };
        let mut found: Vec<(f64, u32)> = self.within(low, high).filter_map(measured).collect();
        found.sort_by(|x, y| x.0.total_cmp(&y.0));
        found.into_iter().map(|(_, place)| place).collect()
    }

    /// The places in a box of cells, or all of them where that is the shorter way: a plain round a house has
    /// more cells than there are places.
    fn within(&self, low: [i32; 3], high: [i32; 3]) -> Box<dyn Iterator<Item = u32> + '_> {
        let count = |axis: usize| f64::from(high[axis]) - f64::from(low[axis]) + 1.0;
        if count(0) * count(1) * count(2) > self.points.len() as f64 {
            return Box::new(0..self.points.len() as u32);
        }
        let cells = (low[0]..=high[0]).flat_map(move |x| {
            (low[1]..=high[1]).flat_map(move |y| (low[2]..=high[2]).map(move |z| [x, y, z]))
        });
        Box::new(cells.filter_map(|cell| self.cells.get(&cell)).flatten().copied())
    }
}

fn cell(scaled: DVec3) -> [i32; 3] {
    scaled.floor().to_array().map(|x| x as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_edge_in_a_fine_grid_finds_its_places_at_once() {
        let mut weld = Weld::new(1e-6);
        let along = DVec3::new(3e5, 2e5, 1e5);
        for share in [0.0, 0.75, 0.5, 1.0] {
            weld.number(along * share);
        }
        weld.number(DVec3::ONE);
        assert_eq!(Places::new(&weld, 1.0, 1e-6).between(0, 3), [2, 1]);
    }
}
