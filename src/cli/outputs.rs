//! Files to write: checked before the work, written after it.

use std::path::{Path, PathBuf};

use radiosity::{Error, Result, compare, export, page, render};

use super::lightmap::LightmapOptions;

/// Whether all files could be written, and none of them is the one that is read.
pub(crate) fn check(
    input: &Path,
    meshes: &[PathBuf],
    pictures: &[PathBuf],
    tables: &[&Path],
) -> Result<()> {
    for path in meshes {
        refuse_input(input, path)?;
        export::check_writable(path)?;
    }
    for path in pictures {
        refuse_input(input, path)?;
        render::check_writable(path)?;
    }
    for path in tables {
        refuse_input(input, path)?;
        export::check_history(path)?;
    }
    Ok(())
}

/// The same for a lightmap, whose files are others than those of meshes and pictures.
pub(crate) fn check_lightmap(
    input: &Path,
    lightmap: &LightmapOptions,
    (meshes, pictures): (&[PathBuf], &[PathBuf]),
) -> Result<()> {
    for path in lightmap.files(meshes) {
        refuse_input(input, &path)?;
        if meshes.contains(&path) || pictures.contains(&path) {
            let message =
                "is to be written twice: a lightmap has a coarse mesh and maps of its own";
            return Err(Error::format(&path, message));
        }
    }
    lightmap.check(meshes)
}

/// The same for matrices of form factors.
pub(crate) fn check_factors(input: &Path, outputs: &[PathBuf]) -> Result<()> {
    for path in outputs {
        refuse_input(input, path)?;
        export::check_writable_factors(path)?;
    }
    Ok(())
}

/// The same for comparisons: a page, tables of runs, and the reference, none in the place of another.
pub(crate) fn check_compared(
    inputs: &[&Path],
    report: Option<&Path>,
    outputs: &[&Path],
) -> Result<()> {
    if let Some(path) = report {
        inputs.iter().try_for_each(|input| refuse_input(input, path))?;
        page::check_writable(path)?;
    }
    for (number, path) in outputs.iter().enumerate() {
        inputs.iter().try_for_each(|input| refuse_input(input, path))?;
        if outputs[..number].contains(path) {
            return Err(Error::format(path, "is to be written twice; give each file its own name"));
        }
        compare::check_writable(path)?;
    }
    Ok(())
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

pub(crate) fn refuse_input(input: &Path, output: &Path) -> Result<()> {
    match (input.canonicalize(), output.canonicalize()) {
        (Ok(input), Ok(output)) if input == output => {
            Err(Error::format(&output, "is the file that is read; write to another"))
        }
        _ => Ok(()),
    }
}
