//! Who wins: in sentences, and by how much, set of places by set of places.

use crate::compare::comparison::Comparison;
use crate::compare::curve::Needed;
use crate::compare::run::Family;
use crate::compare::sentences::{capital, number, percent};
use crate::compare::verdict::{AtEqualCost, AtEqualError, BandVerdict, Cost, Winner};
use crate::page::{self, Board, BoardRow, Markup, html};

/// The verdict, and what it is made of.
pub(super) fn verdict(comparison: &Comparison) -> Markup {
    let [first, second] = comparison.verdict.sentences();
    let (lead, rest) = first.split_once(": ").unwrap_or((&first, ""));
    html! {
        @if let Some(stopped) = comparison.stopped() { p.notice role="status" { (stopped) } }
        p.verdict {
            strong { (lead) @if !rest.is_empty() { ":" } } " " (rest)
        }
        p { (second) }
        @if !comparison.verdict.bands.is_empty() { (table(comparison)) }
    }
}

/// By set of places: what adaptive meshes need for the same error, and what error they have at the same cost.
fn table(comparison: &Comparison) -> Markup {
    page::board(&Board {
        caption: "Adaptive against uniform: what the same error takes, and what error the same cost leaves",
        header: &["error", "elements", "time", "error at equal elements", "at equal time"],
        rows: comparison.verdict.bands.iter().map(row).collect(),
    })
}

fn row(verdict: &BandVerdict) -> BoardRow {
    let needed = |cost: Cost, less: &str| {
        let at = verdict.at_equal_error.iter().find(|at| at.cost == cost);
        at.map_or(String::new(), |at| factor_needed(at, less))
    };
    let error_at = |cost: Cost| {
        let at = verdict.at_equal_cost.iter().find(|at| at.cost == cost);
        at.map_or(String::new(), |at| factor_of_error(at, verdict.floor))
    };
    let cells = vec![
        verdict.at_equal_error.first().map_or(String::new(), |at| percent(at.error)),
        needed(Cost::Elements, "fewer"),
        needed(Cost::Seconds, "less"),
        error_at(Cost::Elements),
        error_at(Cost::Seconds),
    ];
    BoardRow { name: capital(verdict.band.name()), cells }
}

/// How much less adaptive needs, or that it lost.
fn factor_needed(at: &AtEqualError, less: &str) -> String {
    let winner = at.winner();
    let is_bound = match winner {
        Winner::One(Family::Uniform) => matches!(at.needed[0], Needed::AtMost(_)),
        _ => matches!(at.needed[1], Needed::AtMost(_)),
    };
    let bound = if is_bound { "at least " } else { "" };
    match (winner, at.ratio()) {
        (Winner::One(Family::Adaptive), Some(ratio)) => {
            format!("{bound}{} × {less}", number(ratio))
        }
        (Winner::One(Family::Adaptive), None) => "uniform never reaches it".to_owned(),
        (Winner::One(Family::Uniform), Some(ratio)) => {
            format!("lost: {bound}{} × more", number(1.0 / ratio))
        }
        (Winner::One(Family::Uniform), None) => "lost: never reaches it".to_owned(),
        (winner, _) => nobody(winner).to_owned(),
    }
}

fn factor_of_error(at: &AtEqualCost, floor: f64) -> String {
    let [uniform, adaptive] = at.errors.map(|error| error.max(floor));
    match at.winner(floor) {
        Winner::One(Family::Adaptive) => format!("{} × smaller", number(uniform / adaptive)),
        Winner::One(Family::Uniform) => format!("lost: {} × larger", number(adaptive / uniform)),
        winner => nobody(winner).to_owned(),
    }
}

fn nobody(winner: Winner) -> &'static str {
    if winner == Winner::Tie { "a tie" } else { "undecided" }
}
