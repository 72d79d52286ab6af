//! Where cells are: along which directions, and on the faces laid out flat.

use glam::{DVec3, Vec3};

use super::clip::FACES;

/// Where the cells of a hemicube are, numbered as in [`DeltaFactors::cells`](super::DeltaFactors::cells) and
/// [`Hemicube::items`](super::Hemicube::items).
#[derive(Clone, Copy, Debug)]
pub struct CellLayout {
    resolution: usize,
}

/// A cell by its face, and by its row and column on that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FaceCell {
    pub(super) face: usize,
    pub(super) row: usize,
    pub(super) column: usize,
}

impl FaceCell {
    /// The cell that a direction above the horizon, in the hemicube's frame, passes through.
    pub(super) fn along(direction: Vec3, resolution: usize) -> Self {
        let depths = FACES.map(|face| face.look(direction).z);
        let face =
            (1..FACES.len()).fold(0, |best, k| if depths[k] > depths[best] { k } else { best });
        let (p, shape) = (FACES[face].look(direction), &FACES[face]);
        let half = resolution as f32 / 2.0;
        let column = ((p.x / p.z + 1.0) * half) as usize;
        let row = ((p.y / p.z - shape.lowest) * half) as usize;
        Self { face, row: row.min(shape.rows(resolution) - 1), column: column.min(resolution - 1) }
    }
}

impl CellLayout {
    /// The layout of hemicubes with `resolution` cells, an even number, along the top face's edges.
    pub fn new(resolution: usize) -> Self {
        Self { resolution }
    }

    /// Cells along the edge of the square that the faces laid out flat fit in: the top's, and two half faces' heights.
    pub fn unfolded_size(&self) -> usize {
        2 * self.resolution
    }

    /// Number of the cell in a column from the left and a row from above of the faces laid out flat: a cross with the
    /// top in its middle, seen from above with the frame's x to the right and its y up, and each half face beside the
    /// edge that it shares with the top. Beside the cross there is none.
    pub fn unfolded(&self, column: usize, row: usize) -> Option<usize> {
        let (n, half) = (self.resolution, self.resolution / 2);
        let arm = |at: usize| match at {
            at if at < half => Arm::Before(at),
            at if at < half + n => Arm::Middle(at - half),
            at if at < 2 * n => Arm::Behind(2 * n - 1 - at),
            _ => Arm::Outside,
        };
        let (face, row, column) = match (arm(column), arm(row)) {
            (Arm::Middle(x), Arm::Middle(y)) => (0, n - 1 - y, x),
            (Arm::Behind(z), Arm::Middle(y)) => (1, z, n - 1 - y),
            (Arm::Before(z), Arm::Middle(y)) => (2, z, n - 1 - y),
            (Arm::Middle(x), Arm::Before(z)) => (3, z, x),
            (Arm::Middle(x), Arm::Behind(z)) => (4, z, x),
            _ => return None,
        };
        Some(self.number(FaceCell { face, row, column }))
    }

    /// Number of the cell that a direction in the hemicube's frame, whose z is the normal, passes through; below the
    /// horizon there is none.
    pub fn along(&self, direction: DVec3) -> Option<usize> {
        let cell = || FaceCell::along(direction.as_vec3(), self.resolution);
        (direction.z > 0.0).then(|| self.number(cell()))
    }

    fn number(&self, FaceCell { face, row, column }: FaceCell) -> usize {
        let rows: usize = FACES[..face].iter().map(|face| face.rows(self.resolution)).sum();
        (rows + row) * self.resolution + column
    }
}

/// A place along one of the two bars of the cross.
enum Arm {
    /// On the first half face, with the height over its foot.
    Before(usize),
    Middle(usize),
    /// On the second half face, the same.
    Behind(usize),
    Outside,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::form_factor::hemicube::DeltaFactors;

    const RESOLUTION: usize = 16;

    #[test]
    fn each_cell_is_laid_out_once() {
        let layout = CellLayout::new(RESOLUTION);
        let size = layout.unfolded_size();
        let places = (0..size).flat_map(|row| (0..size).map(move |column| (column, row)));
        let mut cells: Vec<usize> =
            places.filter_map(|(column, row)| layout.unfolded(column, row)).collect();
        cells.sort_unstable();
        assert_eq!(cells, (0..3 * RESOLUTION * RESOLUTION).collect::<Vec<_>>());
        assert_eq!(layout.unfolded(size, 0), None);
    }

    #[test]
    fn cells_beside_each_other_on_the_cross_are_so_in_space() {
        let layout = CellLayout::new(RESOLUTION);
        let mut middles = vec![(DVec3::ZERO, 0.0); 3 * RESOLUTION * RESOLUTION];
        for direction in on_the_disc(800) {
            let middle = &mut middles[layout.along(direction).expect("above the horizon")];
            *middle = (middle.0 + direction, middle.1 + 1.0);
        }
        let size = layout.unfolded_size();
        let middle = |column, row| {
            let (sum, count) = middles[layout.unfolded(column, row)?];
            Some(sum / count)
        };
        let most = 2.2 / RESOLUTION as f64;
        for row in 0..size {
            for column in 0..size {
                let Some(here) = middle(column, row) else { continue };
                for next in [middle(column + 1, row), middle(column, row + 1)] {
                    let apart = next.map_or(0.0, |next| here.distance(next));
                    assert!(apart < most, "{apart} apart at {column}, {row}");
                }
            }
        }
    }

    /// Nusselt's analogue.
    #[test]
    fn a_delta_factor_is_the_share_of_the_disc_below_its_cell() {
        let layout = CellLayout::new(RESOLUTION);
        let delta = DeltaFactors::new(RESOLUTION);
        let mut counts = vec![0.0; delta.cells().len()];
        for direction in on_the_disc(1600) {
            counts[layout.along(direction).expect("above the horizon")] += 1.0;
        }
        let all: f64 = counts.iter().sum();
        for (cell, (&factor, count)) in delta.cells().iter().zip(counts).enumerate() {
            let error = (count / all - f64::from(factor)).abs();
            assert!(error < 3e-5, "cell {cell}: {} for {factor}", count / all);
        }
    }

    /// Directions above even points of the unit disc, this many along its diameter.
    fn on_the_disc(count: i32) -> impl Iterator<Item = DVec3> {
        let at = move |k: i32| (f64::from(2 * k + 1) / f64::from(count)) - 1.0;
        let square = (0..count * count).map(move |k| (at(k % count), at(k / count)));
        let inside = square.map(|(x, y)| (x, y, 1.0 - x * x - y * y));
        inside.filter(|&(.., z)| z > 0.0).map(|(x, y, z)| DVec3::new(x, y, z.sqrt()))
    }
}
