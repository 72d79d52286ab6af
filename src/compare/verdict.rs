//! Which kind of mesh is worth its cost: at equal error, at equal cost, and in the long run.

use serde::Serialize;

use super::curve::{CostCurve, Needed};
use super::run::{Family, Run};
use super::score::Band;

/// Ratios up to this are a tie.
pub const TIE: f64 = 1.1;

/// What a run costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cost {
    /// Leaves on surfaces that reflect.
    Elements,
    /// Time.
    Seconds,
    /// Evaluations of form factors, the same on all machines.
    FormFactors,
}

impl Cost {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Elements, Self::Seconds, Self::FormFactors];

    /// What it is called in sentences.
    pub fn name(self) -> &'static str {
        match self {
            Self::Elements => "elements",
            Self::Seconds => "s",
            Self::FormFactors => "form factors",
        }
    }

    /// What a run cost.
    pub fn of(self, run: &Run) -> f64 {
        match self {
            Self::Elements => run.elements as f64,
            Self::Seconds => run.seconds.total(),
            Self::FormFactors => run.work.form_factors() as f64,
        }
    }
}

/// The curves of error against cost of both families, for one set of places and one kind of cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Contest {
    /// The kind of cost.
    pub cost: Cost,
    /// Uniform, adaptive.
    pub curves: [CostCurve; 2],
    /// Errors below this are not resolved.
    pub floor: f64,
}

/// What the same error costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtEqualError {
    /// The cost.
    pub cost: Cost,
    /// Root mean square error, as a share of the mean.
    pub error: f64,
    /// Uniform, adaptive.
    pub needed: [Needed; 2],
}

/// What error the same cost buys.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtEqualCost {
    /// The cost.
    pub cost: Cost,
    /// How much.
    pub amount: f64,
    /// Uniform, adaptive; shares of the mean.
    pub errors: [f64; 2],
}

/// Who is ahead.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Winner {
    /// One of the two, by more than a tenth.
    One(Family),
    /// Neither.
    Tie,
    /// It cannot be told.
    Unknown,
}

/// How the error falls with the number of elements N: error ~ N^slope.
///
/// In theory, for linear interpolation and the root mean square error: smooth light gives -1, a kink across
/// elements -3/4, a jump across them -1/4.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Slopes {
    /// Uniform, adaptive; `None` with fewer than two resolved runs.
    pub fitted: [Option<f64>; 2],
}

/// The theoretical slopes, and what they are of.
pub const LAWS: [(f64, &str); 3] = [(-1.0, "smooth light"), (-0.75, "a kink"), (-0.25, "a jump")];

/// The verdict on one set of places.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BandVerdict {
    /// Which.
    pub band: Band,
    /// By cost: what the smallest error that both reach costs, or the one asked for.
    pub at_equal_error: Vec<AtEqualError>,
    /// By cost: what error the most that both have spent buys.
    pub at_equal_cost: Vec<AtEqualCost>,
    /// How errors fall.
    pub slopes: Slopes,
    /// Errors below this are not resolved.
    pub floor: f64,
}

/// The verdict on a comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// All surfaces, the shadow band, elsewhere; sets without light or without runs are left out.
    pub bands: Vec<BandVerdict>,
}

impl Verdict {
    /// Of runs of both families; at `error`, or at the smallest that both reach.
    pub fn new(runs: &[Run], error: Option<f64>) -> Self {
        let verdict = |&band: &Band| {
            let contests = Cost::ALL.map(|cost| Contest::new(runs, band, cost));
            BandVerdict::new(band, &contests, error)
        };
        Self { bands: Band::ALL.iter().filter_map(verdict).collect() }
    }

    /// The verdict on a set of places.
    pub fn of(&self, band: Band) -> Option<&BandVerdict> {
        self.bands.iter().find(|verdict| verdict.band == band)
    }
}

impl Contest {
    /// The curves of runs.
    pub fn new(runs: &[Run], band: Band, cost: Cost) -> Self {
        let pair = |run: &Run| {
            let errors = run.score.of(band);
            // Below the floor an error could be anything down to zero.
            (cost.of(run), if errors.mean > 0.0 { errors.rmse.max(errors.floor) } else { 0.0 })
        };
        let curve =
            |family: Family| CostCurve::new(runs.iter().filter(|r| r.family == family).map(pair));
        let floor = runs.iter().map(|run| run.score.of(band).floor).fold(0.0, f64::max);
        Self { cost, curves: Family::ALL.map(curve), floor }
    }

    /// The smallest error that both reach.
    pub fn common_error(&self) -> Option<f64> {
        let [uniform, adaptive] = self.curves.each_ref().map(CostCurve::least_error);
        Some(uniform?.max(adaptive?))
    }

    /// The most that both have spent.
    pub fn common_cost(&self) -> Option<f64> {
        let [uniform, adaptive] = self.curves.each_ref().map(CostCurve::costs);
        let ([low_u, high_u], [low_a, high_a]) = (uniform?, adaptive?);
        let amount = high_u.min(high_a);
        (amount >= low_u.max(low_a)).then_some(amount)
    }
}

impl BandVerdict {
    /// From its contests, one for each kind of cost; `None` without an error that both reach.
    pub fn new(band: Band, contests: &[Contest], error: Option<f64>) -> Option<Self> {
        let first = contests.first()?;
        let error = error.or(first.common_error())?;
        let at_error = |contest: &Contest| AtEqualError {
            cost: contest.cost,
            error,
            needed: contest.curves.each_ref().map(|curve| curve.cost_for(error)),
        };
        let at_cost = |contest: &Contest| {
            let amount = contest.common_cost()?;
            let [uniform, adaptive] = contest.curves.each_ref().map(|curve| curve.error_at(amount));
            Some(AtEqualCost { cost: contest.cost, amount, errors: [uniform?, adaptive?] })
        };
        Some(Self {
            band,
            at_equal_error: contests.iter().map(at_error).collect(),
            at_equal_cost: contests.iter().filter_map(at_cost).collect(),
            slopes: Slopes { fitted: first.curves.each_ref().map(CostCurve::slope) },
            floor: first.floor,
        })
    }
}

impl AtEqualError {
    /// Uniform over adaptive: above one where adaptive costs less. With one that is known only to need no more
    /// than its cheapest run, a bound.
    pub fn ratio(&self) -> Option<f64> {
        let [uniform, adaptive] = self.needed.map(Needed::amount);
        Some(uniform? / adaptive?)
    }

    /// Who needs less.
    pub fn winner(&self) -> Winner {
        use Needed::{About, AtMost};
        match (self.needed, self.ratio()) {
            // What is known to be no more may be less than what it seems to lose against.
            ([AtMost(_), About(_)], Some(ratio)) if ratio > TIE => Winner::Unknown,
            ([About(_), AtMost(_)], Some(ratio)) if ratio < 1.0 / TIE => Winner::Unknown,
            ([AtMost(_), AtMost(_)], Some(ratio)) if winner(ratio) != Winner::Tie => {
                Winner::Unknown
            }
            (_, Some(ratio)) => winner(ratio),
            ([Needed::NotReached, Needed::NotReached], _) => Winner::Unknown,
            ([Needed::NotReached, _], _) => Winner::One(Family::Adaptive),
            _ => Winner::One(Family::Uniform),
        }
    }
}

impl AtEqualCost {
    /// Whose error is smaller; nobody's if both are below `floor`.
    pub fn winner(&self, floor: f64) -> Winner {
        let [uniform, adaptive] = self.errors.map(|error| error.max(floor));
        if uniform <= floor && adaptive <= floor {
            return Winner::Unknown;
        }
        winner(uniform / adaptive)
    }
}

fn winner(ratio: f64) -> Winner {
    if ratio > TIE {
        Winner::One(Family::Adaptive)
    } else if ratio < 1.0 / TIE {
        Winner::One(Family::Uniform)
    } else {
        Winner::Tie
    }
}

/// The theoretical slope nearest to one, and what it is of.
pub fn nearest_law(slope: f64) -> (f64, &'static str) {
    let gap = |law: &(f64, &str)| (law.0 - slope).abs();
    LAWS.into_iter().min_by(|a, b| gap(a).total_cmp(&gap(b))).unwrap_or(LAWS[0])
}
