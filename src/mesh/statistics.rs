//! What a mesh is made of: how deep, how large, and why.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

use serde::Serialize;

use super::ids::ElementId;
use super::topology::{Mesh, Reason};

/// Elements divided, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Divided {
    /// For a uniform mesh.
    pub uniform: usize,
    /// Because light varies.
    pub gradient: usize,
    /// Because a light is seen from one part and not from another.
    pub shadow_edge: usize,
    /// Because of steep light beside a contact line.
    pub contact: usize,
    /// Along a line on which direct light has a kink or a bend.
    pub discontinuity: usize,
}

impl Display for Divided {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { uniform, gradient, shadow_edge, contact, discontinuity } = self;
        write!(f, "gradient {gradient}, shadow edge {shadow_edge}, ")?;
        write!(f, "discontinuity line {discontinuity}, contact {contact}, uniform {uniform}")
    }
}

/// Leaves of about the same size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SizeBin {
    /// Smallest size, the square root of the area, m; the largest is twice that.
    pub from: f64,
    /// How many there are.
    pub leaves: usize,
}

impl Mesh {
    /// How many elements have been divided for which reason.
    pub fn divided(&self) -> Divided {
        let mut divided = Divided::default();
        for reason in self.elements.iter().filter_map(|element| element.reason) {
            *match reason {
                Reason::Uniform => &mut divided.uniform,
                Reason::Gradient => &mut divided.gradient,
                Reason::ShadowEdge => &mut divided.shadow_edge,
                Reason::Contact => &mut divided.contact,
                Reason::Discontinuity => &mut divided.discontinuity,
            } += 1;
        }
        divided
    }

    /// How many leaves there are on each level, from 0 to the deepest.
    pub fn leaves_by_level(&self) -> Vec<usize> {
        let mut counts = Vec::new();
        for leaf in self.leaves() {
            let level = self[leaf].level as usize;
            counts.resize(counts.len().max(level + 1), 0);
            counts[level] += 1;
        }
        counts
    }

    /// How many leaves there are of each size, by octaves of one over powers of two of a metre, from the
    /// smallest; empty octaves in between included. Leaves without area are left out.
    pub fn leaves_by_size(&self) -> Vec<SizeBin> {
        let octave = |leaf: ElementId| self[leaf].area.sqrt().log2().floor();
        let octaves = self.leaves().map(octave).filter(|octave| octave.is_finite());
        let mut counts: BTreeMap<i32, usize> = BTreeMap::new();
        octaves.for_each(|octave| *counts.entry(octave as i32).or_default() += 1);
        let (first, last) = (counts.first_key_value(), counts.last_key_value());
        let Some((&first, &last)) = first.map(|(k, _)| k).zip(last.map(|(k, _)| k)) else {
            return Vec::new();
        };
        let bin = |octave: i32| SizeBin {
            from: f64::from(octave).exp2(),
            leaves: counts.get(&octave).copied().unwrap_or(0),
        };
        (first..=last).map(bin).collect()
    }
}
