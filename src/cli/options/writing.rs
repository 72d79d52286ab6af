//! How outputs are written, whatever they are.

use clap::Args;

/// What may be overwritten, and what goes to pipes.
#[derive(Debug, Args)]
#[command(next_help_heading = "Writing")]
pub(crate) struct WritingOptions {
    /// Write even over files that this run reads, and over materials and pictures beside an OBJ that are not its own
    #[arg(long)]
    pub(crate) force: bool,

    /// What to write to `-`, which is standard output, and to pipes and devices: an ending, as in --format glb
    #[arg(long, value_name = "ENDING")]
    pub(crate) format: Option<String>,
}
