//! Thread-safe counters of evaluations of direct light and of shadow rays.

use std::sync::atomic::{AtomicU64, Ordering};

/// Sums that many threads add to; order does not matter to them.
#[derive(Debug, Default)]
pub(super) struct WorkCounters {
    evaluations: AtomicU64,
    rays: AtomicU64,
}

impl WorkCounters {
    pub(super) fn add(&self, evaluations: u64, rays: u64) {
        if evaluations > 0 {
            self.evaluations.fetch_add(evaluations, Ordering::Relaxed);
        }
        if rays > 0 {
            self.rays.fetch_add(rays, Ordering::Relaxed);
        }
    }

    /// Goes on from these sums.
    pub(super) fn set(&self, evaluations: u64, rays: u64) {
        self.evaluations.store(evaluations, Ordering::Relaxed);
        self.rays.store(rays, Ordering::Relaxed);
    }

    pub(super) fn evaluations(&self) -> u64 {
        self.evaluations.load(Ordering::Relaxed)
    }

    pub(super) fn rays(&self) -> u64 {
        self.rays.load(Ordering::Relaxed)
    }
}

impl Clone for WorkCounters {
    /// Begins where the other is.
    fn clone(&self) -> Self {
        let tally = Self::default();
        tally.add(self.evaluations(), self.rays());
        tally
    }
}
