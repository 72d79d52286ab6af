//! What an exchange of light has come to, so that it can be taken up again.

use serde::{Deserialize, Serialize};

use super::shooting::{Shooting, Unshot};
use crate::colour::Rgb;
use crate::solver::observer::Observer;
use crate::solver::power_balance::PowerBalance;
use crate::solver::relaxation::Convergence;
use crate::solver::stop::Stop;

/// What shooting has come to: the same, when it is taken up again, as if it had never been left.
#[derive(Serialize, Deserialize)]
pub(super) struct State {
    course: Convergence,
    /// Why it has ended, once it has.
    stop: Option<Stop>,
    held: Unshot,
    remembered: Option<Unshot>,
    received: Vec<Rgb>,
    energy: PowerBalance,
    shots: usize,
    hemicubes: usize,
    factors: u64,
    /// Whose rows are there.
    ready: Vec<usize>,
}

impl Shooting<'_, '_> {
    /// Keeps the state in the checkpoint.
    pub(super) fn keep(&mut self, course: &Convergence, stop: Option<Stop>) {
        let state = self.state(course, stop);
        self.observer.checkpoint.keep(&state);
    }

    /// The state to go on from, once the history is this.
    fn state(&self, course: &Convergence, stop: Option<Stop>) -> State {
        let rows = self.rows.iter().enumerate().filter(|(_, row)| row.is_some());
        State {
            course: course.clone(),
            stop,
            held: Unshot { unshot: self.unshot.clone(), pending: self.pending.clone() },
            remembered: self.remembered.clone(),
            received: self.received.clone(),
            energy: self.energy,
            shots: self.shots,
            hemicubes: self.hemicubes,
            factors: self.factors,
            ready: rows.map(|(row, _)| row).collect(),
        }
    }

    /// Goes on from a state, with the rows that were there made anew if any will be needed.
    pub(super) fn take_up(&mut self, state: State) -> (Convergence, Option<Stop>) {
        if state.stop.is_none() {
            self.make_rows(&state.ready);
        }
        (self.unshot, self.pending) = (state.held.unshot, state.held.pending);
        (self.remembered, self.received) = (state.remembered, state.received);
        (self.energy, self.shots) = (state.energy, state.shots);
        (self.hemicubes, self.factors) = (state.hemicubes, state.factors);
        (state.course, state.stop)
    }
}

/// The last state that was kept of an exchange; none after its end was.
pub(super) fn last_state(observer: &mut Observer<'_>) -> Option<State> {
    let mut last: Option<State> = None;
    while observer.flow.is_continue() && last.as_ref().is_none_or(|state| state.stop.is_none()) {
        let Some(state) = observer.checkpoint.next() else { break };
        last = Some(state);
    }
    last
}
