//! What ends the work early, with everything written: Ctrl-C, SIGTERM, or a limit of time. A second signal ends it
//! at once.

use std::ops::ControlFlow;
use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::console;

/// Exit code of a program ended by Ctrl-C, by convention of shells.
const INTERRUPTED: i32 = 130;

/// Exit code when the time is over before there is anything to write.
const FAILED: i32 = 1;

/// How long one who has ended the work waits for there to be something that can be written.
const PATIENCE: Duration = Duration::from_millis(1500);

/// Knows whether it is time to end.
#[derive(Clone, Debug)]
pub(crate) struct Interrupt {
    over: Arc<AtomicBool>,
    /// Whether there will be anything to write: not before the scene is read and divided.
    worthwhile: Arc<AtomicBool>,
    deadline: Option<Instant>,
}

impl Interrupt {
    /// Listens from now on.
    pub(crate) fn listen() -> Self {
        let [over, worthwhile] = [false; 2].map(|no| Arc::new(AtomicBool::new(no)));
        let interrupt = Self { over, worthwhile, deadline: None };
        let heard = interrupt.clone();
        // Where nothing can be listened to, signals keep their usual meaning.
        let _ = ctrlc::set_handler(move || {
            if heard.over.swap(true, Ordering::Relaxed) {
                process::exit(INTERRUPTED);
            }
            console::tell("interrupted: writing what there is; once more quits at once");
            let heard = heard.clone();
            thread::spawn(move || heard.give_up_after(PATIENCE, INTERRUPTED));
        });
        interrupt
    }

    /// The same, and over after this time from now, if any.
    pub(crate) fn within(self, limit: Option<Duration>) -> Self {
        let deadline = limit.and_then(|limit| Instant::now().checked_add(limit));
        let limited = Self { deadline, ..self };
        if let Some(limit) = limit.filter(|_| deadline.is_some()) {
            let watch = limited.clone();
            thread::spawn(move || watch.give_up_after(limit.saturating_add(PATIENCE), FAILED));
        }
        limited
    }

    /// Ends the program unless there is something to write by then: scenes are read without asking.
    fn give_up_after(&self, patience: Duration, code: i32) {
        thread::sleep(patience);
        if !self.worthwhile.load(Ordering::Relaxed) {
            console::tell(
                "radiosity: ended before the work proper has begun; there is nothing to write",
            );
            process::exit(code);
        }
    }

    /// Whether to go on; who asks will leave something that can be written.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        self.worthwhile.store(true, Ordering::Relaxed);
        let late = self.deadline.is_some_and(|deadline| Instant::now() >= deadline);
        if late && !self.over.swap(true, Ordering::Relaxed) {
            console::tell("the time is over: writing what there is");
        }
        if self.over.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
