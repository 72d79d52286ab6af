//! Long work in batches: between them a caller hears how much is done, and says whether to go on.
//!
//! One way for all phases. What may take long takes `observe`, tells it the share done, 0..=1, and ends when that
//! breaks off. Batches are sized by time, so results must not depend on where one ends.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use rayon::prelude::*;

/// How long a batch is to take: well below what a user takes for silence, and long enough for threads not to wait
/// for each other.
const BATCH: Duration = Duration::from_millis(150);

/// A batch has so many times the items of the one before at most: those to come may be harder.
const GROWTH: usize = 4;

/// How many items to do before the caller is asked again.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    items: usize,
}

impl Pace {
    /// Begins with one item to each thread.
    pub(crate) fn new() -> Self {
        Self { items: rayon::current_num_threads() }
    }

    /// The first of the items, as many as are to be done next.
    pub(crate) fn batch<'a, T>(&self, items: &'a [T]) -> &'a [T] {
        &items[..self.items.min(items.len())]
    }

    /// Learns from a batch that has taken so long.
    pub(crate) fn learn(&mut self, items: usize, time: Duration) {
        let rate = items as f64 / time.as_secs_f64().max(f64::MIN_POSITIVE);
        let next = (rate * BATCH.as_secs_f64()) as usize;
        self.items = next.clamp(1, items.max(1) * GROWTH);
    }
}

/// What `work` makes of each item, in their order, all threads at it, each with a `tool` of its own; of the first
/// items only, once `observe` breaks off.
pub(crate) fn in_batches<T: Sync, S, R: Send>(
    items: &[T],
    tool: impl Fn() -> S + Sync + Send,
    work: impl Fn(&mut S, &T) -> R + Sync + Send,
    mut observe: impl FnMut(f64) -> ControlFlow<()>,
) -> Vec<R> {
    let mut results = Vec::with_capacity(items.len());
    let mut pace = Pace::new();
    while results.len() < items.len() {
        if observe(results.len() as f64 / items.len() as f64).is_break() {
            break;
        }
        let start = Instant::now();
        let batch = pace.batch(&items[results.len()..]);
        results.par_extend(batch.par_iter().map_init(&tool, &work));
        pace.learn(batch.len(), start.elapsed());
    }
    results
}

/// Lets work go on for `time`, whoever asks.
pub(crate) fn within(time: Duration) -> impl FnMut(f64) -> ControlFlow<()> {
    let start = Instant::now();
    move |_| if start.elapsed() < time { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn squares(items: &[u64], observe: impl FnMut(f64) -> ControlFlow<()>) -> Vec<u64> {
        in_batches(items, || (), |(), x| x * x, observe)
    }

    #[test]
    fn results_are_in_the_order_of_items_and_shares_grow() {
        let items: Vec<u64> = (0..100_000).collect();
        let mut told = Vec::new();
        let found = squares(&items, |share| {
            told.push(share);
            ControlFlow::Continue(())
        });
        assert!(found.iter().zip(&items).all(|(square, x)| *square == x * x));
        assert_eq!(found.len(), items.len());
        assert!(told[0] == 0.0 && told.is_sorted() && told.len() > 3, "{told:?}");
    }

    #[test]
    fn what_is_broken_off_has_the_first_results() {
        let items: Vec<u64> = (0..100_000).collect();
        let some = squares(&items, |share| {
            if share > 0.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert!(!some.is_empty() && some.len() < items.len());
        assert_eq!(some.last(), Some(&(some.len() as u64 - 1).pow(2)));
        assert!(squares(&items, |_| ControlFlow::Break(())).is_empty());
    }

    #[test]
    fn slow_items_are_asked_about_one_by_one() {
        let mut pace = Pace::new();
        let items = [0; 1000];
        pace.learn(1000, Duration::from_millis(1));
        assert_eq!(pace.batch(&items).len(), 1000);
        pace.learn(100, Duration::from_secs(100));
        assert_eq!(pace.batch(&items).len(), 1);
    }
}
