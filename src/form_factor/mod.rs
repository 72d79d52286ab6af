//! Form factors: the share of the light leaving one place that arrives at another.

pub mod contour;
pub mod hemicube;
mod matrix;

pub use matrix::FormFactors;
