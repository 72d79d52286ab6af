//! Delta form factors: the share of the hemisphere, cosine-weighted, that a cell of the hemicube fills.

use std::f64::consts::PI;

/// Delta form factors of all cells, row by row: the top face's rows, then those of the four half faces.
///
/// With cells of area ΔA at (x, y, 1) on the top and at (±1, y, z) on a side,
/// ΔF = ΔA / π(x² + y² + 1)² on the top and z ΔA / π(y² + z² + 1)² on the sides ([Cohen and
/// Greenberg 1985]), scaled so that they sum to one, from which the midpoint rule differs by about
/// 0.5 / resolution².
///
/// [Cohen and Greenberg 1985]: https://doi.org/10.1145/325334.325171
#[derive(Clone, Debug)]
pub struct DeltaFactors {
    resolution: usize,
    cells: Vec<f32>,
    /// For each row of the top and of one half face, the sums over its first 0, 1, …, `resolution`
    /// cells.
    sums: Vec<f32>,
    /// Of the top and of the half faces.
    profiles: [DeltaProfile; 2],
}

/// What the factors of a face's cells are computed from: they are `scale / (x² + y² + 1)²`, all linear
/// in the column or the row, as coefficients of 1 and of these.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeltaProfile {
    /// Position along a row, by the column.
    pub(super) x: [f32; 2],
    /// Position across the rows, by the row.
    pub(super) y: [f32; 2],
    /// By the row: the same everywhere on the top, with the height on the half faces.
    pub(super) scale: [f32; 2],
}

impl DeltaFactors {
    /// The factors of a hemicube with `resolution` cells, an even number, along the top face's edges.
    pub fn new(resolution: usize) -> Self {
        let step = 2.0 / resolution as f64;
        let at = |k: usize| (k as f64 + 0.5) * step;
        let top = (0..resolution).flat_map(|row| {
            let y = at(row) - 1.0;
            (0..resolution).map(move |column| {
                let x = at(column) - 1.0;
                step * step / (PI * (x * x + y * y + 1.0).powi(2))
            })
        });
        let side = (0..resolution / 2).flat_map(|row| {
            let z = at(row);
            (0..resolution).map(move |column| {
                let y = at(column) - 1.0;
                z * step * step / (PI * (y * y + z * z + 1.0).powi(2))
            })
        });
        let side: Vec<f64> = side.collect();
        let mut cells: Vec<f64> = top.collect();
        for _ in 0..4 {
            cells.extend(&side);
        }
        let total: f64 = cells.iter().sum();
        let unlike = resolution + resolution / 2;
        let sums = cells.chunks_exact(resolution).take(unlike).flat_map(|row| {
            let running = row.iter().scan(0.0, |sum, cell| {
                *sum += cell;
                Some(*sum)
            });
            std::iter::once(0.0).chain(running)
        });
        let area = step * step / (PI * total);
        let profile = |lowest: f64, scale: [f64; 2]| {
            let [x, y] = [-1.0, lowest].map(|first| [first + 0.5 * step, step]);
            let [x, y, scale] = [x, y, scale].map(|line| line.map(|value| value as f32));
            DeltaProfile { x, y, scale }
        };
        Self {
            resolution,
            profiles: [profile(-1.0, [area, 0.0]), profile(0.0, [0.5 * step * area, step * area])],
            sums: sums.map(|sum| (sum / total) as f32).collect(),
            cells: cells.iter().map(|cell| (cell / total) as f32).collect(),
        }
    }

    /// Cells along the edges of the top face.
    #[inline]
    pub fn resolution(&self) -> usize {
        self.resolution
    }

    /// One factor per cell, `3 * resolution * resolution`.
    pub fn cells(&self) -> &[f32] {
        &self.cells
    }

    /// Factors of the cells in a row of a face.
    #[inline(always)]
    pub(super) fn row(&self, face: usize, row: usize) -> &[f32] {
        let first = self.first_row(face) + row;
        &self.cells[first * self.resolution..(first + 1) * self.resolution]
    }

    /// What the factors of the cells of a face are computed from.
    #[inline(always)]
    pub(super) fn profile(&self, face: usize) -> DeltaProfile {
        self.profiles[usize::from(face != 0)]
    }

    /// Sums over the first 0, 1, …, `resolution` cells in a row of a face.
    #[inline(always)]
    pub(super) fn sums(&self, face: usize, row: usize) -> &[f32] {
        let first = (self.first_row(face) + row) * (self.resolution + 1);
        &self.sums[first..=first + self.resolution]
    }

    /// First row of the faces like this one; the half faces are all alike.
    #[inline(always)]
    fn first_row(&self, face: usize) -> usize {
        if face == 0 { 0 } else { self.resolution }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delta_factors_sum_to_one() {
        for resolution in [32, 64, 256] {
            let delta = DeltaFactors::new(resolution);
            assert_eq!(delta.cells().len(), 3 * resolution * resolution, "cells");
            let total: f64 = delta.cells().iter().map(|&cell| f64::from(cell)).sum();
            assert!((total - 1.0).abs() < 1e-5, "{total}");
        }
    }

    #[test]
    fn profiles_are_what_the_factors_are_computed_from() {
        let delta = DeltaFactors::new(64);
        for (face, rows) in [64, 32, 32, 32, 32].into_iter().enumerate() {
            let DeltaProfile { x, y, scale } = delta.profile(face);
            for row in 0..rows {
                for (column, cell) in delta.row(face, row).iter().enumerate() {
                    let along = |[origin, step]: [f32; 2], at: usize| origin + step * at as f32;
                    let (x, y) = (along(x, column), along(y, row));
                    let factor = along(scale, row) / (x * x + y * y + 1.0).powi(2);
                    assert!((factor / cell - 1.0).abs() < 1e-5, "{factor} for {cell}");
                }
            }
        }
    }

    #[test]
    fn half_the_light_passes_within_45_degrees_so_the_top_gets_its_closed_form() {
        let delta = DeltaFactors::new(512);
        let top: f64 = delta.cells()[..512 * 512].iter().map(|&cell| f64::from(cell)).sum();
        // Four times the closed form of a unit square seen from below its corner at distance 1.
        let exact = 4.0 / (PI * 2.0_f64.sqrt()) * (1.0 / 2.0_f64.sqrt()).atan();
        assert!((top - exact).abs() < 1e-5, "{top} for {exact}");
    }
}
