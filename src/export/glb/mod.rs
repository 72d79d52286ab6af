//! GLB: the scene's nodes, one mesh an object, one primitive a material, shown as it is lit; and the way back.

mod document;
mod materials;
mod record;
mod semantics;
mod tree;

mod lightmap;
mod solved;

mod accessors;
mod hung;
mod read;

pub(crate) use lightmap::write as write_lightmap;
pub use read::load_solved;
pub(crate) use solved::write;
