//! What to expect of a solution before work begins.

use std::fmt::{self, Display, Formatter};

use radiosity::mesh::Mesh;
use radiosity::{Settings, Surfaces};

use super::options::memory;

/// Elements to a patch that rooms have at the tolerance [`PLAIN`], within a factor of two.
const PER_PATCH: f64 = 15.0;
const PLAIN: f64 = 0.02;

/// Surfaces of this share of a patch's size, as of curved things, are seldom divided.
const FACET: f64 = 0.5;

/// How their number grows as the tolerance shrinks.
const GROWTH: f64 = 0.6;

/// What a solution will be made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Estimate {
    patches: usize,
    elements: usize,
    /// True if the number of elements is certain.
    exact: bool,
}

impl Estimate {
    pub(crate) fn new(surfaces: &Surfaces, settings: &Settings) -> Self {
        let mesh = Mesh::new(surfaces, settings);
        let patches = mesh.patches.len();
        if settings.uniform.is_some() {
            return Self { patches, elements: mesh.leaves().count(), exact: true };
        }
        let small = FACET * settings.patch_length(surfaces.extent);
        let facets: Vec<bool> = surfaces.list.iter().map(|s| s.extent() <= small).collect();
        let whole = mesh.patches.iter().filter(|patch| facets[patch.surface as usize]).count();
        let finer = (PLAIN / settings.tolerance).powf(GROWTH);
        let divided = ((patches - whole) as f64 * (PER_PATCH * finer).max(1.0)) as usize;
        Self { patches, elements: whole + divided, exact: false }
    }
}

impl Display for Estimate {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { patches, elements, exact } = *self;
        let some = if exact { "" } else { "some " };
        let megabytes = memory(elements) / 1_000_000;
        write!(f, "{patches} patches; expecting {some}{elements} elements, {megabytes} MB")
    }
}
