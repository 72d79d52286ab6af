//! Places told apart by a epsilon, so that rounding never makes two of one.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use glam::DVec3;

/// Numbers places in the order in which they are first seen.
#[derive(Clone, Debug)]
pub struct Weld {
    epsilon: f64,
    cells: Cells,
    places: Vec<DVec3>,
}

impl Weld {
    /// An empty set of places; points within `epsilon` of each other, m, will count as one.
    pub fn new(epsilon: f64) -> Self {
        Self { epsilon, cells: Cells::default(), places: Vec::new() }
    }

    /// The number of the place at `point`, a new one if none is near.
    pub fn number(&mut self, point: DVec3) -> u32 {
        self.find(point).unwrap_or_else(|| {
            let number = self.places.len() as u32;
            self.places.push(point);
            self.cells.add(cell_key(0, point, self.epsilon), number);
            number
        })
    }

    /// The number of the place at `point`, if it was seen before.
    pub fn find(&self, point: DVec3) -> Option<u32> {
        let numbers = cells_around(0, point, self.epsilon).flat_map(|key| self.cells.of(key));
        numbers.into_iter().find(|&number| self.is_at(number, point))
    }

    /// The places, in the order of their numbers, m.
    pub fn places(&self) -> &[DVec3] {
        &self.places
    }

    fn is_at(&self, number: u32, point: DVec3) -> bool {
        self.places[number as usize].distance(point) <= self.epsilon
    }
}

/// Numbers by cells of space: few bytes each, however many of them there are.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cells {
    /// The first in each cell, by a key of the cell.
    first: HashMap<u64, u32, BuildHasherDefault<Mixed>>,
    /// The next in the same cell, by number.
    next: Vec<u32>,
}

/// After the last.
const NONE: u32 = u32::MAX;

impl Cells {
    /// Adds a number higher than all before it.
    pub(crate) fn add(&mut self, key: u64, number: u32) {
        self.next.resize(number as usize + 1, NONE);
        let mut last = *self.first.entry(key).or_insert(number);
        while last != number {
            let next = &mut self.next[last as usize];
            if *next == NONE {
                *next = number;
            }
            last = *next;
        }
    }

    /// The numbers in the cell with this key, in rising order. Another cell may have the same key.
    pub(crate) fn of(&self, key: u64) -> impl Iterator<Item = u32> + '_ {
        let next = |&number: &u32| Some(self.next[number as usize]).filter(|&next| next != NONE);
        std::iter::successors(self.first.get(&key).copied(), next)
    }
}

/// A key of the cell around a point on one of several sheets, in a grid for this epsilon, m.
pub(crate) fn cell_key(sheet: u32, point: DVec3, epsilon: f64) -> u64 {
    key(sheet, cell(point, epsilon))
}

/// Keys of the cells with all places within the epsilon, m, of a point.
pub(crate) fn cells_around(sheet: u32, point: DVec3, epsilon: f64) -> impl Iterator<Item = u64> {
    // Cells are many epsilons wide, so nearly always only one of the eight is looked at.
    let reach = DVec3::splat(epsilon);
    let (low, high) = (cell(point - reach, epsilon), cell(point + reach, epsilon));
    (low[0]..=high[0]).flat_map(move |x| {
        (low[1]..=high[1]).flat_map(move |y| (low[2]..=high[2]).map(move |z| key(sheet, [x, y, z])))
    })
}

fn cell(point: DVec3, epsilon: f64) -> [i64; 3] {
    (point / (epsilon * 4.0)).floor().to_array().map(|x| x as i64)
}

fn key(sheet: u32, cell: [i64; 3]) -> u64 {
    // The odd number nearest to 2⁶⁴ over the golden ratio (Knuth 1973, multiplicative hashing).
    const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
    let mix = |key: u64, part: i64| {
        let mixed = (key ^ part as u64).wrapping_mul(GOLDEN);
        mixed ^ mixed >> 32
    };
    cell.into_iter().fold(mix(0, i64::from(sheet)), mix).wrapping_mul(GOLDEN)
}

/// Takes keys for their own hashes: they are mixed already.
#[derive(Clone, Copy, Debug, Default)]
struct Mixed(u64);

impl Hasher for Mixed {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |hash, &byte| hash << 8 ^ u64::from(byte));
    }

    fn write_u64(&mut self, key: u64) {
        self.0 = key;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_place_is_the_first_seen_near_it(points in prop::collection::vec(prop::array::uniform3(0..9_i32), 1..80)) {
            // Exact steps of 0.6 epsilons: neighbours count as one, the next ones do not.
            let mut weld = Weld::new(1.0);
            let mut places: Vec<DVec3> = Vec::new();
            for point in points {
                let point = 0.6 * DVec3::from(point.map(f64::from));
                let near: Vec<usize> =
                    (0..places.len()).filter(|&k| places[k].distance(point) <= 1.0).collect();
                let number = weld.number(point) as usize;
                prop_assert!(near.contains(&number) || (near.is_empty() && number == places.len()));
                if near.is_empty() {
                    places.push(point);
                }
            }
            prop_assert_eq!(weld.places(), &places[..]);
        }
    }

    #[test]
    fn numbers_in_a_cell_are_told_in_rising_order() {
        let mut cells = Cells::default();
        for number in [0, 1, 4, 7, 8] {
            cells.add(u64::from(number % 3), number);
        }
        assert_eq!(cells.of(1).collect::<Vec<_>>(), [1, 4, 7]);
        assert_eq!(cells.of(2).collect::<Vec<_>>(), [8]);
        assert_eq!(cells.of(5).count(), 0);
    }
}
