//! How well a matrix of form factors keeps the laws, and whether its scene is closed.

use std::fmt::{self, Display, Formatter};

use radiosity::export::FactorPatch;
use radiosity::form_factor::{Assembled, FormFactors};
use serde::Serialize;

/// A scene of whose light less than this share escapes is closed.
const CLOSED: f64 = 0.01;

/// Light on backs above this share is told.
const BURIED: f64 = 0.5;

/// A matrix in figures.
#[derive(Debug, Serialize)]
pub(crate) struct Enclosure {
    #[serde(skip)]
    pub(crate) factors: FormFactors,
    #[serde(skip)]
    on_backs: Vec<f64>,
    patches: usize,
    /// Factors above zero.
    factors_above_zero: usize,
    /// Rows that were computed; the others are empty.
    rows: usize,
    /// Largest difference of a row's sum, light on black backs included, from one.
    closure: f64,
    /// Largest relative difference of `A[i] F[i][j]` and `A[j] F[j][i]`, of factors above 1e-4.
    reciprocity: f64,
    /// Share of all light that meets nothing, if each patch emitted the same per area; negative if
    /// rows sum to more than one.
    escaping: f64,
    /// The object that loses most, and its share.
    leakiest: (String, f64),
    /// Patches most of whose light ends on black backs: they lie inside solids.
    buried: usize,
    enforced: bool,
}

impl Enclosure {
    pub(crate) fn new(assembled: Assembled, patches: &[FactorPatch]) -> Self {
        let Assembled { factors, on_backs, rows } = assembled;
        let missing = missing(&factors, &on_backs);
        let missing = &missing[..rows];
        let areas = &factors.areas()[..rows];
        let leakiest = by_object(missing, patches);
        Self {
            patches: factors.len(),
            factors_above_zero: (0..factors.len()).map(|i| factors.row(i).count()).sum(),
            rows,
            closure: missing.iter().map(|share| share.abs()).fold(0.0, f64::max),
            reciprocity: factors.reciprocity(),
            escaping: missing.iter().zip(areas).map(|(share, area)| share * area).sum::<f64>()
                / areas.iter().sum::<f64>().max(f64::MIN_POSITIVE),
            leakiest,
            buried: on_backs.iter().filter(|&&share| share > BURIED).count(),
            enforced: false,
            factors,
            on_backs,
        }
    }

    /// The same scene with a matrix that keeps the laws: reciprocity always, closure if it is closed.
    pub(crate) fn enforced(self) -> Self {
        let sums = if self.is_closed() {
            self.on_backs.iter().map(|share| 1.0 - share).collect()
        } else {
            self.factors.row_sums().into_iter().map(|sum| sum.min(1.0)).collect::<Vec<f64>>()
        };
        let factors = self.factors.enforced(&sums);
        let missing = missing(&factors, &self.on_backs);
        Self {
            closure: missing.iter().map(|share| share.abs()).fold(0.0, f64::max),
            reciprocity: factors.reciprocity(),
            enforced: true,
            factors,
            ..self
        }
    }

    fn is_closed(&self) -> bool {
        self.escaping < CLOSED && self.rows == self.patches
    }
}

/// What each row lacks to one.
fn missing(factors: &FormFactors, on_backs: &[f64]) -> Vec<f64> {
    factors.row_sums().iter().zip(on_backs).map(|(sum, backs)| 1.0 - sum - backs).collect()
}

/// The object whose patches lose the largest share of their light.
fn by_object(missing: &[f64], patches: &[FactorPatch]) -> (String, f64) {
    let mut objects: std::collections::BTreeMap<&str, [f64; 2]> = Default::default();
    for (share, patch) in missing.iter().zip(patches) {
        let sums = objects.entry(&patch.object).or_default();
        *sums = [sums[0] + share * patch.area, sums[1] + patch.area];
    }
    let shares = objects.into_iter().map(|(name, [lost, area])| (name.to_owned(), lost / area));
    shares.max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or_default()
}

impl Display for Enclosure {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let all = (self.patches * self.patches).max(1) as f64;
        let share = 100.0 * self.factors_above_zero as f64 / all;
        writeln!(f, "patches      {}", self.patches)?;
        writeln!(f, "factors      {} above zero, {share:.0} % of all", self.factors_above_zero)?;
        if self.rows < self.patches {
            return write!(f, "unfinished   after {} rows; the others are empty", self.rows);
        }
        writeln!(f, "closure      rows sum to 1 within {:.1e}", self.closure)?;
        writeln!(f, "reciprocity  kept within {:.1e}, of factors above 1e-4", self.reciprocity)?;
        if self.buried > 0 {
            writeln!(f, "buried       {} patches look at black backs mostly", self.buried)?;
        }
        if self.is_closed() {
            return write!(f, "enclosure    closed");
        }
        let (object, worst) = &self.leakiest;
        write!(
            f,
            "enclosure    this scene is not closed: {:.1} % of all light escapes, {:.0} % of that of {object}",
            100.0 * self.escaping,
            100.0 * worst
        )?;
        if self.enforced {
            write!(f, "; only reciprocity was enforced")?;
        }
        Ok(())
    }
}
