//! How a solution converged, as CSV for spreadsheets and plots.

use std::io::{self, Write};
use std::path::Path;

use crate::error::{Error, Result};
use crate::file;
use crate::solver::relaxation::RelaxationStep;

/// What the columns are called.
const COLUMNS: &str = "shots,patch,residual,unshot";

/// Writes a history as `.csv`: one line before the first patch, and one for each patch that was
/// relaxed.
///
/// `shots` counts the patches relaxed so far, `patch` is the last of them, `residual` the largest of
/// all patches and channels, W/m², and `unshot` the share of the emitted power.
///
/// # Errors
/// When the file cannot be written.
pub fn save_history(steps: &[RelaxationStep], path: &Path) -> Result<()> {
    check_ending(path)?;
    file::replace(path, |out| write(steps, out))
}

/// Finds out before long work whether [`save_history`] or [`save_grid`](super::save_grid) could write to `path`;
/// makes missing directories.
///
/// # Errors
/// When the ending is not `.csv` or no file can be made there.
pub fn check_history(path: &Path) -> Result<()> {
    check_ending(path)?;
    file::probe(path)
}

pub(super) fn check_ending(path: &Path) -> Result<()> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
        return Ok(());
    }
    Err(Error::UnknownFormat { path: path.to_owned(), known: ".csv" })
}

fn write(steps: &[RelaxationStep], out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "{COLUMNS}")?;
    for RelaxationStep { shots, row, residual, unshot, .. } in steps {
        let patch = row.map(|row| row.to_string()).unwrap_or_default();
        writeln!(out, "{shots},{patch},{residual:e},{unshot:e}")?;
    }
    Ok(())
}
