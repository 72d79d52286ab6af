//! What a solution tells while it is worked out, and what it keeps.

use std::ops::ControlFlow;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Checkpoint, Phase, Progress};

/// Items evaluated before the caller is asked again: fewer would keep threads waiting for each other.
const BATCH: usize = 1024;

/// Tells a caller how far things are, and remembers if it has had enough.
///
/// What is done after that is a makeshift, which the checkpoint neither knows nor keeps.
pub(super) struct Observer<'a> {
    observe: &'a mut dyn FnMut(&Progress) -> ControlFlow<()>,
    told: Progress,
    pub(super) flow: ControlFlow<()>,
    pub(super) checkpoint: &'a mut Checkpoint,
}

impl<'a> Observer<'a> {
    pub(super) fn new(
        observe: &'a mut dyn FnMut(&Progress) -> ControlFlow<()>,
        checkpoint: &'a mut Checkpoint,
    ) -> Self {
        let told = Progress { phase: Phase::Direct, done: 0.0 };
        Self { observe, told, flow: ControlFlow::Continue(()), checkpoint }
    }

    pub(super) fn tell(&mut self, phase: Phase, done: f64) -> ControlFlow<()> {
        self.told = Progress { phase, done: done.clamp(0.0, 1.0) };
        if self.flow.is_continue() {
            self.flow = (self.observe)(&self.told);
        }
        self.flow
    }

    /// What `work` makes of the items, batch by batch; only of the first when there has been enough.
    pub(super) fn evaluate<T, R: Serialize + DeserializeOwned>(
        &mut self,
        items: &[T],
        work: impl Fn(&[T]) -> R,
    ) -> Vec<R> {
        let mut results = Vec::new();
        for batch in items.chunks(BATCH) {
            if self.tell(self.told.phase, self.told.done).is_break() {
                break;
            }
            results.push(self.checkpoint.recall(|| work(batch)));
        }
        results
    }
}
