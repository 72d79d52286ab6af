//! The truth for small systems: LU factors with partial pivoting.

use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};

use super::System;
use crate::colour::Rgb;
use crate::error::{Error, Result};

/// Most patches: the matrix and its factors take 24 n² bytes, and time grows with n³.
const MOST_PATCHES: usize = 5000;

impl System {
    /// Radiosities, W/m², to rounding, by LU factors with partial pivoting.
    ///
    /// # Errors
    /// When there are more than 5 000 patches.
    pub fn solve_directly(&self) -> Result<Vec<Rgb>> {
        let n = self.len();
        if n > MOST_PATCHES {
            let gigabytes = 24e-9 * (n as f64).powi(2);
            return Err(Error::Scene(format!(
                "{n} patches: their LU factors would take {gigabytes:.1} GB; \
                 use a relaxation, or at most {MOST_PATCHES} patches"
            )));
        }
        let mut radiosity = vec![Rgb::ZERO; n];
        let mut open = vec![0, 1, 2];
        while let Some(&first) = open.first() {
            let is_alike = |&channel: &usize| self.reflect_alike(first, channel);
            let (alike, others) = open.into_iter().partition::<Vec<usize>, _>(is_alike);
            let right = Mat::from_fn(n, alike.len(), |i, k| self.exitance[i][alike[k]]);
            let solved = PartialPivLu::new(self.matrix(first).as_ref()).solve(&right);
            for (k, &channel) in alike.iter().enumerate() {
                for (i, radiosity) in radiosity.iter_mut().enumerate() {
                    radiosity[channel] = solved[(i, k)];
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
    fn matrix(&self, channel: usize) -> Mat<f64> {
        let mut matrix = Mat::identity(self.len(), self.len());
        for i in 0..self.len() {
            for (j, factor) in self.factors.row(i) {
                matrix[(i, j)] -= self.reflectance[i][channel] * factor;
            }
        }
        matrix
    }
}
