//! Files that appear whole or not at all.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// Links in a row that are followed.
const MOST_LINKS: usize = 40;

/// Lets `write` fill a file beside `path` and then puts it in the place of `path`.
///
/// A link stays one: what it points to is replaced. A file that was there keeps its mode. Pipes and devices are written
/// to, once all is known.
pub(crate) fn replace(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<()> {
    let written = match is_stream(path) {
        true => pour(path, write),
        false => put(path, write),
    };
    written.map_err(Error::io(path))
}

/// Fails if [`replace`] could not write to `path`.
pub(crate) fn probe(path: &Path) -> Result<()> {
    let tried = || {
        if path.is_dir() {
            return Err(io::Error::from(io::ErrorKind::IsADirectory));
        }
        if is_stream(path) {
            return Ok(());
        }
        let target = followed(path)?;
        if target.exists() {
            // What must not be written to is not replaced, either.
            OpenOptions::new().write(true).open(&target)?;
        }
        make_parent(&target)?;
        let partial = partial_path(&target);
        File::create(&partial)?;
        fs::remove_file(&partial)
    };
    tried().map_err(Error::io(path))
}

/// True for pipes, devices and the like, which cannot be replaced.
fn is_stream(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir())
}

fn put(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let target = followed(path)?;
    make_parent(&target)?;
    let partial = partial_path(&target);
    let written = fill(&partial, write).and_then(|()| {
        if let Ok(about) = fs::metadata(&target) {
            fs::set_permissions(&partial, about.permissions())?;
        }
        fs::rename(&partial, &target)
    });
    if written.is_err() {
        // A rest that cannot be removed is a smaller trouble than the one already to be told.
        let _ = fs::remove_file(&partial);
    }
    written
}

/// Formats are written with a look back at what came before, which pipes do not allow.
fn pour(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let partial = partial_path(&std::env::temp_dir().join(path.file_name().unwrap_or_default()));
    let poured = fill(&partial, write).and_then(|()| {
        let mut out = OpenOptions::new().write(true).open(path)?;
        io::copy(&mut File::open(&partial)?, &mut out)?;
        out.flush()
    });
    let _ = fs::remove_file(&partial);
    poured
}

fn fill(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    write(&mut out)?;
    out.flush()
}

/// The place that a path leads to through links, whether or not there is anything.
fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        if !path.is_symlink() {
            return Ok(path);
        }
        let next = fs::read_link(&path)?;
        path = path.parent().unwrap_or(Path::new("")).join(next);
    }
    Err(io::Error::other("too many links in a row"))
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
