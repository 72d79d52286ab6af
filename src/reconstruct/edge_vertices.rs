//! Finds the places in the middle of edges, so that no vertex is left hanging: neither
//! within a surface nor where surfaces meet.

use std::collections::HashMap;

use glam::DVec3;

use crate::geometry::Weld;

/// Cells along the scene's diagonal; an edge passes few of them.
const CELLS: f64 = 160.0;

/// The corners of all leaves, each place once, found by where they are.
#[derive(Debug)]
pub(crate) struct Places {
    points: Vec<DVec3>,
    cells: HashMap<[i32; 3], Vec<u32>>,
    cell_size: f64,
    epsilon: f64,
}

impl Places {
    pub(crate) fn new(weld: &Weld, extent: f64, epsilon: f64) -> Self {
        let points = weld.places().to_vec();
        let mut places = Self { points, cells: HashMap::new(), cell_size: extent / CELLS, epsilon };
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

    /// The places strictly between two others, in their order from `a` to `b`; the same ones from `b` to `a`.
    pub(crate) fn between(&self, a: u32, b: u32) -> Vec<u32> {
        if a > b {
            let mut back = self.between(b, a);
            back.reverse();
            return back;
        }
        let (from, to) = (self.at(a), self.at(b));
        let length = from.distance(to);
        let along = (to - from) / length;
        let mut near = self.beside(from, to);
        near.retain(|&place| place != a && place != b);
        let mut measured: Vec<_> = near
            .into_iter()
            .map(|place| {
                let offset = self.at(place) - from;
                let position = offset.dot(along);
                ((offset - along * position).length(), position, place)
            })
            .filter(|&(aside, ..)| aside <= self.epsilon)
            .collect();
        measured.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.2.cmp(&y.2)));
        // What is more aside of the edge than along it, seen from one that is on it, would fold the edge.
        let mut found = vec![(0.0, a), (length, b)];
        for (aside, position, place) in measured {
            let next =
                found.partition_point(|&(known, _)| known < position).clamp(1, found.len() - 1);
            if position - found[next - 1].0 >= aside && found[next].0 - position >= aside {
                found.insert(next, (position, place));
            }
        }
        found[1..found.len() - 1].iter().map(|&(_, place)| place).collect()
    }

    /// The places in the cells that an edge passes.
    fn beside(&self, from: DVec3, to: DVec3) -> Vec<u32> {
        let margin = DVec3::splat(self.epsilon);
        let low = cell((from.min(to) - margin) / self.cell_size);
        let high = cell((from.max(to) + margin) / self.cell_size);
        self.within(low, high).collect()
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
