//! How much to say, and how many threads to use.

use clap::Args;
use radiosity::{Error, Result};

/// Options of subcommands that have a result for programs.
#[derive(Debug, Args)]
#[command(next_help_heading = "Reporting")]
pub(crate) struct ReportOptions {
    /// Result on stdout as JSON, for programs: in W, W/m², lx and m, whatever the units of the lamps
    ///
    /// What is written has `finished` (false if it was ended early), `written` (files), `seconds` (by phase) and
    /// `notes`, as far as there are any; then what is the command's own.
    #[arg(long)]
    pub(crate) json: bool,

    #[command(flatten)]
    pub(crate) talk: TalkOptions,
}

/// Options of every subcommand.
#[derive(Debug, Args)]
#[command(next_help_heading = "Reporting")]
pub(crate) struct TalkOptions {
    /// No progress and no warnings on stderr, no summary on stdout; errors are still told
    #[arg(short, long)]
    pub(crate) quiet: bool,

    /// Say more on stderr: the settings in metres, the camera; twice: progress in lines too
    #[arg(short, long, action = clap::ArgAction::Count, conflicts_with = "quiet")]
    pub(crate) verbose: u8,

    /// Threads to compute with (default: one a core); the result is the same with any number
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

impl TalkOptions {
    /// Settles the number of threads, for good.
    pub(crate) fn use_threads(&self) -> Result<()> {
        let Some(threads) = self.threads else {
            return Ok(());
        };
        let refused = |message| Error::Setting { name: "threads", message };
        if !(1..=1024).contains(&threads) {
            return Err(refused(format!("{threads} is out of range; use 1 to 1024")));
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build_global().map_err(|error| refused(error.to_string()))
    }
}
