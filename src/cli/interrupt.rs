//! Ctrl-C: the first ends the work early, with everything written; the second ends it at once.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::console;

/// Exit code of a program ended by Ctrl-C, by convention of shells.
const INTERRUPTED: i32 = 130;

/// Knows whether Ctrl-C was pressed.
#[derive(Clone, Debug)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Listens from now on.
    pub(crate) fn listen() -> Self {
        let interrupt = Self(Arc::default());
        let pressed = interrupt.clone();
        // Where nothing can be listened to, Ctrl-C keeps its usual meaning.
        let _ = ctrlc::set_handler(move || {
            if pressed.0.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED);
            }
            console::tell("interrupted: writing what there is; once more quits at once");
        });
        interrupt
    }

    /// Whether to go on.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
