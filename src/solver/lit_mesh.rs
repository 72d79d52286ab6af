//! A mesh with the light at its vertices, as the passes that refine it take it.

use crate::direct::WorkCounters;
use crate::light::VertexLight;
use crate::mesh::Mesh;

/// Light at the vertices of a mesh, and what direct light has taken so far.
#[derive(Clone, Debug, Default)]
pub(super) struct VertexLighting {
    pub(super) light: VertexLight,
    pub(super) work: WorkCounters,
}

/// A mesh and its light, which grow together.
pub(super) struct LitMesh<'m> {
    pub(super) mesh: &'m mut Mesh,
    pub(super) light: &'m mut VertexLight,
    pub(super) work: &'m mut WorkCounters,
}

impl VertexLighting {
    /// As that of a mesh.
    pub(super) fn on<'m>(&'m mut self, mesh: &'m mut Mesh) -> LitMesh<'m> {
        let Self { light, work } = self;
        LitMesh { mesh, light, work }
    }
}
