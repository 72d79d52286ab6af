//! Files that other files name, in the ways of the machines these were written on.

use std::fs;
use std::path::{Component, Path, PathBuf};

use percent_encoding::percent_decode_str;

/// The file that is meant by a `name` in a file in `folder`: as written, in another case, or the one of its bare name in
/// the folder itself. What was not found as written is noted.
pub(super) fn find(folder: &Path, name: &str, notes: &mut Vec<String>) -> Option<PathBuf> {
    let as_written = [name.to_owned(), plain(name)].map(|name| folder.join(name));
    if let Some(path) = as_written.into_iter().find(|path| path.is_file()) {
        return Some(path);
    }
    let name = plain(name);
    let bare = name.rsplit('/').next().unwrap_or_default();
    let path = in_any_case(folder, &name).or_else(|| in_any_case(folder, bare))?;
    let taken = path.strip_prefix(folder).unwrap_or(&path).display();
    let note = format!("file \"{name}\" is not there; \"{taken}\" beside the scene is taken");
    if !notes.contains(&note) {
        notes.push(note);
    }
    Some(path)
}

/// A name without quotes, a scheme, escapes and backslashes.
fn plain(name: &str) -> String {
    let name = name.trim().trim_matches('"');
    let scheme = name.get(..5).filter(|start| start.eq_ignore_ascii_case("file:"));
    let name = match scheme {
        Some(scheme) => percent_decode_str(&name[scheme.len()..]).decode_utf8_lossy().into_owned(),
        None => name.to_owned(),
    };
    name.replace('\\', "/")
}

/// The file at a relative path, its names in any case.
fn in_any_case(folder: &Path, name: &str) -> Option<PathBuf> {
    let mut path = folder.to_owned();
    for part in Path::new(name).components() {
        match part {
            Component::Normal(part) => path = entry(&path, &part.to_string_lossy())?,
            Component::ParentDir => path.push(".."),
            Component::CurDir => {}
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    path.is_file().then_some(path)
}

/// What a folder holds under a name: exactly that, else the first in the order of names that differs only by case.
fn entry(folder: &Path, name: &str) -> Option<PathBuf> {
    let exact = folder.join(name);
    if exact.exists() {
        return Some(exact);
    }
    let listed = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let names = fs::read_dir(listed).ok()?.filter_map(Result::ok).map(|entry| entry.file_name());
    let alike =
        |found: &std::ffi::OsString| found.to_string_lossy().to_lowercase() == name.to_lowercase();
    names.filter(alike).min().map(|found| folder.join(found))
}
