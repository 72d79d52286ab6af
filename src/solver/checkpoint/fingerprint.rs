//! Whether two things are the same.

use std::io::BufWriter;

use serde::Serialize;
use sha2::{Digest, Sha256};

/// SHA-256 of something in serialised form (postcard); numbers count to their last bit.
pub(super) fn of(subject: &impl Serialize) -> [u8; 32] {
    let mut digest = Sha256::new();
    // Neither digesting nor what derived serialisation does can fail; a sequence of unknown length could not be told.
    let _ = postcard::to_io(subject, BufWriter::new(&mut digest));
    digest.finalize().into()
}
