//! The bytes of a viewer, each list once.

use super::base64;

/// Lists of bytes in base64, each kept once: the steps of a solution share most of their mesh.
#[derive(Debug, Default)]
pub(super) struct Chunks(pub(super) Vec<String>);

impl Chunks {
    pub(super) fn add(&mut self, bytes: &[u8]) -> usize {
        let coded = base64::coded(bytes);
        let known = self.0.iter().position(|chunk| *chunk == coded);
        known.unwrap_or_else(|| {
            self.0.push(coded);
            self.0.len() - 1
        })
    }
}
