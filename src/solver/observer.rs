//! What a solution tells while it is worked out, and what it keeps.

use std::ops::{ControlFlow, Range};
use std::time::Instant;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::checkpoint::Checkpoint;
use super::solution::{Phase, Progress};
use super::stop::{Cancellation, Stop};
use crate::watch::{Enough, Pace, in_batches, watched};

/// Tells a caller how far things are, and remembers if it has had enough.
///
/// What is done after that is a makeshift, which the checkpoint neither knows nor keeps.
pub(super) struct Observer<'a> {
    observe: &'a mut dyn FnMut(&Progress) -> ControlFlow<Cancellation>,
    told: Progress,
    /// How much more of the phase is done once what is under way is.
    part: f64,
    cancelled: Option<Cancellation>,
    pub(super) checkpoint: &'a mut Checkpoint,
}

impl<'a> Observer<'a> {
    pub(super) fn new(
        observe: &'a mut dyn FnMut(&Progress) -> ControlFlow<Cancellation>,
        checkpoint: &'a mut Checkpoint,
    ) -> Self {
        let told = Progress { phase: Phase::Emitters, done: 0.0 };
        Self { observe, told, part: 0.0, cancelled: None, checkpoint }
    }

    pub(super) fn tell(&mut self, phase: Phase, done: f64) -> ControlFlow<()> {
        self.told = Progress { phase, done: done.clamp(0.0, 1.0) };
        self.part = 0.0;
        if self.cancelled.is_none() {
            self.cancelled = (self.observe)(&self.told).break_value();
        }
        if self.is_over() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Whether the caller has had enough.
    pub(super) fn is_over(&self) -> bool {
        self.cancelled.is_some()
    }

    /// Why to stop, once the caller has had enough.
    pub(super) fn stop(&self) -> Stop {
        Stop::Cancelled(self.cancelled.unwrap_or(Cancellation::Caller))
    }

    /// Begins a part of a phase: what is evaluated or mapped next leads from its start to its end.
    pub(super) fn begin(&mut self, phase: Phase, part: Range<f64>) -> ControlFlow<()> {
        let flow = self.tell(phase, part.start);
        self.part = part.end - part.start;
        flow
    }

    /// What `work` makes of the items, batch by batch, remembered by the checkpoint; only of the first when there
    /// has been enough. A batch in which `work` has learnt of that is dropped.
    pub(super) fn evaluate<T: Sync, R: Serialize + DeserializeOwned + Send>(
        &mut self,
        items: &[T],
        work: impl Fn(&[T], &Enough) -> R + Sync + Send,
    ) -> Vec<R> {
        let mut results = Vec::new();
        let mut pace = Pace::new();
        let mut tell = self.teller();
        let mut rest = items;
        while !rest.is_empty() {
            let done = 1.0 - rest.len() as f64 / items.len() as f64;
            if tell(self, done).is_break() {
                break;
            }
            // A batch read back may be of another size than one that would be evaluated now.
            let known: Option<(usize, R)> = self.checkpoint.next();
            let (count, result) = match known {
                Some(known) => known,
                None => {
                    let (batch, start) = (pace.batch(rest), Instant::now());
                    let result = watched(|enough| work(batch, enough), || tell(self, done));
                    if self.is_over() {
                        break;
                    }
                    pace.learn(batch.len(), start.elapsed());
                    let evaluated = (batch.len(), result);
                    self.checkpoint.keep(&evaluated);
                    evaluated
                }
            };
            rest = &rest[count.clamp(1, rest.len())..];
            results.push(result);
        }
        results
    }

    /// What `work` makes of each item, all threads at it, each with a `tool` of its own; only of the first items
    /// when there has been enough. The checkpoint does not know of it.
    pub(super) fn map<T: Sync, S, R: Send>(
        &mut self,
        items: &[T],
        tool: impl Fn(&Enough) -> S + Sync + Send,
        work: impl Fn(&mut S, &T) -> R + Sync + Send,
    ) -> Vec<R> {
        let mut tell = self.teller();
        in_batches(items, tool, work, |done| tell(self, done))
    }

    /// Tells how much of the part under way is done.
    fn teller(&self) -> impl FnMut(&mut Self, f64) -> ControlFlow<()> + use<'a> {
        let (Progress { phase, done: start }, part) = (self.told, self.part);
        move |observer, done| observer.tell(phase, start + part * done)
    }
}
