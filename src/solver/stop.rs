//! Why a solver stopped.

use serde::{Deserialize, Serialize};

/// Why a solver stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stop {
    /// The unshot power fell below [`Settings::unshot_limit`](crate::settings::Settings::unshot_limit); of a
    /// [`System`](super::relaxation::System), its residual below what was asked for.
    Converged,
    /// A whole sweep over a [`System`](super::relaxation::System) has changed no radiosity by as much as was
    /// asked for.
    Unchanged,
    /// [`Settings::max_shots`](crate::settings::Settings::max_shots) were fired, or as many rows of a system relaxed.
    ShotLimit,
    /// The observer broke off, for this reason.
    Cancelled(Cancellation),
    /// What is unshot grew a millionfold, or has not come to a new low in a hundred sweeps.
    Diverged,
}

/// Why an observer breaks off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cancellation {
    /// The time given for it is over.
    TimeLimit,
    /// Somebody interrupted it: Ctrl-C, SIGINT.
    Interrupt,
    /// The system asked the program to end: SIGTERM.
    Termination,
    /// The caller has seen enough.
    Caller,
}

impl Stop {
    /// True if the observer broke off.
    pub fn is_cancelled(self) -> bool {
        matches!(self, Self::Cancelled(_))
    }
}
