//! A mesh with the light at its vertices, as the passes that refine it take it.

use crate::light::VertexLight;
use crate::mesh::Mesh;

/// A mesh and its light, which grow together.
pub(super) struct LitMesh<'m> {
    pub(super) mesh: &'m mut Mesh,
    pub(super) light: &'m mut VertexLight,
}
