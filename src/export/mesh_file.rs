//! A lit mesh as a file of the format that its ending names.

use std::path::{Path, PathBuf};

use super::exposed::ExposedMesh;
use super::stamp::Stamp;
use super::{glb, obj, ply};
use crate::error::{Error, Result};
use crate::file;
use crate::reconstruct::TriMesh;
use crate::scene::Texture;

/// Writes `mesh` as `.glb`, `.obj` (with its `.mtl` and pictures beside it) or `.ply`.
///
/// Missing directories are made. Files appear whole or not at all: each is written under another
/// name and renamed.
///
/// # Errors
/// When the ending is none of these, `mesh` has no triangles, or a file cannot be written.
pub fn save(mesh: &TriMesh, path: &Path, stamp: &Stamp) -> Result<()> {
    let format = MeshFormat::of(path)?;
    if mesh.triangles.is_empty() {
        return Err(Error::format(path, "there is no triangle to write"));
    }
    let exposed = ExposedMesh::new(mesh, stamp);
    match format {
        MeshFormat::Glb => file::replace(path, |out| glb::write(&exposed, out)),
        MeshFormat::Obj => obj::save(&exposed, path),
        MeshFormat::Ply => file::replace(path, |out| ply::write(&exposed, out)),
    }
}

/// Finds out before long work whether [`save`] could write to `path`; makes missing directories.
///
/// # Errors
/// When the ending is unknown or no file can be made there.
pub fn check_writable(path: &Path) -> Result<()> {
    MeshFormat::of(path)?;
    file::probe(path)
}

/// The files that [`save`] writes beside `path` if that is an OBJ: its materials and, of these textures, its pictures.
pub fn beside(path: &Path, textures: &[Texture]) -> Vec<PathBuf> {
    match MeshFormat::of(path) {
        Ok(MeshFormat::Obj) => obj::beside(path, textures),
        _ => Vec::new(),
    }
}

/// Those of [`beside`] that are there already, and were not written with an OBJ of that name: somebody else's.
pub fn strangers(path: &Path, textures: &[Texture]) -> Vec<PathBuf> {
    match MeshFormat::of(path) {
        Ok(MeshFormat::Obj) => obj::strangers(path, textures),
        _ => Vec::new(),
    }
}

#[derive(Clone, Copy)]
enum MeshFormat {
    Glb,
    Obj,
    Ply,
}

impl MeshFormat {
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
