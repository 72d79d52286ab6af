//! What ends the work early, with everything written: Ctrl-C, or a limit of time. A second Ctrl-C ends it at once.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::console;

/// Exit code of a program ended by Ctrl-C, by convention of shells.
const INTERRUPTED: i32 = 130;

/// Knows whether it is time to end.
#[derive(Clone, Debug)]
pub(crate) struct Interrupt {
    over: Arc<AtomicBool>,
    deadline: Option<Instant>,
}

impl Interrupt {
    /// Listens from now on.
    pub(crate) fn listen() -> Self {
        let over = Arc::new(AtomicBool::new(false));
        let pressed = Arc::clone(&over);
        // Where nothing can be listened to, Ctrl-C keeps its usual meaning.
        let _ = ctrlc::set_handler(move || {
            if pressed.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED);
            }
            console::tell("interrupted: writing what there is; once more quits at once");
        });
        Self { over, deadline: None }
    }

    /// The same, and over after this time from now, if any.
    pub(crate) fn within(self, limit: Option<Duration>) -> Self {
        let deadline = limit.and_then(|limit| Instant::now().checked_add(limit));
        Self { deadline, ..self }
    }

    /// Whether to go on.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
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
