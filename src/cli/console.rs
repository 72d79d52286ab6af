//! Words to the user: news on stderr, results on stdout.

use std::io::{self, ErrorKind, Write};
use std::path::Path;

use radiosity::{Error, Result};
use serde::Serialize;

/// Writes a line to stderr.
pub(crate) fn tell(line: &str) {
    // A closed stderr must not end the work.
    let _ = writeln!(io::stderr(), "{line}");
}

/// Writes text to stdout; a reader that has closed it has read enough.
pub(crate) fn print(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Error::io(Path::new("stdout"))(error))
        }
        _ => Ok(()),
    }
}

/// Writes a value to stdout as JSON.
pub(crate) fn print_json(value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| Error::format(Path::new("stdout"), error.to_string()))?;
    print(&text)
}
