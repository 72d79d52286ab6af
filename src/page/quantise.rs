//! Numbers in few bits, with known errors.

use glam::DVec3;

use crate::colour::Rgb;

/// Bits of a channel's mantissa, and what is subtracted from the shared exponent.
const MANTISSA: i32 = 9;
const BIAS: i32 = 15;

/// Exponent of the largest unit-free value; one below what the format holds, for rounding's sake.
const TOP_EXPONENT: i32 = 14;

/// Errors beyond this are shown as this: 400 %.
const LARGEST_ERROR: f64 = 4.0;

/// Relative error that one step of a quantised error stands for.
pub(super) const ERROR_STEP: f64 = LARGEST_ERROR / i16::MAX as f64;

/// Largest number of a quantised coordinate.
const FINEST: f64 = u16::MAX as f64;

/// The point at `low` + q/65535 · `size` nearest to `point` in a box.
pub(super) fn position(point: DVec3, low: DVec3, size: DVec3) -> [u16; 3] {
    let share = ((point - low) / size).to_array();
    share.map(|share| if share.is_finite() { (share * FINEST).round() as u16 } else { 0 })
}

/// The power of two, W/m², that colours up to `peak`, W/m², are best counted in.
pub(super) fn unit(peak: f64) -> f64 {
    if peak.is_normal() { 2.0_f64.powi(exponent_of(peak) - TOP_EXPONENT) } else { 1.0 }
}

/// A colour in the shared-exponent format [RGB9E5], red in the lowest bits, in multiples of `unit`,
/// by which no channel may be 2^15 or more. What is below zero or no number becomes zero.
///
/// Channels are within 2^-9 of the largest, as long as that is at least 2^-15 units.
///
/// [RGB9E5]: https://registry.khronos.org/OpenGL/extensions/EXT/EXT_texture_shared_exponent.txt
pub(super) fn colour(colour: Rgb, unit: f64) -> u32 {
    let channels = colour.to_array().map(|c| if c > 0.0 { (c / unit).min(32767.0) } else { 0.0 });
    let largest = channels.into_iter().fold(0.0, f64::max);
    let mut shared = if largest > 0.0 { exponent_of(largest).max(-1 - BIAS) + 1 + BIAS } else { 0 };
    let step = |shared: i32| 2.0_f64.powi(shared - BIAS - MANTISSA);
    if (largest / step(shared)).round() as u32 == 1 << MANTISSA {
        shared += 1;
    }
    let [red, green, blue] = channels.map(|c| (c / step(shared)).round() as u32);
    red | green << 9 | blue << 18 | (shared as u32) << 27
}

/// A relative error in steps of [`ERROR_STEP`].
pub(super) fn error(error: f64) -> i16 {
    (error / ERROR_STEP).round() as i16
}

/// Floor of the binary logarithm of a normal number.
fn exponent_of(value: f64) -> i32 {
    ((value.to_bits() >> 52) & 0x7ff) as i32 - 1023
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// What model.js makes of a packed colour.
    fn unpacked(packed: u32, unit: f64) -> Rgb {
        let step = unit * 2.0_f64.powi((packed >> 27) as i32 - 24);
        Rgb::from_array([0, 9, 18].map(|shift| f64::from(packed >> shift & 511) * step))
    }

    proptest! {
        #[test]
        fn colours_are_within_a_five_hundred_and_twelfth_of_their_largest_channel(
            largest in -20.0..20.0_f64,
            shares in prop::array::uniform3(0.0..=1.0_f64),
            brighter in 1.0..1e6_f64,
        ) {
            let colour_in = Rgb::from_array(shares) * 10.0_f64.powf(largest);
            let peak = colour_in.max_element();
            let unit = unit(peak * brighter);
            let error = (unpacked(colour(colour_in, unit), unit) - colour_in).abs().max_element();
            prop_assert!(error <= peak * 2.0_f64.powi(-9), "{error} of {peak}");
        }

        #[test]
        fn positions_are_within_a_step_of_the_box(
            low in prop::array::uniform3(-1e3..1e3_f64),
            size in prop::array::uniform3(0.0..1e3_f64),
            shares in prop::array::uniform3(0.0..=1.0_f64),
        ) {
            let [low, size] = [low, size].map(DVec3::from_array);
            let point = low + size * DVec3::from_array(shares);
            let coded = DVec3::from_array(position(point, low, size).map(f64::from));
            let error = (low + size * coded / FINEST - point).abs();
            prop_assert!((error - size / FINEST).max_element() <= 1e-9, "{error}");
        }

        #[test]
        fn errors_are_within_half_a_step(value in -LARGEST_ERROR..=LARGEST_ERROR) {
            let decoded = f64::from(error(value)) * ERROR_STEP;
            prop_assert!((decoded - value).abs() <= 0.5001 * ERROR_STEP);
        }
    }

    #[test]
    fn what_is_no_light_is_dark() {
        for value in [f64::NAN, -1.0, 0.0] {
            assert_eq!(unpacked(colour(Rgb::splat(value), 1.0), 1.0), Rgb::ZERO);
        }
        assert_eq!((unit(0.0), unit(f64::NAN), error(f64::NAN)), (1.0, 1.0, 0));
    }

    #[test]
    fn beyond_the_largest_number_is_the_largest() {
        assert_eq!((error(1e9), error(-1e9)), (i16::MAX, i16::MIN));
        let bright = unpacked(colour(Rgb::splat(f64::INFINITY), 1.0), 1.0);
        assert!(bright.is_finite() && bright.x > 32_000.0, "{bright}");
    }
}
