//! Planar polygons of one material, made by joining coplanar neighbours, and where others touch them.
//!
//! | what | where |
//! |---|---|
//! | the surfaces themselves | `model`, on a `plane` each, with a `tint`; their outlines are `polygon`s |
//! | from a scene | `build`: `merge` of neighbours, `mask` of pictures with holes, `overlap` and `partial_overlap` of what is `coplanar` |
//! | how large the scene is | `outliers` |
//! | where they touch | `contact` |
//! | what others do with them | `cut` into convex pieces, `weld` of places, the mean of a `picture`, lights by `light_group` |

mod model;
mod plane;
pub mod polygon;
mod tint;
mod weld;

mod build;
mod contact;
mod coplanar;
mod mask;
mod merge;
mod outliers;
mod overlap;
mod partial_overlap;

pub mod cut;
mod light_group;
mod picture;

pub use build::{faces_of, surfaces_of};
pub use light_group::{LightGroup, StrengthUnit};
pub use model::{Contact, Surface, Surfaces};
pub use picture::{mean_reflectance, mean_texture};
pub use plane::Plane;
pub use polygon::{Ring, Segment};
pub use tint::Tint;
pub use weld::Weld;
pub(crate) use weld::{Cells, cell_key, cells_around};
