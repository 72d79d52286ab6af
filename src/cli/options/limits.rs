//! How long work may take, and how much memory.

use std::time::Duration;

use clap::Args;

use super::values;
use crate::cli::memory::MemoryLimit;

/// Share of the memory that is there which may be taken by default.
const SHARE: f64 = 0.8;

/// When work ends though it is not done.
#[derive(Debug, Args)]
#[command(next_help_heading = "Limits")]
pub(crate) struct TimeOptions {
    /// Stop after this time and write what there is, marked as unfinished: 90s, 10min, 2h
    ///
    /// The exit code is 3 then, as after Ctrl-C or SIGTERM. Triangles are still made, and files written, after it.
    #[arg(long, value_name = "TIME", value_parser = values::duration)]
    pub(crate) time_limit: Option<Duration>,
}

/// Where work ends though it is not done.
#[derive(Debug, Args)]
#[command(next_help_heading = "Limits")]
pub(crate) struct LimitOptions {
    #[command(flatten)]
    pub(crate) time: TimeOptions,

    /// Divide no further where memory would grow beyond this, about: 500MB, 4GB
    ///
    /// A scene that needs more even undivided is refused. Default: four fifths of what the system says is free.
    #[arg(long, value_name = "SIZE", value_parser = values::memory)]
    max_memory: Option<u64>,
}

impl LimitOptions {
    /// What may be taken.
    pub(crate) fn memory(&self) -> MemoryLimit {
        MemoryLimit(self.max_memory.or_else(free))
    }
}

/// What may be taken of the free memory, bytes; `None` where the system does not tell.
fn free() -> Option<u64> {
    let about = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = about.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some((kilobytes as f64 * 1024.0 * SHARE) as u64)
}
