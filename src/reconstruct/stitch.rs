//! Finds the places in the middle of edges, so that no vertex is left hanging: neither
//! within a surface nor where surfaces meet.

use std::collections::HashMap;

use glam::DVec3;

use crate::surface::Weld;

/// Cells along the scene's diagonal; an edge passes few of them.
const CELLS: f64 = 160.0;

/// The corners of all leaves, each place once, found by where they are.
#[derive(Debug)]
pub(super) struct Places {
    points: Vec<DVec3>,
    cells: HashMap<[i32; 3], Vec<u32>>,
    cell_size: f64,
    tolerance: f64,
}

impl Places {
    pub(super) fn new(weld: &Weld, extent: f64, tolerance: f64) -> Self {
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
    pub(super) fn at(&self, place: u32) -> DVec3 {
        self.points[place as usize]
    }

    /// The places strictly between two others, in their order from `a` to `b`.
    pub(super) fn between(&self, a: u32, b: u32) -> Vec<u32> {
        let (from, to) = (self.at(a), self.at(b));
        let length = from.distance(to);
        let along = (to - from) / length;
        let margin = DVec3::splat(self.tolerance);
        let low = cell((from.min(to) - margin) / self.cell_size);
        let high = cell((from.max(to) + margin) / self.cell_size);
        let mut found: Vec<(f64, u32)> = Vec::new();
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    for &place in self.cells.get(&[x, y, z]).into_iter().flatten() {
                        let offset = self.at(place) - from;
                        let position = offset.dot(along);
                        let aside = (offset - along * position).length();
                        let inside =
                            position > self.tolerance && position < length - self.tolerance;
                        if place != a && place != b && inside && aside <= self.tolerance {
                            found.push((position, place));
                        }
                    }
                }
            }
        }
        found.sort_by(|x, y| x.0.total_cmp(&y.0));
        found.into_iter().map(|(_, place)| place).collect()
    }
}

fn cell(scaled: DVec3) -> [i32; 3] {
    scaled.floor().to_array().map(|x| x as i32)
}
