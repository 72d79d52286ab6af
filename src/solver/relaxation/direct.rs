//! The truth for small systems: LU factors with partial pivoting.

use nalgebra::DMatrix;

use super::System;
use crate::colour::Rgb;
use crate::error::{Error, Result};

/// Most patches: the factors take 8 n² bytes, and time grows with n³.
const MOST_PATCHES: usize = 5000;

impl System {
    /// Radiosities, W/m², to rounding, by LU factors with partial pivoting.
    ///
    /// # Errors
    /// When there are more than 5 000 patches.
    pub fn solve_directly(&self) -> Result<Vec<Rgb>> {
        let n = self.len();
        if n > MOST_PATCHES {
            let gigabytes = 8e-9 * (n as f64).powi(2);
            return Err(Error::Scene(format!(
                "{n} patches: their LU factors would take {gigabytes:.1} GB; \
                 use a relaxation, or at most {MOST_PATCHES} patches"
            )));
        }
        let mut radiosity = vec![Rgb::ZERO; n];
        let mut open = if n > 0 { vec![0, 1, 2] } else { Vec::new() };
        while let Some(&first) = open.first() {
            let is_alike = |&channel: &usize| self.reflect_alike(first, channel);
            let (alike, others) = open.into_iter().partition::<Vec<usize>, _>(is_alike);
            let mut columns = DMatrix::from_fn(n, alike.len(), |i, k| self.exitance[i][alike[k]]);
            let solved = self.matrix(first).lu().solve_mut(&mut columns);
            assert!(solved, "M of channel {first} is dominated by its diagonal, and so regular");
            for (k, &channel) in alike.iter().enumerate() {
                for (i, radiosity) in radiosity.iter_mut().enumerate() {
                    radiosity[channel] = columns[(i, k)];
                }
            }
            open = others;
        }
        Ok(radiosity)
    }

    /// True if the matrices of two channels are the same.
    fn reflect_alike(&self, one: usize, other: usize) -> bool {
        self.reflectance.iter().all(|reflectance| reflectance[one] == reflectance[other])
    }

    /// M of one channel.
    fn matrix(&self, channel: usize) -> DMatrix<f64> {
        let mut matrix = DMatrix::identity(self.len(), self.len());
        for i in 0..self.len() {
            for (j, factor) in self.factors.row(i) {
                matrix[(i, j)] -= self.reflectance[i][channel] * factor;
            }
        }
        matrix
    }
}
