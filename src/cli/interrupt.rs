//! What ends the work early, with everything written: Ctrl-C, SIGTERM, or a limit of time. A second signal ends it
//! at once.

use std::ops::ControlFlow;
use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use radiosity::Error;

use super::console;
use super::failure::Failure;

/// Exit code of a program ended by Ctrl-C, by convention of shells.
const INTERRUPTED: u8 = 130;

/// Exit code when the time is over before there is anything to write.
const FAILED: u8 = 1;

/// How long one who has ended the work waits for there to be something that can be written.
const PATIENCE: Duration = Duration::from_millis(1500);

/// Knows whether it is time to end.
#[derive(Clone, Debug)]
pub(crate) struct Interrupt {
    over: Arc<AtomicBool>,
    /// Whether that was by a signal.
    signalled: Arc<AtomicBool>,
    /// Whether there is anything to write: not before the scene is read and divided.
    worthwhile: Arc<AtomicBool>,
    /// Whether somebody has been told to end.
    cut: Arc<AtomicBool>,
    deadline: Option<Instant>,
}

impl Interrupt {
    /// Listens from now on.
    pub(crate) fn listen() -> Self {
        let [over, signalled, worthwhile, cut] = [false; 4].map(|no| Arc::new(AtomicBool::new(no)));
        let interrupt = Self { over, signalled, worthwhile, cut, deadline: None };
        let heard = interrupt.clone();
        // Where nothing can be listened to, signals keep their usual meaning.
        let _ = ctrlc::set_handler(move || {
            if heard.signalled.swap(true, Ordering::Relaxed) {
                process::exit(INTERRUPTED.into());
            }
            heard.over.store(true, Ordering::Relaxed);
            console::tell("interrupted: writing what there is; once more quits at once");
            let heard = heard.clone();
            thread::spawn(move || heard.give_up_after(PATIENCE));
        });
        interrupt
    }

    /// The same, and over after this time from now, if any.
    pub(crate) fn within(self, limit: Option<Duration>) -> Self {
        let deadline = limit.and_then(|limit| Instant::now().checked_add(limit));
        let limited = Self { deadline, ..self };
        if let Some(limit) = limit.filter(|_| deadline.is_some()) {
            let watch = limited.clone();
            thread::spawn(move || watch.give_up_after(limit.saturating_add(PATIENCE)));
        }
        limited
    }

    /// From now on there is something to write, or will be very soon after the end.
    pub(crate) fn worth_writing(&self) {
        self.worthwhile.store(true, Ordering::Relaxed);
    }

    /// Ends the program unless there is something to write by then: scenes are read without asking.
    fn give_up_after(&self, patience: Duration) {
        thread::sleep(patience);
        if !self.worthwhile.load(Ordering::Relaxed) {
            self.nothing().tell();
            process::exit(self.empty_handed().into());
        }
    }

    /// How a command ends that was ended before there was anything to write.
    fn nothing(&self) -> Failure {
        Failure::Empty(self.empty_handed())
    }

    /// The exit code for that.
    fn empty_handed(&self) -> u8 {
        if self.signalled.load(Ordering::Relaxed) { INTERRUPTED } else { FAILED }
    }

    /// An error of work that may have failed because it was ended too early.
    pub(crate) fn blamed(&self, error: Error) -> Failure {
        if self.is_whole() { error.into() } else { self.nothing() }
    }

    /// Whether to go on; who asks will leave something that can be written.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        let late = self.deadline.is_some_and(|deadline| Instant::now() >= deadline);
        if late && !self.over.swap(true, Ordering::Relaxed) {
            console::tell("the time is over: writing what there is");
        }
        if self.over.load(Ordering::Relaxed) {
            self.cut.store(true, Ordering::Relaxed);
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Whether all was done, as far as it depends on time: nobody was told to end.
    pub(crate) fn is_whole(&self) -> bool {
        !self.cut.load(Ordering::Relaxed)
    }

    /// How a command ends that has written what there is.
    pub(crate) fn ending(&self) -> Result<(), Failure> {
        if self.is_whole() { Ok(()) } else { Err(Failure::Unfinished) }
    }
}
