//! What can go wrong with files and scenes, always with the path or the item it is about.

use std::path::{Path, PathBuf};

/// The result of anything that depends on input.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a scene could not be read, solved or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be opened, read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file was read, but what it says is wrong.
    #[error("{}{}: {message}", path.display(), place(*line))]
    Format {
        /// The file.
        path: PathBuf,
        /// The line it happened in, counted from 1, where the format has lines.
        line: Option<usize>,
        /// What is wrong, and what would be right.
        message: String,
    },
    /// A file name whose ending says nothing that could be read or written.
    #[error("{}: unknown file type; use one of {known}", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// The endings that would do, for example `.glb, .obj, .ply`.
        known: &'static str,
    },
    /// A scene that was read, but in which no light can be computed.
    #[error("{0}")]
    Scene(String),
    /// A setting out of its range.
    #[error("{name}: {message}")]
    Setting {
        /// The setting's name, as on the command line without dashes.
        name: &'static str,
        /// What is wrong, and what would be right.
        message: String,
    },
}

impl Error {
    /// An [`Error::Io`] about `path`, for use with `map_err`.
    pub fn io(path: &Path) -> impl FnOnce(std::io::Error) -> Self + '_ {
        |source| Self::Io { path: path.to_owned(), source }
    }

    /// An [`Error::Format`] about `path` as a whole.
    pub fn format(path: &Path, message: impl Into<String>) -> Self {
        Self::Format { path: path.to_owned(), line: None, message: message.into() }
    }

    /// An [`Error::Format`] about one `line` of `path`, counted from 1.
    pub fn at_line(path: &Path, line: usize, message: impl Into<String>) -> Self {
        Self::Format { path: path.to_owned(), line: Some(line), message: message.into() }
    }
}

fn place(line: Option<usize>) -> String {
    line.map(|line| format!(":{line}")).unwrap_or_default()
}
