//! What names the parts of a mesh.

use crate::ids::id;

id! {
    /// Names a [`Patch`](super::Patch) of one mesh.
    PatchId: super::Patch, super::Mesh, patches
}
id! {
    /// Names an [`Element`](super::Element) of one mesh. Never dangles: elements are only ever added.
    ElementId: super::Element, super::Mesh, elements
}
id! {
    /// Names a [`Vertex`](super::Vertex) of one mesh. Never dangles: vertices are only ever added.
    VertexId: super::Vertex, super::Mesh, vertices
}
