//! What a look says of a patch.

use super::item_buffer::NOTHING;
use crate::mesh::PatchId;

/// What a patch that was drawn has come to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coverage {
    /// Sum of the delta factors of the cells it covers.
    pub(super) covered: f32,
    /// Sum of those of the cells it kept.
    pub(super) kept: f32,
    /// The last of its spans, or [`NOTHING`].
    pub(super) last: u32,
}

impl Coverage {
    pub(super) const NONE: Self = Self { covered: 0.0, kept: 0.0, last: NOTHING };
}

/// A patch that a point sees, or might see if its view were clearer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisiblePatch {
    /// The patch.
    pub patch: PatchId,
    /// Share of its projection that nothing hides, 0..=1; where patches outnumber cells, what `delta`
    /// is of its form factor, which for a patch smaller than a cell may be more than 1.
    pub visible: f64,
    /// Sum of the delta factors of the cells it kept.
    pub delta: f64,
    /// True if its front is seen; its back is black.
    pub front: bool,
}

/// The cells of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchCoverage {
    /// The patch.
    pub patch: PatchId,
    /// Sum of the delta factors of the cells that it covers; of a look by rays, its form factor.
    pub covered: f64,
    /// Sum of those of the cells that it kept.
    pub kept: f64,
    /// True if its front is seen.
    pub front: bool,
}
