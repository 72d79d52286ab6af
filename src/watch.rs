//! Long work in batches: between them a caller hears how much is done, and says whether to go on.
//!
//! One way for all phases. What may take long takes `observe`, tells it the share done, 0..=1, and ends when that
//! breaks off. Batches are sized by time, so results must not depend on where one ends. Items may turn out to be much
//! harder than those before them: so the caller is asked while a batch is under way, too, and what is left of it is
//! dropped.

use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, Thread};
use std::time::{Duration, Instant};

use rayon::prelude::*;

/// How long a batch is to take: well below what a user takes for silence, and long enough for threads not to wait
/// for each other.
const BATCH: Duration = Duration::from_millis(150);

/// A batch has so many times the items of the one before at most: those to come may be harder.
const GROWTH: usize = 4;

/// How often the caller is asked while a batch takes longer than it was to.
const ASK: Duration = Duration::from_millis(250);

/// Known to all who work on something: whether there has been enough, so that the rest may be dropped.
#[derive(Clone, Debug, Default)]
pub(crate) struct Enough(Arc<AtomicBool>);

impl Enough {
    /// Whether there has been.
    pub(crate) fn is_said(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    fn say(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Does `work`, and asks every so often meanwhile whether to go on with it; `work` learns of it when it asks.
///
/// Threads of the pool do not ask: while they waited, there would be nobody to do the work.
pub(crate) fn watched<R: Send>(
    work: impl FnOnce(&Enough) -> R + Send,
    mut go_on: impl FnMut() -> ControlFlow<()>,
) -> R {
    let enough = Enough::default();
    if rayon::current_thread_index().is_some() {
        return work(&enough);
    }
    let (asking, is_done) = (thread::current(), AtomicBool::new(false));
    thread::scope(|scope| {
        let worker = scope.spawn(|| {
            let _wake = Wake { asking, is_done: &is_done };
            work(&enough)
        });
        let mut asked = Instant::now();
        // Known before the wake, unlike that the thread has ended: so none is slept through.
        while !is_done.load(Ordering::Acquire) {
            thread::park_timeout(ASK);
            if asked.elapsed() >= ASK && !is_done.load(Ordering::Acquire) {
                asked = Instant::now();
                if go_on().is_break() {
                    enough.say();
                }
            }
        }
        worker.join().unwrap_or_else(|panic| resume_unwind(panic))
    })
}

/// Wakes who asks once the work is done, by a panic even.
struct Wake<'a> {
    asking: Thread,
    is_done: &'a AtomicBool,
}

impl Drop for Wake<'_> {
    fn drop(&mut self) {
        self.is_done.store(true, Ordering::Release);
        self.asking.unpark();
    }
}

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
    tool: impl Fn(&Enough) -> S + Sync + Send,
    work: impl Fn(&mut S, &T) -> R + Sync + Send,
    mut observe: impl FnMut(f64) -> ControlFlow<()>,
) -> Vec<R> {
    let mut results = Vec::with_capacity(items.len());
    let mut pace = Pace::new();
    while results.len() < items.len() {
        let done = results.len() as f64 / items.len() as f64;
        if observe(done).is_break() {
            break;
        }
        let start = Instant::now();
        let batch = pace.batch(&items[results.len()..]);
        let found = watched(|enough| all_of(batch, enough, &tool, &work), || observe(done));
        let whole = found.iter().all(Option::is_some);
        results.extend(found.into_iter().map_while(|result| result));
        if !whole {
            break;
        }
        pace.learn(batch.len(), start.elapsed());
    }
    results
}

/// What `work` makes of each item, all threads at it; none of those that there has been enough for.
fn all_of<T, S, R, Tool, Work>(
    items: &[T],
    enough: &Enough,
    tool: &Tool,
    work: &Work,
) -> Vec<Option<R>>
where
    T: Sync,
    R: Send,
    Tool: Fn(&Enough) -> S + Sync + Send,
    Work: Fn(&mut S, &T) -> R + Sync + Send,
{
    let one = |tool: &mut S, item: &T| {
        let result = (!enough.is_said()).then(|| work(tool, item));
        // What was broken off on the way is not whole.
        result.filter(|_| !enough.is_said())
    };
    items.par_iter().map_init(|| tool(enough), one).collect()
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
        in_batches(items, |_| (), |(), x| x * x, observe)
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
    fn no_end_of_a_batch_is_slept_through() {
        let start = Instant::now();
        for _ in 0..200 {
            watched(|_| (), || ControlFlow::Continue(()));
        }
        assert!(start.elapsed() < ASK * 20, "{:?}", start.elapsed());
    }

    /// Items that take a hundred times as long as those before them, and one that would take for ever.
    #[test]
    fn a_batch_that_turns_out_hard_is_dropped() {
        let items: Vec<u64> = (0..10_000).collect();
        let work = |enough: &mut Enough, item: &u64| {
            let is_over = || enough.is_said();
            match item {
                0..2_000 => thread::sleep(Duration::from_micros(10)),
                2_000 => while !is_over() {},
                _ => thread::sleep(Duration::from_millis(20)),
            }
            *item
        };
        let start = Instant::now();
        let found = in_batches(&items, Enough::clone, work, |_| match start.elapsed() {
            time if time < Duration::from_millis(600) => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        });
        assert!(start.elapsed() < Duration::from_millis(1500), "{:?}", start.elapsed());
        assert_eq!(found, items[..2_000]);
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
