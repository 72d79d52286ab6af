//! Outputs that are no files: standard output, pipes, devices.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use radiosity::{Error, Result};
use tempfile::TempDir;

use super::console;
use super::options::WritingOptions;

/// What is to be written to them is first written to files, whose endings tell the format.
#[derive(Debug, Default)]
pub(crate) struct Streams {
    folder: Option<TempDir>,
    /// Each file, and where it is to go.
    list: Vec<(PathBuf, PathBuf)>,
}

impl Streams {
    /// Puts files in the place of those of the `outputs` that are none; standard output is for one thing, be it one of
    /// them or the result as JSON.
    pub(crate) fn divert<'a>(
        &mut self,
        outputs: impl IntoIterator<Item = &'a mut PathBuf>,
        options: &WritingOptions,
        json: bool,
    ) -> Result<()> {
        for output in outputs.into_iter().filter(|output| is_stdout(output) || is_stream(output)) {
            let ending = options.format.as_deref().or(output.extension().and_then(|e| e.to_str()));
            let ending = ending.ok_or_else(|| {
                setting(
                    "format",
                    format!(
                        "{} has no ending; say what to write there, as in --format glb",
                        output.display()
                    ),
                )
            })?;
            if ending.eq_ignore_ascii_case("obj") {
                let message =
                    format!("obj is several files; write another to {}", output.display());
                return Err(setting("format", message));
            }
            if is_stdout(output) && (self.takes_stdout() || json) {
                return Err(Error::format(
                    output,
                    "is to be written twice; standard output is for one thing",
                ));
            }
            let file = self.folder()?.join(format!("{}.{ending}", self.list.len()));
            self.list.push((file.clone(), std::mem::replace(output, file)));
        }
        if options.format.is_some() && self.list.is_empty() {
            let message = "is for -, pipes and devices; the names of files end in what they are";
            return Err(setting("format", message.to_owned()));
        }
        Ok(())
    }

    fn folder(&mut self) -> Result<PathBuf> {
        if self.folder.is_none() {
            self.folder = Some(tempfile::tempdir().map_err(Error::io(&std::env::temp_dir()))?);
        }
        Ok(self.folder.as_ref().map(|folder| folder.path().to_owned()).unwrap_or_default())
    }

    /// Whether an output is standard output: nothing else may go there.
    fn takes_stdout(&self) -> bool {
        self.list.iter().any(|(_, stream)| is_stdout(stream))
    }

    /// Where what is written to a file is to go in the end.
    pub(crate) fn name(&self, file: &Path) -> PathBuf {
        let diverted = self.list.iter().find(|(diverted, _)| diverted == file);
        diverted.map_or(file, |(_, stream)| stream).to_owned()
    }

    /// Whether a file is to go elsewhere in the end.
    pub(crate) fn holds(&self, file: &Path) -> bool {
        self.list.iter().any(|(diverted, _)| diverted == file)
    }

    /// Sends the files on their way.
    pub(crate) fn deliver(&self) -> Result<()> {
        self.list
            .iter()
            .try_for_each(|(file, stream)| send(file, stream).map_err(Error::io(stream)))
    }

    /// Tells the result, on standard output unless a file went there.
    pub(crate) fn print(&self, text: &str) -> Result<()> {
        if self.takes_stdout() {
            console::tell(text);
            return Ok(());
        }
        console::print(text)
    }
}

fn setting(name: &'static str, message: String) -> Error {
    Error::Setting { name, message }
}

fn is_stdout(path: &Path) -> bool {
    path == Path::new("-") || path == Path::new("/dev/stdout")
}

fn is_stream(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir())
}

fn send(file: &Path, stream: &Path) -> io::Result<()> {
    let mut from = File::open(file)?;
    if is_stdout(stream) {
        let mut out = io::stdout().lock();
        io::copy(&mut from, &mut out)?;
        return out.flush();
    }
    io::copy(&mut from, &mut OpenOptions::new().write(true).open(stream)?).map(|_| ())
}
