//! Patches, and under each a tree of elements: convex polygons divided in quarters or along a line.

mod ids;
mod landmarks;

mod vertex_index;

mod topology;

mod build;
mod split;
mod statistics;
mod validate;

pub use build::patch_counts;
pub use ids::{ElementId, PatchId, VertexId};
pub use split::{Crossing, Middle, Split};
pub use statistics::{Divided, SizeBin};
pub use topology::{Corners, Element, Mesh, Patch, Reason, Vertex};
