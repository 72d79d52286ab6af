//! The form factors between all patches, as a sparse matrix.

mod laws;

/// Form factors between n patches, row by row, without those that are zero.
///
/// `F[i][j]`, 0..=1, is the share of the light leaving patch i that arrives at patch j.
#[derive(Clone, Debug, PartialEq)]
pub struct FormFactors {
    /// Area of each patch, m².
    areas: Vec<f64>,
    /// Where each row begins in the two lists below; one more than there are rows.
    starts: Vec<usize>,
    columns: Vec<u32>,
    factors: Vec<f64>,
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
}
