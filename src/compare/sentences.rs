//! The verdict in words.

use std::fmt::{self, Display, Formatter};

use super::comparison::Comparison;
use super::curve::Needed;
use super::run::Family;
use super::score::Band;
use super::verdict::{AtEqualCost, AtEqualError, BandVerdict, Cost, LAWS, Verdict, Winner};

impl Comparison {
    /// That it was stopped early, if it was, and what there is all the same.
    pub fn stopped(&self) -> Option<String> {
        let runs = match self.runs.len() {
            1 => "1 run that was".to_owned(),
            count => format!("{count} runs that were"),
        };
        self.interrupted.then(|| {
            format!(
                "Stopped before the end: here is what came of the {runs} done, against a reference as exact as it was \
                 by then."
            )
        })
    }
}

impl Verdict {
    /// Two sentences about all surfaces: at equal error, and at equal cost.
    pub fn sentences(&self) -> [String; 2] {
        match self.of(Band::All) {
            Some(verdict) => verdict.sentences(),
            None => ["No verdict: both kinds of mesh need a run.".to_owned(), String::new()],
        }
    }
}

impl Display for Verdict {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [first, second] = self.sentences();
        write!(f, "{first}")?;
        if !second.is_empty() {
            write!(f, "\n{second}")?;
        }
        Ok(())
    }
}

impl BandVerdict {
    /// Two sentences: at equal error, and at equal cost.
    pub fn sentences(&self) -> [String; 2] {
        [self.at_equal_error_in_words(), self.at_equal_cost_in_words()]
    }

    fn at_equal_error_in_words(&self) -> String {
        let at = |cost: Cost| self.at_equal_error.iter().find(|at| at.cost == cost);
        let Some((elements, seconds)) = at(Cost::Elements).zip(at(Cost::Seconds)) else {
            return "No verdict at equal error: both kinds of mesh need a run.".to_owned();
        };
        let needs = |k: usize| match (elements.needed[k], seconds.needed[k]) {
            (Needed::NotReached, _) | (_, Needed::NotReached) => "does not reach it".to_owned(),
            (e, s) => format!("needs {} elements and {} s", amount(e), amount(s)),
        };
        let factors: Vec<String> = [elements, seconds].iter().filter_map(|at| factor(at)).collect();
        let factors = match factors.as_slice() {
            [elements, seconds] => {
                format!(": uniform takes {elements} the elements and {seconds} the time")
            }
            _ => String::new(),
        };
        let error = elements.error;
        let unresolved = error <= self.floor * (1.0 + 1e-9);
        let caveat = if unresolved { ", which the reference does not resolve" } else { "" };
        format!(
            "{}: for {} error ({}{caveat}), adaptive {}, and uniform {}{factors}.",
            lead(elements.winner(), seconds.winner()),
            percent(error),
            self.band.name(),
            needs(1),
            needs(0),
        )
    }

    fn at_equal_cost_in_words(&self) -> String {
        let clauses: Vec<String> = self
            .at_equal_cost
            .iter()
            .filter(|at| at.cost != Cost::FormFactors)
            .map(|at| self.clause(at))
            .collect();
        if clauses.is_empty() {
            return "At equal cost nothing can be said: no uniform and adaptive runs cost alike."
                .to_owned();
        }
        format!("At {}.", clauses.join("; at "))
    }

    fn clause(&self, at: &AtEqualCost) -> String {
        let [uniform, adaptive] = at.errors.map(|error| {
            let below = if error <= self.floor * (1.0 + 1e-9) { "below " } else { "" };
            format!("{below}{}", percent(error))
        });
        let judged = match at.winner(self.floor) {
            Winner::Tie => " (a tie)",
            Winner::Unknown => " (unresolved)",
            Winner::One(Family::Uniform) => " (adaptive lost)",
            Winner::One(Family::Adaptive) => "",
        };
        let (amount, unit) = (number(at.amount), at.cost.name());
        format!("{amount} {unit} the error is {adaptive} adaptive and {uniform} uniform{judged}")
    }
}

/// How adaptive has fared in elements and in time, in the first words.
fn lead(elements: Winner, seconds: Winner) -> String {
    use Winner::{One, Tie, Unknown};
    let fared = |winner: Winner, what: &str| match winner {
        One(Family::Adaptive) => Some(format!("won in {what}")),
        One(Family::Uniform) => Some(format!("lost in {what}")),
        Tie => Some(format!("tied in {what}")),
        Unknown => None,
    };
    match (elements, seconds) {
        (One(Family::Adaptive), One(Family::Adaptive)) => "Adaptive wins".to_owned(),
        (One(Family::Uniform), One(Family::Uniform)) => "Adaptive lost".to_owned(),
        (Tie, Tie) => "A tie".to_owned(),
        (Unknown, Unknown) => "Undecided".to_owned(),
        _ => {
            let known = [fared(elements, "elements"), fared(seconds, "time")];
            let known: Vec<String> = known.into_iter().flatten().collect();
            format!("Adaptive {}", known.join(" and "))
        }
    }
}

fn amount(needed: Needed) -> String {
    match needed {
        Needed::About(amount) => number(amount),
        Needed::AtMost(amount) => format!("at most {}", number(amount)),
        Needed::NotReached => "not reached".to_owned(),
    }
}

/// A name as the first of a line.
pub(super) fn capital(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// How many times as much uniform needs, if that can be told.
fn factor(at: &AtEqualError) -> Option<String> {
    let ratio = at.ratio()?;
    let bound = match at.needed {
        [Needed::About(_), Needed::AtMost(_)] => "at least ",
        [Needed::AtMost(_), Needed::About(_)] => "at most ",
        [Needed::AtMost(_), Needed::AtMost(_)] => return None,
        _ => "",
    };
    Some(format!("{bound}{} times", number(ratio)))
}

/// The theoretical slopes.
pub fn laws() -> String {
    let laws: Vec<String> = LAWS.iter().map(|(slope, what)| format!("{what} {slope}")).collect();
    laws.join(", ")
}

/// A share as per cent, to two digits that count.
pub fn percent(share: f64) -> String {
    let number = 100.0 * share;
    if number == 0.0 {
        return "0 %".to_owned();
    }
    let places = if number >= 10.0 {
        0
    } else if number >= 1.0 {
        1
    } else if number >= 0.1 {
        2
    } else {
        3
    };
    format!("{number:.places$} %")
}

/// A number to two digits behind the point at most, three that count, thousands apart.
pub fn number(amount: f64) -> String {
    if amount < 100.0 {
        let places = if amount >= 10.0 { 1 } else { 2 };
        return format!("{amount:.places$}");
    }
    let digits = format!("{amount:.0}");
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k) % 3 == 0 {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}
