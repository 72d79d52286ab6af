//! Why a solver stopped.

use serde::{Deserialize, Serialize};

/// Why a solver stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stop {
    /// The unshot power fell below [`Settings::stop`](crate::settings::Settings::stop); of a [`System`](super::relaxation::System), its residual
    /// below what was asked for.
    Converged,
    /// A whole sweep over a [`System`](super::relaxation::System) has changed no radiosity by as much as was
    /// asked for.
    Unchanged,
    /// [`Settings::max_shots`](crate::settings::Settings::max_shots) were fired, or as many rows of a system relaxed.
    ShotLimit,
    /// The observer asked for it.
    Cancelled,
    /// What is unshot grew a millionfold, or has not come to a new low in a hundred sweeps.
    Diverged,
}
