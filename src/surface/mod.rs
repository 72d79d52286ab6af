//! Planar polygons of one material, made by joining coplanar neighbours, and where others touch them.
//!
//! | what | where |
//! |---|---|
//! | the surfaces themselves | `model`, with a `tint` |
//! | from a scene | `build`: `merge` of neighbours, `mask` of pictures with holes, `overlap` and `partial_overlap` of what is `coplanar` |
//! | how large the scene is | `outliers` |
//! | where they touch | `contact` |
//! | what others do with them | the mean of a `picture`, lights by `light_group` |

mod ids;
mod model;
mod tint;

mod build;
mod contact;
mod coplanar;
mod mask;
mod merge;
mod outliers;
mod overlap;
mod partial_overlap;

mod light_group;
mod picture;

pub use build::{faces_of, surfaces_of};
pub use ids::SurfaceId;
pub use light_group::{LightGroup, StrengthUnit};
pub use model::{Contact, Surface, Surfaces};
pub use picture::{mean_reflectance, mean_texture};
pub use tint::Tint;
