//! What ends the work early, with everything written: Ctrl-C, SIGTERM, SIGHUP, or a limit of time. A second signal
//! ends the program at once.

use std::ops::ControlFlow;
use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use radiosity::Error;
use radiosity::solver::Cancellation;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use super::console;
use super::failure::Failure;

/// Signals that end the work.
#[cfg(unix)]
const SIGNALS: [i32; 3] = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
#[cfg(not(unix))]
const SIGNALS: [i32; 2] = [SIGINT, SIGTERM];

/// Exit code of a program ended by a signal, less the signal's number, by convention of shells.
const SIGNALLED: i32 = 128;

/// Exit code when the time is over before there is anything to write.
const FAILED: u8 = 1;

/// How often it is looked whether a signal has come: soon enough to seem at once.
const WATCH: Duration = Duration::from_millis(50);

/// How long one who has ended the work waits for there to be something that can be written.
const PATIENCE: Duration = Duration::from_millis(1500);

/// Knows whether it is time to end, and why.
#[derive(Clone, Debug)]
pub(crate) struct Interrupt {
    /// The last signal that has come; 0 before one has.
    signal: Arc<AtomicUsize>,
    /// Whether the time is over.
    late: Arc<AtomicBool>,
    /// Whether there is anything to write: not before the scene is read and divided.
    worthwhile: Arc<AtomicBool>,
    /// Whether somebody has been told to end.
    cut: Arc<AtomicBool>,
    deadline: Option<Instant>,
}

impl Interrupt {
    /// Listens from now on.
    pub(crate) fn listen() -> Self {
        let signal = Arc::default();
        for number in SIGNALS {
            // Where a signal cannot be listened to, it keeps its usual meaning.
            let _ = listen_to(number, &signal);
        }
        let [late, worthwhile, cut] = [false; 3].map(|no| Arc::new(AtomicBool::new(no)));
        let interrupt = Self { signal, late, worthwhile, cut, deadline: None };
        let watch = interrupt.clone();
        thread::spawn(move || watch.wait_for_a_signal());
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

    fn wait_for_a_signal(&self) {
        while self.signal().is_none() {
            thread::sleep(WATCH);
        }
        console::tell("interrupted: writing what there is; once more quits at once");
        self.give_up_after(PATIENCE);
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
        self.signal().and_then(|signal| u8::try_from(SIGNALLED + signal).ok()).unwrap_or(FAILED)
    }

    /// An error of work that may have failed because it was ended too early.
    pub(crate) fn blamed(&self, error: Error) -> Failure {
        if self.is_whole() { error.into() } else { self.nothing() }
    }

    /// Whether to go on; who asks will leave something that can be written.
    pub(crate) fn go_on(&self) -> ControlFlow<()> {
        self.flow().map_break(drop)
    }

    /// The same, with the reason not to.
    pub(crate) fn flow(&self) -> ControlFlow<Cancellation> {
        let Some(reason) = self.reason() else { return ControlFlow::Continue(()) };
        self.cut.store(true, Ordering::Relaxed);
        ControlFlow::Break(reason)
    }

    fn reason(&self) -> Option<Cancellation> {
        if let Some(signal) = self.signal() {
            let is_interrupt = signal == SIGINT;
            return Some(if is_interrupt {
                Cancellation::Interrupt
            } else {
                Cancellation::Termination
            });
        }
        let is_late = self.deadline.is_some_and(|deadline| Instant::now() >= deadline);
        if is_late && !self.late.swap(true, Ordering::Relaxed) {
            console::tell("the time is over: writing what there is");
        }
        is_late.then_some(Cancellation::TimeLimit)
    }

    fn signal(&self) -> Option<i32> {
        i32::try_from(self.signal.load(Ordering::Relaxed)).ok().filter(|&signal| signal != 0)
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

/// Lets a signal leave its number when it comes, and end the program when it comes again.
fn listen_to(number: i32, signal: &Arc<AtomicUsize>) -> std::io::Result<()> {
    let again = Arc::new(AtomicBool::new(false));
    // What is registered first is done first: the first signal does not find itself.
    flag::register_conditional_shutdown(number, SIGNALLED + number, Arc::clone(&again))?;
    flag::register(number, again)?;
    flag::register_usize(number, Arc::clone(signal), number as usize)?;
    Ok(())
}
