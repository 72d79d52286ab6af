//! Axes of curves: where values are along them, and which of them have numbers.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

use crate::render::map::{linear_marks, logarithmic_marks};

/// How far logarithmic axes reach beyond the values, as a factor.
const MARGIN: f64 = 1.3;

/// Where values are along an axis, and which of them have numbers.
pub(super) struct AxisSpec {
    ends: [f64; 2],
    logarithmic: bool,
    marks: Vec<f64>,
}

impl AxisSpec {
    /// From the least to the greatest of the values, zero included, with some air above; `None` without values.
    pub(super) fn linear(values: impl Iterator<Item = f64>, count: usize) -> Option<Self> {
        let [low, high] = ends(values)?;
        let low = low.min(0.0);
        // What is nothing but zero has an axis, too.
        let ends = [low, if high > low { high * 1.05 } else { low + 1.0 }];
        Some(Self { ends, logarithmic: false, marks: linear_marks(ends, count) })
    }

    /// From the least to the greatest of the values above zero, with some air at both ends; `None` without such.
    pub(super) fn logarithmic(values: impl Iterator<Item = f64>, count: usize) -> Option<Self> {
        let [low, high] = ends(values.filter(|&value| value > 0.0))?;
        let ends = [low / MARGIN, high * MARGIN];
        Some(Self { ends, logarithmic: true, marks: logarithmic_marks(ends, count) })
    }
}

/// The least and the greatest of the values that are finite.
fn ends(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let span = |[low, high]: [f64; 2], [least, most]: [f64; 2]| [low.min(least), high.max(most)];
    values.filter(|value| value.is_finite()).map(|value| [value; 2]).reduce(span)
}

impl Ranged for AxisSpec {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (first, last): (i32, i32)) -> i32 {
        let [low, high] = self.ends;
        let share = match self.logarithmic {
            true => (value / low).ln() / (high / low).ln(),
            false => (value - low) / (high - low),
        };
        first + (share * f64::from(last - first)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.marks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.ends[0]..self.ends[1]
    }
}
