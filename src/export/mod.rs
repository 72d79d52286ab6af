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

mod factors;
mod glb;
mod grid;
mod group;
mod history;
mod lightmap;
mod look;
mod obj;
pub(crate) mod picture;
mod ply;

use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::file;
use crate::reconstruct::TriMesh;
use crate::scene::Texture;
use crate::tone::Exposure;

pub use factors::{FactorPatch, FactorTable, check_writable_factors, save_factors};
pub use glb::load_solved;
pub use grid::save_grid;
pub use history::{check_history, save_history};
pub use lightmap::{check_writable_lightmap, lightmap_files, save_lightmap};
use look::Look;

/// What a file says about the light in it, beside the light.
#[derive(Clone, Debug, PartialEq)]
pub struct Stamp {
    /// How the colours were, or are to be, exposed.
    pub exposure: Exposure,
    /// The settings of the solution, as the caller wants them on record; kept by `.glb` only.
    pub settings: serde_json::Value,
    /// False if the solver was stopped before it was done.
    pub finished: bool,
}

impl Default for Stamp {
    fn default() -> Self {
        Self { exposure: Exposure::Automatic, settings: serde_json::Value::Null, finished: true }
    }
}

/// Writes `mesh` as `.glb`, `.obj` (with its `.mtl` and pictures beside it) or `.ply`.
///
/// Missing directories are made. Files appear whole or not at all: each is written under another
/// name and renamed.
///
/// # Errors
/// When the ending is none of these, `mesh` has no triangles, or a file cannot be written.
pub fn save(mesh: &TriMesh, path: &Path, stamp: &Stamp) -> Result<()> {
    let format = Format::of(path)?;
    if mesh.triangles.is_empty() {
        return Err(Error::format(path, "there is no triangle to write"));
    }
    let look = Look::new(mesh, stamp);
    match format {
        Format::Glb => file::replace(path, |out| glb::write(&look, out)),
        Format::Obj => obj::save(&look, path),
        Format::Ply => file::replace(path, |out| ply::write(&look, out)),
    }
}

/// Finds out before long work whether [`save`] could write to `path`; makes missing directories.
///
/// # Errors
/// When the ending is unknown or no file can be made there.
pub fn check_writable(path: &Path) -> Result<()> {
    Format::of(path)?;
    file::probe(path)
}

/// The files that [`save`] writes beside `path` if that is an OBJ: its materials and, of these textures, its pictures.
pub fn beside(path: &Path, textures: &[Texture]) -> Vec<PathBuf> {
    match Format::of(path) {
        Ok(Format::Obj) => obj::beside(path, textures),
        _ => Vec::new(),
    }
}

/// Those of [`beside`] that are there already, and were not written with an OBJ of that name: somebody else's.
pub fn strangers(path: &Path, textures: &[Texture]) -> Vec<PathBuf> {
    match Format::of(path) {
        Ok(Format::Obj) => obj::strangers(path, textures),
        _ => Vec::new(),
    }
}

#[derive(Clone, Copy)]
enum Format {
    Glb,
    Obj,
    Ply,
}

impl Format {
    fn of(path: &Path) -> Result<Self> {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        match ending.to_ascii_lowercase().as_str() {
            "glb" => Ok(Self::Glb),
            "obj" => Ok(Self::Obj),
            "ply" => Ok(Self::Ply),
            _ => Err(Error::UnknownFormat { path: path.to_owned(), known: ".glb, .obj, .ply" }),
        }
    }
}
