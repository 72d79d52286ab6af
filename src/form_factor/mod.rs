//! Form factors: the share of the light leaving one place that arrives at another.

pub mod contour;
pub mod hemicube;
mod matrix;
pub mod rays;

pub use matrix::FormFactors;
