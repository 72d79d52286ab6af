//! How far a matrix is from the laws of form factors, and a matrix that keeps them.

use super::sparse::FormFactors;

/// Factors below this have no say in [`FormFactors::reciprocity`].
const LEAST: f64 = 1e-4;

/// Relative difference of row sums below which [`FormFactors::enforced`] is done.
const DONE: f64 = 1e-12;

/// Most rounds of scaling; rooms take some tens.
const MOST_ROUNDS: usize = 10_000;

impl FormFactors {
    /// Sum over each row: 1 in a closed room.
    pub fn row_sums(&self) -> Vec<f64> {
        (0..self.len()).map(|i| self.row(i).map(|(_, factor)| factor).sum()).collect()
    }

    /// Largest difference of `A[i] F[i][j]` and `A[j] F[j][i]` as a share of the larger of the two, over
    /// pairs with a factor above 1e-4.
    pub fn reciprocity(&self) -> f64 {
        let mut worst = 0.0_f64;
        for i in 0..self.len() {
            for (j, factor) in self.row(i).filter(|&(_, factor)| factor > LEAST) {
                let there = self.areas[i] * factor;
                let back = self.areas[j] * self.get(j, i);
                worst = worst.max((there - back).abs() / there.max(back));
            }
        }
        worst
    }

    /// A matrix near this one that is reciprocal and whose rows sum to `sums`.
    ///
    /// The exchanges `A[i] F[i][j]` and `A[j] F[j][i]` are replaced by their mean; then rows and columns are scaled by
    /// the same factors until all sums fit ([Sinkhorn and Knopp 1967], on a symmetric matrix). What
    /// was zero stays zero and nothing becomes negative; with sums up to one, no exchange exceeds
    /// the smaller of the two areas.
    ///
    /// [Sinkhorn and Knopp 1967]: https://doi.org/10.2140/pjm.1967.21.343
    pub fn enforced(&self, sums: &[f64]) -> Self {
        let exchanges = self.symmetric();
        let mut scale = vec![1.0; self.len()];
        for _ in 0..MOST_ROUNDS {
            let mut worst = 0.0_f64;
            let ratios: Vec<f64> = (0..self.len())
                .map(|i| {
                    let sum: f64 = exchanges.row(i).map(|(j, value)| value * scale[j]).sum();
                    let ratio = self.areas[i] * sums[i] / (scale[i] * sum);
                    if ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 }
                })
                .collect();
            for (scale, ratio) in scale.iter_mut().zip(ratios) {
                worst = worst.max((ratio - 1.0).abs());
                // Half of the way: the column's scaling does the other.
                *scale *= ratio.sqrt();
            }
            if worst < DONE {
                break;
            }
        }
        let row = |i: usize| {
            let scale = &scale;
            let value = move |(j, value): (usize, f64)| {
                (j as u32, scale[i] * scale[j] * value / self.areas[i])
            };
            exchanges.row(i).map(value).collect::<Vec<_>>()
        };
        Self::from_rows(self.areas.clone(), (0..self.len()).map(row))
    }

    /// Means of the exchanges `A[i] F[i][j]` and `A[j] F[j][i]`, m², in place of factors.
    fn symmetric(&self) -> Self {
        let mut rows = vec![Vec::new(); self.len()];
        for i in 0..self.len() {
            for (j, factor) in self.row(i) {
                let there = self.areas[i] * factor;
                let back = self.areas[j] * self.get(j, i);
                if j >= i || back == 0.0 {
                    let mean = 0.5 * (there + back);
                    rows[i].push((j as u32, mean));
                    if i != j {
                        rows[j].push((i as u32, mean));
                    }
                }
            }
        }
        rows.iter_mut().for_each(|row| row.sort_unstable_by_key(|&(column, _)| column));
        Self::from_rows(self.areas.clone(), rows)
    }

    /// The matrix of larger patches: `group[i]` says which of `count` patches `i` is a part of.
    pub fn grouped(&self, group: &[usize], count: usize) -> Self {
        let mut areas = vec![0.0; count];
        let mut exchanges = vec![std::collections::BTreeMap::<u32, f64>::new(); count];
        for (i, &to) in group.iter().enumerate() {
            areas[to] += self.areas[i];
            for (j, factor) in self.row(i) {
                *exchanges[to].entry(group[j] as u32).or_default() += self.areas[i] * factor;
            }
        }
        let rows = exchanges.into_iter().zip(&areas).map(|(row, &area)| {
            row.into_iter().map(move |(column, value)| (column, value / area)).collect::<Vec<_>>()
        });
        Self::from_rows(areas.clone(), rows.collect::<Vec<_>>())
    }
}
