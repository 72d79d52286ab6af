//! GLB: the scene's nodes, one mesh an object, one primitive a material, shown as it is lit; and the way back.
//!
//! | what | where |
//! |---|---|
//! | what every GLB is made of | `document`: `materials`, the `tree` of nodes, a `record` of how it was made; `semantics` |
//! | written | `solved` meshes; the coarse mesh of a `lightmap` |
//! | read | `read`: arrays by `accessors`, what was `hung` in the tree |

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
