//! Finds the places of vertices near another place, whatever surface they are on.

use glam::DVec3;

use crate::geometry::{Cells, Weld, cell_key, cells_around};

/// Places of vertices in space, each once.
#[derive(Clone, Debug)]
pub(super) struct Landmarks {
    places: Weld,
    /// Numbers of places, by cells for the farthest that one is looked for.
    cells: Cells,
    /// The farthest that a place is looked for, m.
    farthest: f64,
    /// How many vertices of the mesh are known: they are told when the first is looked for.
    pub(super) marked: usize,
}

impl Landmarks {
    /// None yet; those less than a epsilon apart, m, will be one, and none will be looked for beyond the `farthest`, m.
    pub(super) fn new(epsilon: f64, farthest: f64) -> Self {
        Self { places: Weld::new(epsilon), cells: Cells::default(), farthest, marked: 0 }
    }

    pub(super) fn add(&mut self, place: DVec3) {
        let known = self.places.places().len();
        let number = self.places.number(place);
        if number as usize == known {
            self.cells.add(cell_key(0, place, self.farthest), number);
        }
    }

    /// Those not farther from a place than `reach`, m, in the order of cells and then of their numbers.
    pub(super) fn within(&self, reach: f64, place: DVec3) -> impl Iterator<Item = DVec3> + '_ {
        let numbers = cells_around(0, place, self.farthest).flat_map(|key| self.cells.of(key));
        let places = numbers.map(|number| self.places.places()[number as usize]);
        let reach = reach.min(self.farthest);
        places.filter(move |other| other.distance(place) <= reach)
    }
}
