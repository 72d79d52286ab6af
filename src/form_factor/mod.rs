//! Form factors: the share of the light leaving one place that arrives at another.
//!
//! - `contour`, `pair`: exact, from a point and between two polygons
//! - `hemicube`, `rays`: what a point sees of many patches
//! - `matrix`, `assembly`: those between all patches of a scene

mod assembly;
pub mod contour;
pub mod hemicube;
mod matrix;
pub mod pair;
pub mod rays;

pub use assembly::{Assembled, FormFactorMethod, assemble, factors_at};
pub use matrix::FormFactors;
