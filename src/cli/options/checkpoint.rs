//! Work that is kept, and gone on with.

use std::path::PathBuf;

use clap::Args;
use radiosity::solver::Checkpoint;
use radiosity::{Error, Result, Settings};
use serde::Serialize;

/// Where work is kept.
#[derive(Debug, Args)]
#[command(next_help_heading = "Limits")]
pub(crate) struct CheckpointOptions {
    /// Keep what is worked out in this file, as it is done, so that --resume can go on from there
    ///
    /// Whatever ends the program, little more than the last twentieth of the work is lost. The file stays when
    /// the work is done: other pictures of the same solution are then ready in a moment.
    #[arg(long, value_name = "FILE")]
    pub(crate) checkpoint: Option<PathBuf>,

    /// Go on from the file of --checkpoint, if there is one, and end with the same bytes as if never left
    #[arg(long, requires = "checkpoint")]
    resume: bool,
}

impl CheckpointOptions {
    /// Whether the file can be kept.
    pub(crate) fn check(&self) -> Result<()> {
        let Some(path) = &self.checkpoint else { return Ok(()) };
        if path.exists() && !self.resume {
            let message = "is there already; go on from it with --resume, or give another name";
            return Err(Error::format(path, message));
        }
        Checkpoint::check_writable(path)
    }

    /// The file, and whether it holds work of an earlier run.
    pub(crate) fn open(
        &self,
        subject: &impl Serialize,
        settings: &Settings,
    ) -> Result<(Checkpoint, bool)> {
        match &self.checkpoint {
            None => Ok((Checkpoint::default(), false)),
            Some(path) if self.resume && path.exists() => {
                Checkpoint::resume(path, subject, settings).map(|checkpoint| (checkpoint, true))
            }
            Some(path) => {
                Checkpoint::create(path, subject, settings).map(|checkpoint| (checkpoint, false))
            }
        }
    }

    /// Removes the file: there is nothing in it to go on with.
    pub(crate) fn remove(&self) {
        if let Some(path) = &self.checkpoint {
            // What is left of it is a smaller trouble than the one already to be told.
            let _ = std::fs::remove_file(path);
        }
    }
}
