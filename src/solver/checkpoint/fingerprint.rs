//! Whether two things are the same.

use std::fmt::{self, Debug, Write};

use sha2::{Digest, Sha256};

/// SHA-256 of all that something says of itself; numbers count to their last bit.
pub(super) fn of(subject: &impl Debug) -> [u8; 32] {
    let mut digest = Digesting(Sha256::new());
    // Digesting never fails, and neither do the derived descriptions.
    let _ = write!(digest, "{subject:?}");
    digest.0.finalize().into()
}

/// Takes in text as it comes.
struct Digesting(Sha256);

impl Write for Digesting {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text);
        Ok(())
    }
}
