//! Progress on stderr, and how long each phase takes.

use std::io::IsTerminal;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};
use radiosity::solver::{Phase, Progress};
use serde::Serialize;

use super::console;
use super::options::TalkOptions;

/// Steps of a progress bar.
const STEPS: f64 = 1000.0;

/// A finished phase.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Timing {
    pub(crate) phase: String,
    pub(crate) seconds: f64,
}

/// Follows the work: a bar on a terminal, a line a phase elsewhere, nothing when quiet.
#[derive(Debug)]
pub(crate) struct Meter {
    quiet: bool,
    /// Whether more is told than most want to know.
    verbose: bool,
    /// Tells of every tenth of a phase where there is no bar.
    tenths: bool,
    on_terminal: bool,
    current: Option<Current>,
    timings: Vec<Timing>,
}

#[derive(Debug)]
struct Current {
    phase: String,
    start: Instant,
    bar: ProgressBar,
    tenth: u32,
}

impl Meter {
    pub(crate) fn new(options: &TalkOptions) -> Self {
        Self {
            quiet: options.quiet,
            verbose: options.verbose > 0,
            tenths: options.verbose > 1,
            on_terminal: std::io::stderr().is_terminal(),
            current: None,
            timings: Vec::new(),
        }
    }

    /// A line for the user, unless quiet.
    pub(crate) fn tell(&self, line: &str) {
        if self.quiet {
            return;
        }
        match &self.current {
            Some(current) => current.bar.suspend(|| console::tell(line)),
            None => console::tell(line),
        }
    }

    /// A line for those who asked for more.
    pub(crate) fn explain(&self, line: &str) {
        if self.verbose {
            self.tell(line);
        }
    }

    /// Ends the phase before and begins the next.
    pub(crate) fn begin(&mut self, phase: &str) {
        self.end();
        let bar = if self.on_terminal && !self.quiet { bar(phase) } else { ProgressBar::hidden() };
        self.current =
            Some(Current { phase: phase.to_owned(), start: Instant::now(), bar, tenth: 0 });
    }

    /// Follows the solver.
    pub(crate) fn follow(&mut self, progress: &Progress) {
        self.advance(name(progress.phase), progress.done);
    }

    /// Tells how much of a phase is done, 0..=1; a new one ends the one before.
    pub(crate) fn advance(&mut self, phase: &str, done: f64) {
        if self.current.as_ref().is_none_or(|current| current.phase != phase) {
            self.begin(phase);
        }
        let Some(current) = &mut self.current else {
            return;
        };
        current.bar.set_position((done * STEPS) as u64);
        let tenth = (done * 10.0) as u32;
        if tenth > current.tenth {
            current.tenth = tenth;
            if self.tenths && !self.on_terminal {
                self.tell(&format!("{phase}: {} %", tenth * 10));
            }
        }
    }

    /// Ends the last phase.
    pub(crate) fn end(&mut self) {
        let Some(Current { phase, start, bar, .. }) = self.current.take() else {
            return;
        };
        bar.finish_and_clear();
        let seconds = start.elapsed().as_secs_f64();
        self.tell(&format!("{phase}: {seconds:.2} s"));
        self.timings.push(Timing { phase, seconds });
    }

    /// The phases that have ended so far, in their order.
    pub(crate) fn timings(&self) -> &[Timing] {
        &self.timings
    }

    /// All phases, in their order, the last one ended.
    pub(crate) fn into_timings(mut self) -> Vec<Timing> {
        self.end();
        self.timings
    }
}

fn name(phase: Phase) -> &'static str {
    match phase {
        Phase::Emitters => "lamps",
        Phase::Direct => "direct light",
        Phase::Lines => "shadow lines",
        Phase::Shooting => "reflected light",
        Phase::Gathering => "gathering",
    }
}

fn bar(phase: &str) -> ProgressBar {
    let template = "{msg:<16} {wide_bar} {percent:>3} %, {eta} left";
    let style =
        ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(STEPS as u64).with_style(style).with_message(phase.to_owned());
    bar.tick();
    bar
}
