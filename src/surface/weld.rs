//! Places told apart by a tolerance, so that rounding never makes two of one.

use std::collections::HashMap;

use glam::DVec3;
use smallvec::SmallVec;

/// Numbers places in the order in which they are first seen.
#[derive(Clone, Debug)]
pub struct Weld {
    tolerance: f64,
    cells: HashMap<[i64; 3], SmallVec<[u32; 2]>>,
    places: Vec<DVec3>,
}

impl Weld {
    /// An empty set of places; points within `tolerance` of each other, m, will count as one.
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance, cells: HashMap::new(), places: Vec::new() }
    }

    /// The number of the place at `point`, a new one if none is near.
    pub fn number(&mut self, point: DVec3) -> u32 {
        self.find(point).unwrap_or_else(|| {
            let number = self.places.len() as u32;
            self.places.push(point);
            self.cells.entry(self.cell(point)).or_default().push(number);
            number
        })
    }

    /// The number of the place at `point`, if it was seen before.
    pub fn find(&self, point: DVec3) -> Option<u32> {
        // Cells are many tolerances wide, so nearly always only one of the eight is looked at.
        let reach = DVec3::splat(self.tolerance);
        let (low, high) = (self.cell(point - reach), self.cell(point + reach));
        let cells = (low[0]..=high[0]).flat_map(|x| {
            (low[1]..=high[1]).flat_map(move |y| (low[2]..=high[2]).map(move |z| [x, y, z]))
        });
        cells
            .filter_map(|cell| self.cells.get(&cell))
            .flatten()
            .copied()
            .find(|&number| self.is_at(number, point))
    }

    /// The places, in the order of their numbers, m.
    pub fn places(&self) -> &[DVec3] {
        &self.places
    }

    fn is_at(&self, number: u32, point: DVec3) -> bool {
        self.places[number as usize].distance(point) <= self.tolerance
    }

    fn cell(&self, point: DVec3) -> [i64; 3] {
        (point / (self.tolerance * 4.0)).floor().to_array().map(|x| x as i64)
    }
}
