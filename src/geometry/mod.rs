//! Planes, polygons and boxes: knows no scene and no light.
//!
//! | what | where |
//! |---|---|
//! | polygons in space, by their corners | `corners` |
//! | polygons in a plane | `polygon` on a `plane`, `cut` into convex pieces |
//! | half spaces, and what they leave of polygons | `clip` |
//! | places that are one | `weld` |
//! | which of many things are where | `boxes`; the `hierarchy` of boxes that rays go through |

pub(crate) mod boxes;
mod clip;
mod corners;
mod plane;
pub mod polygon;
mod weld;

pub mod cut;
pub mod hierarchy;

pub use clip::{HalfSpace, Pieces, PlanarPolygon, Polygon};
pub(crate) use corners::{
    area_vector, bulge, flattened, is_affine, is_simple, longest_edge, triangulate,
};
pub use plane::Plane;
pub use polygon::{Ring, Segment};
pub use weld::Weld;
pub(crate) use weld::{Cells, cell_key, cells_around};
