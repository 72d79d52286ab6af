//! What a solution tells while it is worked out, and what it keeps.

use std::ops::ControlFlow;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Checkpoint, Phase, Progress};

/// Tells a caller how far things are, and remembers if it has had enough.
///
/// What is done after that is a makeshift, which the checkpoint neither knows nor keeps.
pub(super) struct Observer<'a> {
    pub(super) observe: &'a mut dyn FnMut(&Progress) -> ControlFlow<()>,
    pub(super) flow: ControlFlow<()>,
    pub(super) checkpoint: &'a mut Checkpoint,
}

impl Observer<'_> {
    pub(super) fn tell(&mut self, phase: Phase, done: f64) -> ControlFlow<()> {
        if self.flow.is_continue() {
            self.flow = (self.observe)(&Progress { phase, done: done.clamp(0.0, 1.0) });
        }
        self.flow
    }

    /// What `work` makes of the items, batch by batch.
    pub(super) fn evaluate<T, R: Serialize + DeserializeOwned>(
        &mut self,
        items: &[T],
        work: impl Fn(&[T]) -> R,
    ) -> Vec<R> {
        let is_kept = self.flow.is_continue();
        let batches = self.checkpoint.batches(items);
        let evaluate = |batch| {
            if is_kept { self.checkpoint.recall(|| work(batch)) } else { work(batch) }
        };
        batches.map(evaluate).collect()
    }
}
