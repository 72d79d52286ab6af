//! What stands between two places: segment and shaft queries on a bounding volume hierarchy.
//!
//! - `clip`: convex polygons and half spaces; `surface_point`: where eyes are, with the horizon there
//! - `hierarchy`: trees of boxes, and rays through them
//! - `occluder`, `occluders`: the convex pieces of the surfaces, and whether one of them crosses a segment
//! - `first`: which of them a ray meets first
//! - `shaft`, `blockers`: the convex hull of two bodies, and what may stand in it
//! - `shadow`, `between`, `visible`: shadows cut out of a polygon, seen from another one or from a point
//! - `coplanar`, `patches`, `packet`: the first patch of a mesh along a ray, or along each of many

mod between;
mod blockers;
mod coplanar;
mod first;
mod ids;
mod occluder;
mod occluders;
pub mod packet;
mod patches;
mod shadow;
mod shaft;
mod surface_point;
mod visible;

pub use between::Between;
pub use blockers::Blockers;
pub(crate) use coplanar::{RECESS, hair};
pub use first::Met;
pub use ids::OccluderId;
pub use occluders::Occluders;
pub use patches::PatchHierarchy;
pub use shaft::{ConvexBody, Shaft};
pub use surface_point::SurfacePoint;
pub use visible::{CROWDED, Pyramid};
