//! Files to write: checked before the work, written after it.

use std::path::{Path, PathBuf};

use radiosity::{Error, Result, export, render};

/// Whether all files could be written, and none of them is the one that is read.
pub(crate) fn check(
    input: &Path,
    meshes: &[PathBuf],
    pictures: &[PathBuf],
    history: Option<&Path>,
) -> Result<()> {
    for path in meshes {
        refuse_input(input, path)?;
        export::check_writable(path)?;
    }
    for path in pictures {
        refuse_input(input, path)?;
        render::check_writable(path)?;
    }
    if let Some(path) = history {
        refuse_input(input, path)?;
        export::check_history(path)?;
    }
    Ok(())
}

/// The same for matrices of form factors.
pub(crate) fn check_factors(input: &Path, outputs: &[PathBuf]) -> Result<()> {
    for path in outputs {
        refuse_input(input, path)?;
        export::check_writable_factors(path)?;
    }
    Ok(())
}

fn refuse_input(input: &Path, output: &Path) -> Result<()> {
    match (input.canonicalize(), output.canonicalize()) {
        (Ok(input), Ok(output)) if input == output => {
            Err(Error::format(&output, "is the file that is read; write to another"))
        }
        _ => Ok(()),
    }
}
