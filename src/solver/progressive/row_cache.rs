//! Rows kept for later shots, as far as there is room.

use crate::solver::links::Row;

/// The rows that are there, by cluster.
pub(super) struct RowCache {
    list: Vec<Option<Row>>,
    /// How many links they have.
    links: usize,
    /// Beyond so many they are made anew.
    most: usize,
}

impl RowCache {
    /// None yet, for so many clusters; of all that follow, at most about so many links are kept.
    pub(super) fn new(clusters: usize, most: usize) -> Self {
        Self { list: vec![None; clusters], links: 0, most }
    }

    pub(super) fn has(&self, cluster: usize) -> bool {
        self.list[cluster].is_some()
    }

    /// The clusters whose rows are there.
    pub(super) fn ready(&self) -> Vec<usize> {
        (0..self.list.len()).filter(|&cluster| self.has(cluster)).collect()
    }

    /// Takes a row out, to be put back.
    pub(super) fn take(&mut self, cluster: usize) -> Row {
        self.list[cluster].take().unwrap_or_default()
    }

    pub(super) fn put_back(&mut self, cluster: usize, row: Row) {
        self.list[cluster] = Some(row);
    }

    pub(super) fn keep(&mut self, cluster: usize, row: Row) {
        self.links += row.links.len();
        self.list[cluster] = Some(row);
    }

    /// Drops all if they have become too many.
    pub(super) fn make_room(&mut self) {
        if self.links > self.most {
            self.list.fill(None);
            self.links = 0;
        }
    }
}
