//! A lit mesh to files, and back: GLB for viewers and for ourselves, OBJ and PLY for other tools.
//!
//! | ending | colour to look at | radiosity to compute with |
//! |---|---|---|
//! | `.glb` | `COLOR_0`: linear, under `KHR_materials_unlit` | `_RADIOSITY`: float, W/m² |
//! | `.obj` | `v x y z r g b`: sRGB-coded, as Blender and `MeshLab` read it | none |
//! | `.ply` | `red green blue`: sRGB-coded bytes | `radiosity_red` ...: float, W/m² |
//!
//! Colours are exposed and tone-mapped ([`crate::tone`]). On textured parts of a GLB or OBJ they
//! are the light that the picture is multiplied by, which is brightened if it is dark, so that the
//! product is what our own pictures show; a PLY has no pictures and shows their mean.
//! [`save_lightmap`] writes light as a picture instead, and the GLB that it fits on.
//!
//! | what | where |
//! |---|---|
//! | what every file says | `exposed` colours, a `stamp`, a `group` for each material, and `picture`s |
//! | lit meshes | `mesh_file`: `glb`, `obj`, `ply` |
//! | lightmaps | `lightmap` |
//! | tables | `factors`, `grid`, `history` |

mod exposed;
mod group;
pub(crate) mod picture;
mod stamp;

mod glb;
mod mesh_file;
mod obj;
mod ply;

mod lightmap;

mod factors;
mod grid;
mod history;

pub use factors::{FactorPatch, FactorTable, check_writable_factors, save_factors};
pub use glb::load_solved;
pub use grid::save_grid;
pub use history::{check_history, save_history};
pub use lightmap::{check_writable_lightmap, lightmap_files, save_lightmap};
pub use mesh_file::{beside, check_writable, save, strangers};
pub use stamp::Stamp;
