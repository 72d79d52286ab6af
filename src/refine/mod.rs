//! The oracle: whether interpolation across an element is good enough, and if not, where to divide it.
//!
//! Interpolated values are compared with values evaluated afresh: at the midpoints of the edges, at
//! the centre, and, for direct light, at probes in between, so that a small shadow is not
//! overlooked.

mod level;
mod sample;

mod oracle;

mod events;
mod lines;

pub use level::mean_radiosity;
pub use lines::{Discontinuity, LineSearch, cut};
pub use oracle::{Oracle, reason, tolerated_direct};
pub use sample::Sample;
