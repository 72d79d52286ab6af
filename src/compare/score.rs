//! How far a mesh is from the reference.

use rayon::prelude::*;
use serde::Serialize;

use super::locate::Locator;
use super::reference::{Point, Reference, Set};
use crate::colour::Rgb;
use crate::reconstruct::TriMesh;

/// Which places an error is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Band {
    /// The area set: all surfaces.
    All,
    /// The shadow set: along the edges of shadows.
    Shadow,
    /// What of the area set is not near the edge of a shadow.
    Rest,
}

impl Band {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::All, Self::Shadow, Self::Rest];

    /// What it is called in sentences.
    pub fn name(self) -> &'static str {
        match self {
            Self::All => "all surfaces",
            Self::Shadow => "shadow band",
            Self::Rest => "elsewhere",
        }
    }
}

/// Errors over a set of places, as shares of their mean radiosity; places count by their weight, channels alike.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ErrorStatistics {
    /// How many places.
    pub points: usize,
    /// Mean radiosity of the reference, W/m².
    pub mean: f64,
    /// Root mean square, the reference's own variance taken off.
    pub rmse: f64,
    /// Standard error of that by the choice of the places: other ones would give another.
    pub rmse_error: f64,
    /// Root mean square as measured, the reference's error included.
    pub raw_rmse: f64,
    /// Mean of the magnitudes (L1).
    pub mean_absolute: f64,
    /// Mean, with sign: above zero if the mesh has too much light.
    pub bias: f64,
    /// Half of the places are no farther off, by the mean of the channels' magnitudes.
    pub median: f64,
    /// 95 % are no farther off.
    pub p95: f64,
    /// None is farther off.
    pub max: f64,
    /// Root mean square of the reference's standard errors.
    pub noise: f64,
    /// A root mean square error below this is not resolved: twice the standard deviation, by chance, of the
    /// variance that is taken off, Σ w² se⁴ · 2 summed over places, to the power ¼.
    pub floor: f64,
}

impl ErrorStatistics {
    /// The root mean square error in per cent, or its floor if it is not resolved, and either in words; `None`
    /// without light.
    pub fn in_percent(&self) -> Option<(f64, String)> {
        let lies_below = self.rmse <= self.floor;
        let value = 100.0 * self.rmse.max(self.floor);
        let sign = if lies_below { "<" } else { "" };
        (self.mean > 0.0).then(|| (value, format!("{sign}{value:.2}")))
    }
}

/// A mesh against a reference.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Score {
    /// Over the area set.
    pub all: ErrorStatistics,
    /// Over the shadow set.
    pub shadow: ErrorStatistics,
    /// Over what of the area set is not in the shadow band.
    pub rest: ErrorStatistics,
    /// Places that no triangle is near; they count as black.
    pub unmatched: usize,
    /// By point of the reference: radiosity of the mesh, W/m²; `None` where no triangle is near.
    #[serde(skip)]
    pub found: Vec<Option<Rgb>>,
    /// The same minus the reference's.
    #[serde(skip)]
    pub signed: Vec<Rgb>,
}

impl Score {
    /// The errors over one of the sets.
    pub fn of(&self, band: Band) -> &ErrorStatistics {
        match band {
            Band::All => &self.all,
            Band::Shadow => &self.shadow,
            Band::Rest => &self.rest,
        }
    }

    /// Of a mesh with these radiosities, W/m², at the points of the reference, in their order; `None` where it has no
    /// triangle.
    pub fn new(reference: &Reference, found: Vec<Option<Rgb>>) -> Self {
        let points = &reference.points;
        let signed: Vec<Rgb> =
            found.iter().zip(points).map(|(b, p)| b.unwrap_or(Rgb::ZERO) - p.radiosity).collect();
        let errors = |chosen: &dyn Fn(usize) -> bool| {
            let chosen = (0..points.len()).filter(|&k| chosen(k));
            let deviation = |k: usize| Deviation { point: &points[k], excess: signed[k] };
            errors(&chosen.map(deviation).collect::<Vec<_>>())
        };
        let is = |set: Set| move |k: usize| points[k].set == set;
        Self {
            all: errors(&is(Set::Area)),
            shadow: errors(&is(Set::Shadow)),
            rest: errors(&|k| points[k].set == Set::Area && !reference.in_band[k]),
            unmatched: found.iter().filter(|b| b.is_none()).count(),
            found,
            signed,
        }
    }
}

/// The errors of the mesh of a scene of this extent, m, at the places of a reference.
pub fn score(reference: &Reference, mesh: &TriMesh, extent: f64) -> Score {
    let locator = Locator::new(mesh, extent);
    let find =
        |point: &Point| locator.radiosity(point.place, point.normal).filter(|b| b.is_finite());
    Score::new(reference, reference.points.par_iter().map(find).collect())
}

/// A place of the reference, and what the mesh has too much there.
struct Deviation<'a> {
    point: &'a Point,
    /// W/m².
    excess: Rgb,
}

/// A value that counts as much as its weight.
struct Weighted {
    value: f64,
    weight: f64,
}

fn errors(deviations: &[Deviation<'_>]) -> ErrorStatistics {
    let points = deviations.iter().map(|deviation| deviation.point);
    let total: f64 = points.map(|point| point.weight).sum();
    let share = |point: &Point| point.weight / total;
    let mean_of = |value: &dyn Fn(&Point, Rgb) -> f64| {
        let terms = deviations.iter().map(|d| share(d.point) * value(d.point, d.excess));
        terms.sum::<f64>()
    };
    let mean = mean_of(&|point, _| grey(point.radiosity));
    if deviations.is_empty() || mean <= 0.0 {
        return ErrorStatistics { points: deviations.len(), ..ErrorStatistics::default() };
    }
    let square = mean_of(&|_, d| grey(d * d));
    let variance = mean_of(&|point, _| grey(point.error * point.error));
    let luck =
        |d: &Deviation<'_>| 2.0 * (share(d.point) * grey(d.point.error * d.point.error)).powi(2);
    let luck = deviations.iter().map(luck).sum::<f64>().sqrt();
    let chance =
        |d: &Deviation<'_>| (share(d.point) * (grey(d.excess * d.excess) - square)).powi(2);
    let chance = deviations.iter().map(chance).sum::<f64>().sqrt();
    let rmse = (square - variance).max(0.0).sqrt() / mean;
    let size =
        |d: &Deviation<'_>| Weighted { value: grey(d.excess.abs()) / mean, weight: share(d.point) };
    let mut sizes: Vec<Weighted> = deviations.iter().map(size).collect();
    sizes.sort_by(|a, b| a.value.total_cmp(&b.value));
    ErrorStatistics {
        points: deviations.len(),
        mean,
        rmse,
        rmse_error: spread_of_root(rmse, chance / (mean * mean)),
        raw_rmse: square.sqrt() / mean,
        mean_absolute: mean_of(&|_, d| grey(d.abs())) / mean,
        bias: mean_of(&|_, d| grey(d)) / mean,
        median: quantile(&sizes, 0.5),
        p95: quantile(&sizes, 0.95),
        max: sizes.last().map_or(0.0, |size| size.value),
        noise: variance.sqrt() / mean,
        floor: (2.0 * luck).sqrt() / mean,
    }
}

/// Standard error of a root whose square has this one: δx = δ(x²) / 2x, but no more than the root of δ(x²).
fn spread_of_root(root: f64, spread: f64) -> f64 {
    if spread >= 4.0 * root * root { spread.sqrt() } else { spread / (2.0 * root) }
}

/// Mean of the channels.
fn grey(colour: Rgb) -> f64 {
    colour.element_sum() / 3.0
}

/// The value below which this share of the weight is; values ascend.
fn quantile(values: &[Weighted], share: f64) -> f64 {
    let mut sum = 0.0;
    let reached = values.iter().find(|one| {
        sum += one.weight;
        sum >= share
    });
    reached.or(values.last()).map_or(0.0, |one| one.value)
}
