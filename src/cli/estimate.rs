//! What to expect of a solution before work begins.

use std::fmt::{self, Display, Formatter};

use radiosity::mesh::{Mesh, patch_counts};
use radiosity::{Settings, Surfaces};

use super::memory::Needs;

/// Elements to a patch that rooms have at the tolerance [`PLAIN`].
const PER_PATCH: f64 = 18.0;
const PLAIN: f64 = 0.02;

/// Measured rooms have so many times as many elements, from empty ones to those with much in them.
const RANGE: [f64; 2] = [0.5, 1.9];

/// Surfaces of this share of a patch's size, as of curved things, are seldom divided.
const FACET: f64 = 0.5;

/// How their number grows as the tolerance shrinks.
const GROWTH: f64 = 0.7;

/// Memory may be so many times what was measured.
const MEMORY_RANGE: [f64; 2] = [0.75, 1.4];

/// Fewer surfaces than this hide nothing from each other: no shadow asks for elements.
const FEW_SURFACES: usize = 3;

/// What a solution will be made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CostEstimate {
    /// All but elements.
    needs: Needs,
    /// Fewest and most elements.
    elements: [usize; 2],
}

impl CostEstimate {
    /// Of what is needed before there are patches, and what becomes of `surfaces`.
    pub(crate) fn new(surfaces: &Surfaces, settings: &Settings, needs: Needs) -> Self {
        let counts = patch_counts(surfaces, settings);
        let patches: usize = counts.iter().sum();
        let needs = Needs { patches, ..needs };
        if settings.uniform.is_some() {
            let elements = Mesh::new(surfaces, settings).elements.len();
            return Self { needs, elements: [elements; 2] };
        }
        let small = FACET * settings.patch_length(surfaces.extent);
        // Facets are lit as their neighbours are, and what lamps emit hides what arrives at them.
        let stays_whole = |surface: &radiosity::surface::Surface| {
            surface.extent() <= small || surface.is_emitter() || !surface.reflects()
        };
        let whole = surfaces.list.iter().zip(&counts).filter(|(surface, _)| stays_whole(surface));
        let whole: usize = whole.map(|(_, count)| count).sum();
        let each = PER_PATCH * (PLAIN / settings.tolerance).powf(GROWTH);
        let divided = |range: f64| ((patches - whole) as f64 * (each * range).max(1.0)) as usize;
        let [low, high] = RANGE.map(divided);
        // The sky may light all alike.
        let may_be_even = surfaces.list.len() < FEW_SURFACES
            || !surfaces.list.iter().any(|surface| surface.is_emitter());
        let low = if may_be_even { patches - whole } else { low };
        // Some facets, of cylinders above all, are long enough for a shadow's edge to matter.
        Self { needs, elements: [whole + low, whole * 2 + high] }
    }

    /// What is needed if nothing is divided.
    pub(crate) fn least(&self) -> Needs {
        Needs { elements: self.needs.patches, ..self.needs }
    }

    /// Least and most memory, bytes.
    fn memory(&self) -> [u64; 2] {
        [0, 1].map(|k| {
            let bytes = Needs { elements: self.elements[k], ..self.needs }.bytes();
            (bytes as f64 * MEMORY_RANGE[k]) as u64
        })
    }
}

impl Display for CostEstimate {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let patches = self.needs.patches;
        let elements = match self.elements {
            [low, high] if low == high => format!("{low}"),
            [low, high] => format!("{} to {}", rounded(low, false), rounded(high, true)),
        };
        let [least, most] = self.memory().map(|bytes| bytes.div_ceil(1_000_000));
        write!(f, "{patches} patches; expecting {elements} elements, {least} to {most} MB")
    }
}

/// A number to two digits, up or down.
fn rounded(number: usize, up: bool) -> usize {
    let unit = 10_usize.pow(number.max(1).ilog10().saturating_sub(1));
    if up { number.next_multiple_of(unit) } else { number / unit * unit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_rounded_outwards() {
        assert_eq!([rounded(12_345, false), rounded(12_345, true)], [12_000, 13_000]);
        assert_eq!([rounded(7, false), rounded(7, true), rounded(0, false)], [7, 7, 0]);
    }
}
