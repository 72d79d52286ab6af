//! How a mesh reflects and emits, and the light on it: at its vertices, and on its elements.

mod direct;
mod optics;
mod vertices;

mod elements;

pub use direct::Direct;
pub use elements::ElementLight;
pub(crate) use elements::mean;
pub use optics::Optics;
pub use vertices::VertexLight;
