//! Bytes as text.

use ::base64::Engine as _;
use ::base64::engine::general_purpose::STANDARD;

/// `bytes` in base64, padded.
pub(super) fn coded(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

/// A PNG as an address that holds the picture itself.
pub(super) fn png_address(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", coded(png))
}
