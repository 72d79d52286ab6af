//! Radiosity at vertices, on a triangulation without T-junctions.
//!
//! Every leaf is outlined with all the places that lie on its edges, its own or another's; so
//! neighbours agree on their border, within a surface and where surfaces meet. Light is shared by
//! leaves that share a vertex of the mesh, which those on two sides of a contact line do not.
//!
//! - `trimesh`, `angles`: the mesh that comes of it, and how slender its triangles are
//! - `edge_vertices`, `triangulate`: the places on the edges of leaves, and triangles between them
//! - `fit`, `normal`: light and normals at the corners of those
//! - `surface_triangles`, `smooth`, `glow`: the triangles of one surface, and what surfaces have to do with each other
//! - `assemble`: the triangles of all
//! - `by_light`, `dimming`: the light of each lamp apart, and lamps dimmed

mod angles;
mod assemble;
mod by_light;
mod dimming;
mod edge_vertices;
mod fit;
mod glow;
mod normal;
mod smooth;
mod surface_triangles;
mod triangulate;
mod trimesh;

use crate::solver::Solution;
use crate::surface::Surfaces;

pub use angles::Angles;
pub use by_light::reconstruct_by_light;
pub use dimming::Dimming;
pub(crate) use edge_vertices::Places;
pub use glow::mesh_pictures;
pub(crate) use normal::normal_at;
pub(crate) use triangulate::triangulate;
pub use trimesh::{Irradiance, LightShare, MeshPart, TriMesh};

use assemble::{EmitterStrength, reconstruct_for};

/// The triangle mesh of a solution.
pub fn reconstruct(surfaces: &Surfaces, solution: &Solution) -> TriMesh {
    reconstruct_for(EmitterStrength::Fixed, surfaces, solution)
}
