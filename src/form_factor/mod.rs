//! Form factors: the share of the light leaving one place that arrives at another.

mod assembly;
pub mod contour;
pub mod hemicube;
mod matrix;
pub mod pair;
pub mod rays;

pub use assembly::{Assembled, FormFactorMethod, assemble, factors_at};
pub use matrix::FormFactors;
