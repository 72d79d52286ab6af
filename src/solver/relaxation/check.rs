//! What cannot converge is refused.

use std::fmt::Display;

use crate::colour::Rgb;
use crate::error::{Error, Result};

/// Whether a reflectance lets light die away, at least where some of it escapes.
pub(crate) fn check_reflectance(reflectance: Rgb, owner: impl Display) -> Result<()> {
    let refuse = |value: f64, advice: &str| {
        Err(Error::Scene(format!("reflectance {value} of {owner}: {advice}")))
    };
    if !reflectance.is_finite() {
        return refuse(reflectance.element_sum(), "use a number from 0 to below 1");
    }
    if reflectance.min_element() < 0.0 {
        return refuse(reflectance.min_element(), "use a number from 0 to below 1");
    }
    if reflectance.max_element() >= 1.0 {
        let advice = "light would grow without end; use less than 1";
        return refuse(reflectance.max_element(), advice);
    }
    Ok(())
}

/// Whether a row of |ρ F| sums to less than 1. The largest sum bounds the spectral radius, so that
/// light dies away if all do.
pub(super) fn check_row(patch: usize, reflectance: Rgb, sum: f64) -> Result<()> {
    let largest = reflectance.max_element();
    if largest * sum < 1.0 {
        return Ok(());
    }
    if !sum.is_finite() {
        return Err(Error::Scene(format!("form factors of patch {patch}: one is no number")));
    }
    Err(Error::Scene(format!(
        "reflectance {largest} of patch {patch}, whose form factors sum to {sum}: light would grow \
         without end; use less than {}",
        1.0 / sum
    )))
}

/// Whether an exitance is a number.
pub(super) fn check_exitance(patch: usize, exitance: Rgb) -> Result<()> {
    if exitance.is_finite() {
        return Ok(());
    }
    Err(Error::Scene(format!("exitance {exitance} of patch {patch}: use numbers")))
}
