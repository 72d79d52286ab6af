//! Radiosity at vertices, on a triangulation without T-junctions.

mod trimesh;

pub use trimesh::{Part, TriMesh};
