//! The form factors between all patches, as a sparse matrix.

/// Form factors between n patches, row by row, without those that are zero.
///
/// `F[i][j]`, 0..=1, is the share of the light leaving patch i that arrives at patch j.
#[derive(Clone, Debug, PartialEq)]
pub struct FormFactors {
    /// Area of each patch, m².
    pub(super) areas: Vec<f64>,
    /// Where each row begins in the two lists below; one more than there are rows.
    pub(super) starts: Vec<usize>,
    pub(super) columns: Vec<u32>,
    pub(super) factors: Vec<f64>,
}

impl FormFactors {
    /// From the patches' areas, m², and as many rows of (column, factor), columns ascending.
    pub fn from_rows(
        areas: Vec<f64>,
        rows: impl IntoIterator<Item = impl IntoIterator<Item = (u32, f64)>>,
    ) -> Self {
        let (mut starts, mut columns, mut factors) = (vec![0], Vec::new(), Vec::new());
        for row in rows {
            for (column, factor) in row.into_iter().filter(|&(_, factor)| factor != 0.0) {
                columns.push(column);
                factors.push(factor);
            }
            starts.push(columns.len());
        }
        assert_eq!(starts.len(), areas.len() + 1, "one row for each patch");
        Self { areas, starts, columns, factors }
    }

    /// From the patches' areas, m², and rows of exchanges `A[i] F[i][j]`, m², above the diagonal: (column,
    /// exchange), columns ascending. Only the first `done` rows of the matrix are filled.
    ///
    /// Takes hardly more memory than the matrix and the exchanges.
    pub(in crate::form_factor) fn from_exchanges(
        areas: Vec<f64>,
        above: Vec<Vec<(u32, f64)>>,
        done: usize,
    ) -> Self {
        let is_some = |&(_, exchange): &(u32, f64)| exchange != 0.0;
        let mut starts = vec![0; areas.len() + 1];
        for (i, row) in above[..done].iter().enumerate() {
            for &(j, _) in row.iter().filter(|entry| is_some(entry)) {
                starts[i + 1] += 1;
                starts[j as usize + 1] += usize::from((j as usize) < done);
            }
        }
        for i in 0..areas.len() {
            starts[i + 1] += starts[i];
        }
        let (mut columns, mut factors) =
            (vec![0; starts[areas.len()]], vec![0.0; starts[areas.len()]]);
        let mut next = starts.clone();
        let mut put = |i: usize, j: usize, exchange: f64| {
            columns[next[i]] = j as u32;
            factors[next[i]] = exchange / areas[i];
            next[i] += 1;
        };
        // Each row is dropped once it is spread. What rows above put into one comes first in it.
        for (i, row) in above.into_iter().enumerate().take(done) {
            for (j, exchange) in row.into_iter().filter(is_some) {
                put(i, j as usize, exchange);
                if (j as usize) < done {
                    put(j as usize, i, exchange);
                }
            }
        }
        Self { areas, starts, columns, factors }
    }

    /// Number of patches.
    pub fn len(&self) -> usize {
        self.areas.len()
    }

    /// True if there are no patches.
    pub fn is_empty(&self) -> bool {
        self.areas.is_empty()
    }

    /// Areas of the patches, m².
    pub fn areas(&self) -> &[f64] {
        &self.areas
    }

    /// The factors above zero from patch `i`, as (j, `F[i][j]`), j ascending.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let entries = self.starts[i]..self.starts[i + 1];
        let columns = self.columns[entries.clone()].iter().map(|&column| column as usize);
        columns.zip(self.factors[entries].iter().copied())
    }

    /// `F[i][j]`.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let entries = self.starts[i]..self.starts[i + 1];
        let found = self.columns[entries.clone()].binary_search(&(j as u32));
        found.map_or(0.0, |k| self.factors[entries.start + k])
    }

    /// The matrix with rows for columns.
    pub fn transposed(&self) -> Self {
        let mut rows = vec![Vec::new(); self.len()];
        for i in 0..self.len() {
            self.row(i).for_each(|(j, factor)| rows[j].push((i as u32, factor)));
        }
        Self::from_rows(self.areas.clone(), rows)
    }
}
