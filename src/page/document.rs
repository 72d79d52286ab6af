//! A whole page in one file.

use std::io::Write as _;
use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::error::{Error, Result};
use crate::file;

/// What a page may load: pictures that it holds itself, and nothing else from anywhere.
const POLICY: &str = "default-src 'none'; img-src data: blob:; style-src 'unsafe-inline'; \
                      script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";

const STYLE: &str = include_str!("page.css");

/// The scripts, each after those that it uses.
const SCRIPTS: [&str; 9] = [
    include_str!("page.js"),
    include_str!("camera.js"),
    include_str!("gestures.js"),
    include_str!("model.js"),
    include_str!("drawing.js"),
    include_str!("legend.js"),
    include_str!("viewer.js"),
    include_str!("wipe.js"),
    include_str!("table.js"),
];

/// A whole page with this `title` in the browser's bar and this `body`, which has headings of its own.
pub fn document(title: &str, body: &Markup) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                link rel="icon" href="data:,";
                style { (PreEscaped(STYLE)) }
            }
            body {
                main { (body) }
                script { (PreEscaped(SCRIPTS.join("\n"))) }
            }
        }
    }
}

/// Writes a [`document()`]. Missing directories are made; the file appears whole or not at all.
///
/// # Errors
/// When the ending is not `.html`, or the file cannot be written.
pub fn save(document: &Markup, path: &Path) -> Result<()> {
    check_ending(path)?;
    file::replace(path, |out| out.write_all(document.0.as_bytes()))
}

/// Finds out before long work whether [`save`] could write to `path`; makes missing directories.
///
/// # Errors
/// When the ending is not `.html` or no file can be made there.
pub fn check_writable(path: &Path) -> Result<()> {
    check_ending(path)?;
    file::probe(path)
}

fn check_ending(path: &Path) -> Result<()> {
    let ending = path.extension().unwrap_or_default();
    if ["html", "htm"].iter().any(|known| ending.eq_ignore_ascii_case(known)) {
        return Ok(());
    }
    Err(Error::UnknownFormat { path: path.to_owned(), known: ".html" })
}
