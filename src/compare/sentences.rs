//! The verdict in words.

use std::fmt::{self, Display, Formatter};

use super::curve::Needed;
use super::run::Family;
use super::score::Band;
use super::verdict::{AtEqualCost, AtEqualError, BandVerdict, Cost, LAWS, Verdict, Winner};

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
            Winner::One(_) => "",
        };
        let (amount, unit) = (number(at.amount), at.cost.name());
        format!("{amount} {unit} the error is {adaptive} adaptive and {uniform} uniform{judged}")
    }
}

/// Who wins, in the first words.
fn lead(elements: Winner, seconds: Winner) -> String {
    use Winner::{One, Tie, Unknown};
    match (elements, seconds) {
        (One(a), One(b)) if a == b => format!("{} wins", capital(a)),
        (Tie, Tie) => "A tie".to_owned(),
        (Unknown, _) => "Undecided".to_owned(),
        (Tie, Unknown) => "A tie in elements".to_owned(),
        (One(fewer), Unknown) => format!("{} needs fewer elements", capital(fewer)),
        (One(fewer), Tie) => format!("{} needs fewer elements, as much time", capital(fewer)),
        (Tie, One(faster)) => format!("{} takes less time, as many elements", capital(faster)),
        (One(fewer), One(faster)) => {
            format!("{} needs fewer elements, {} less time", capital(fewer), faster.name())
        }
    }
}

fn capital(family: Family) -> &'static str {
    match family {
        Family::Uniform => "Uniform",
        Family::Adaptive => "Adaptive",
    }
}

fn amount(needed: Needed) -> String {
    match needed {
        Needed::About(amount) => number(amount),
        Needed::AtMost(amount) => format!("at most {}", number(amount)),
        Needed::NotReached => "not reached".to_owned(),
    }
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
