//! Files to write: checked before the work, written after it, never in the place of what is read.

use std::fs;
use std::path::{Path, PathBuf};

use radiosity::scene::Texture;
use radiosity::{Error, Result, export};

/// All that a command writes.
#[derive(Debug)]
pub(crate) struct Outputs {
    /// Files that are asked for by name, or belong to one that is.
    pub(crate) files: Vec<PathBuf>,
    /// Whether inputs may be overwritten, and what others have put beside the outputs.
    pub(crate) force: bool,
}

impl Outputs {
    /// Whether all outputs can be written without harm: none in the place of another, nor of one of the `inputs`, nor
    /// something beside it, as the materials and `textures` of an OBJ are, in the place of what others have put there.
    pub(crate) fn check(&self, inputs: &[PathBuf], textures: &[Texture]) -> Result<()> {
        let meshes = || self.files.iter().map(|path| export::beside(path, textures));
        let all: Vec<PathBuf> = self.files.iter().cloned().chain(meshes().flatten()).collect();
        let places: Vec<Option<PathBuf>> = all.iter().map(|path| place(path)).collect();
        for (number, (path, place)) in all.iter().zip(&places).enumerate() {
            refuse_missing_folder(path)?;
            if place.is_some() && places[..number].contains(place) {
                return Err(Error::format(
                    path,
                    "is to be written twice; give each file its own name",
                ));
            }
        }
        if self.force {
            return Ok(());
        }
        let there = inputs.iter().filter(|path| path.exists());
        let read: Vec<Option<PathBuf>> = there.map(|path| place(path)).collect();
        let is_read = |place: &Option<PathBuf>| place.is_some() && read.contains(place);
        if let Some((path, _)) = all.iter().zip(&places).find(|(_, place)| is_read(place)) {
            let message = "is a file that this run reads; write to another, or use --force";
            return Err(Error::format(path, message));
        }
        match self.files.iter().flat_map(|path| export::strangers(path, textures)).next() {
            Some(path) => Err(Error::format(
                &path,
                "is there already, and would be written beside an output; give that another name, or use --force",
            )),
            None => Ok(()),
        }
    }
}

/// The place that a path leads to, through links; none if its folder is not there, or what is written is not kept.
fn place(path: &Path) -> Option<PathBuf> {
    match fs::metadata(path) {
        Ok(about) if !about.is_file() => None,
        Ok(_) => path.canonicalize().ok(),
        Err(_) => Some(folder(path).canonicalize().ok()?.join(path.file_name()?)),
    }
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A folder that is not there is more likely mistyped than wanted.
fn refuse_missing_folder(path: &Path) -> Result<()> {
    let folder = folder(path);
    if folder.is_dir() {
        return Ok(());
    }
    Err(Error::format(path, format!("there is no folder {}; make it first", folder.display())))
}

/// Whether files have the one ending that they can have.
pub(crate) fn check_endings<'a>(
    paths: impl IntoIterator<Item = &'a PathBuf>,
    known: &'static str,
) -> Result<()> {
    let is_known = |path: &PathBuf| {
        path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(&known[1..]))
    };
    match paths.into_iter().find(|path| !is_known(path)) {
        Some(path) => Err(Error::UnknownFormat { path: path.clone(), known }),
        None => Ok(()),
    }
}
