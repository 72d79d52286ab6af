//! Files that appear whole or not at all.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// Lets `write` fill a file beside `path` and then puts it in the place of `path`.
pub(crate) fn replace(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<()> {
    make_parent(path).map_err(Error::io(path))?;
    let partial = partial_path(path);
    let written = fill(&partial, write).and_then(|()| fs::rename(&partial, path));
    if written.is_err() {
        // A rest that cannot be removed is a smaller trouble than the one already to be told.
        let _ = fs::remove_file(&partial);
    }
    written.map_err(Error::io(path))
}

/// Fails if [`replace`] could not write to `path`.
pub(crate) fn probe(path: &Path) -> Result<()> {
    let tried = || {
        if path.is_dir() {
            return Err(io::Error::from(io::ErrorKind::IsADirectory));
        }
        make_parent(path)?;
        let partial = partial_path(path);
        File::create(&partial)?;
        fs::remove_file(&partial)
    };
    tried().map_err(Error::io(path))
}

fn fill(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    write(&mut out)?;
    out.flush()
}

fn make_parent(path: &Path) -> io::Result<()> {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => fs::create_dir_all(parent),
        _ => Ok(()),
    }
}

/// A name in the same directory that two programs writing at once do not share.
fn partial_path(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.partial", std::process::id()));
    path.with_file_name(name)
}
