//! Refinement: elements are divided where interpolation across them is not good enough.
//!
//! [`refine`] is the loop, the [`Oracle`] judges.
//!
//! Interpolated values are compared with values evaluated afresh: at the midpoints of the edges, at
//! the centre, and, for direct light, at probes in between, so that a small shadow is not
//! overlooked.

mod mean;
mod sample;

mod oracle;

mod cycles;

mod events;
mod lines;

pub use cycles::{Refinement, refine};
pub use lines::{Discontinuity, LineSearch, cut};
pub use mean::mean_radiosity;
pub use oracle::{Oracle, tolerated_direct};
pub use sample::Sample;
