//! The scale of a legend: from values to places along it, and round numbers to mark it with.

/// Ratio of the ends above which a scale is logarithmic, since a linear one would show most of
/// the picture in one colour.
const LOGARITHMIC_RATIO: f64 = 30.0;

/// Least lower end of a logarithmic scale as a share of the upper end.
const LEAST_SHARE: f64 = 1e-4;

/// Values from `low` to `high`, `low < high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    logarithmic: bool,
}

impl Scale {
    /// A scale from `low` to `high`, logarithmic if they differ much; linear scales begin at 0
    /// unless the values differ little.
    pub(super) fn of_values(low: f64, high: f64) -> Self {
        if !(high.is_finite() && high > 0.0) {
            return Self { low: 0.0, high: 1.0, logarithmic: false };
        }
        if high > LOGARITHMIC_RATIO * low {
            return Self { low: low.max(LEAST_SHARE * high), high, logarithmic: true };
        }
        let low = if high > 1.5 * low && high < f64::MAX { 0.0 } else { low };
        Self::between(low, high)
    }

    /// A scale with the ends that the user gave, in any order.
    pub(super) fn between(low: f64, high: f64) -> Self {
        let (low, high) = (low.min(high), low.max(high));
        let logarithmic = low > 0.0 && high > LOGARITHMIC_RATIO * low;
        let high = if high - low > 1e-9 * high.abs() { high } else { low + low.abs().max(1e-9) };
        Self { low, high, logarithmic }
    }

    /// The upper end.
    pub(super) fn high(&self) -> f64 {
        self.high
    }

    /// Place of `value` along the scale, 0..=1; values beyond the ends are at the ends.
    pub(super) fn place(&self, value: f64) -> f64 {
        let part = if self.logarithmic {
            (value.max(self.low) / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        part.clamp(0.0, 1.0)
    }

    /// Round values on the scale, in rising order: two at least, and beyond those no more than `count`.
    pub(super) fn marks(&self, count: usize) -> Vec<f64> {
        let ends = [self.low, self.high];
        if self.logarithmic { logarithmic_marks(ends, count) } else { linear_marks(ends, count) }
    }
}

/// Multiples of 1, 2 or 5 times a power of ten from `low` to `high`, `low < high`: two at least, and beyond those no
/// more than `count`.
pub(crate) fn linear_marks([low, high]: [f64; 2], count: usize) -> Vec<f64> {
    let mut step = round_above((high - low) / count.max(2) as f64);
    loop {
        let first = (low / step - 1e-9).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        // Steps that are too small to be told apart would go on for ever.
        if last > first || step < 1e-12 * high.abs() {
            return (first..=last).map(|index| index as f64 * step).collect();
        }
        step = round_above(step / 2.5);
    }
}

/// Round values from `low` to `high`, `0 < low < high`, for a logarithmic scale: 1, 2 and 5 of every decade, or if
/// those are more than `count`, 1 of every decade, of every second, and so on. Two at least: where the ends are nearer
/// to each other than that, they are [`linear_marks`].
pub(crate) fn logarithmic_marks(ends: [f64; 2], count: usize) -> Vec<f64> {
    let thirds = decade_marks(ends, &[1.0, 2.0, 5.0], 1);
    if thirds.len() < 2 {
        return linear_marks(ends, count);
    }
    let decades = (ends[1] / ends[0]).log10().ceil() as i32 + 1;
    let sparser = (1..=decades).map(|stride| decade_marks(ends, &[1.0], stride));
    let several = std::iter::once(thirds).chain(sparser).take_while(|marks| marks.len() >= 2);
    let mut sparsest = Vec::new();
    for marks in several {
        sparsest = marks;
        if sparsest.len() <= count {
            break;
        }
    }
    sparsest
}

/// These digits in every decade whose exponent is a multiple of `stride`.
fn decade_marks([low, high]: [f64; 2], digits: &[f64], stride: i32) -> Vec<f64> {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    (first..=last)
        .filter(|exponent| exponent % stride == 0)
        .flat_map(|exponent| digits.iter().map(move |digit| digit * 10_f64.powi(exponent)))
        .filter(|mark| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(mark))
        .collect()
}

/// The least of 1, 2, 5 times a power of ten that is not below `value`, which is positive.
pub(crate) fn round_above(value: f64) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    let digit = [1.0, 2.0, 5.0].into_iter().find(|digit| digit * power >= value * (1.0 - 1e-9));
    digit.unwrap_or(10.0) * power
}

/// `value` with three digits that count, without trailing zeros.
pub(crate) fn short_number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&magnitude) {
        let text = format!("{value:.2e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", without_trailing_zeros(digits));
    }
    let decimals = (2.0 - magnitude.log10().floor()).max(0.0) as usize;
    without_trailing_zeros(&format!("{value:.decimals$}")).to_owned()
}

fn without_trailing_zeros(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (0.5, "0.5"),
            (1234.56, "1235"),
            (0.012345, "0.0123"),
            (20.0, "20"),
            (1.0e-5, "1e-5"),
            (2.5e7, "2.5e7"),
        ] {
            assert_eq!(short_number(value), text);
        }
    }

    #[test]
    fn a_wide_range_is_logarithmic_and_a_narrow_one_linear() {
        assert!((Scale::of_values(0.01, 100.0).place(1.0) - 0.5).abs() < 1e-12);
        assert!((Scale::of_values(1.0, 10.0).place(5.0) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn darkness_has_a_scale() {
        assert_eq!(Scale::of_values(0.0, 0.0).place(0.0), 0.0);
    }

    proptest! {
        #[test]
        fn marks_are_two_at_least_and_few_and_rise_along_the_scale(
            low in 0.0..1e3_f64, span in 1e-3..1e6_f64, count in 2_usize..12,
        ) {
            let scale = Scale::of_values(low, low + span);
            let marks = scale.marks(count);
            prop_assert!((2..=count.max(6)).contains(&marks.len()), "{:?}", marks);
            prop_assert!(marks.windows(2).all(|pair| scale.place(pair[0]) < scale.place(pair[1])));
            prop_assert!(marks[0] >= scale.low * (1.0 - 1e-6) - 1e-9 && marks[marks.len() - 1] <= scale.high * (1.0 + 1e-6));
        }

        #[test]
        fn ends_of_any_ratio_have_two_marks(low in 1e-6..1e6_f64, decades in 1e-3..12.0_f64, count in 2_usize..12) {
            let high = low * 10_f64.powf(decades);
            let marks = logarithmic_marks([low, high], count);
            prop_assert!((2..=count.max(6)).contains(&marks.len()), "{:?}", marks);
            prop_assert!(marks.windows(2).all(|pair| pair[0] < pair[1]));
        }

        #[test]
        fn places_are_on_the_scale_and_rise(low in 0.0..10.0_f64, high in 0.0..10.0_f64, a in -1.0..20.0_f64, b in -1.0..20.0_f64) {
            let scale = Scale::between(low, high);
            let (below, above) = (scale.place(a.min(b)), scale.place(a.max(b)));
            prop_assert!(0.0 <= below && below <= above && above <= 1.0);
        }
    }
}
