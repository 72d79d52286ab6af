//! What an exchange of light has come to, so that it can be taken up again.

use serde::{Deserialize, Serialize};

use crate::colour::Rgb;
use crate::solver::observer::Observer;
use crate::solver::power_balance::PowerBalance;
use crate::solver::relaxation::Convergence;
use crate::solver::stop::Stop;

/// What shooting has come to, all of it: taken up again, it is the same as if it had never been left.
#[derive(Default, Serialize, Deserialize)]
pub(in crate::solver) struct State {
    pub(super) unshot: Unshot,
    /// What clusters release, if that is not what they hold: what they held when the sweep began.
    pub(super) snapshot: Option<Unshot>,
    /// By element: irradiance by reflected light received at that level, W/m².
    pub(in crate::solver) received: Vec<Rgb>,
    pub(in crate::solver) energy: PowerBalance,
    pub(in crate::solver) shots: usize,
    /// Hemicubes looked through.
    pub(in crate::solver) hemicubes: usize,
    /// Factors from a point to a polygon.
    pub(in crate::solver) factors: u64,
}

/// Light received and not yet shot.
#[derive(Clone, Default, Serialize, Deserialize)]
pub(super) struct Unshot {
    /// By cluster: mean radiosity, W/m².
    pub(super) radiosity: Vec<Rgb>,
    /// By element: irradiance received at that level, W/m².
    pub(super) irradiance: Vec<Rgb>,
}

/// What is kept of an exchange: how it has converged, why it has ended, once it has, its state, and whose rows are
/// there.
pub(super) type ShootingRecord = (Convergence, Option<Stop>, State, Vec<usize>);

/// What was kept last of an exchange; none after its end was.
pub(super) fn last_kept(observer: &mut Observer<'_>) -> Option<ShootingRecord> {
    let mut last: Option<ShootingRecord> = None;
    while !observer.is_over() && last.as_ref().is_none_or(|(_, stop, ..)| stop.is_none()) {
        let Some(kept) = observer.checkpoint.next() else { break };
        last = Some(kept);
    }
    last
}
