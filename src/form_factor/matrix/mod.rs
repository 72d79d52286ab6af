//! The form factors between all patches, and the laws that they obey.

mod sparse;

mod laws;

pub use sparse::FormFactors;
