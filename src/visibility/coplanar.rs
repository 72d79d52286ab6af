//! What lies in one plane: which of two faces there is seen, and from how high a face is seen at all.
//!
//! Rays through the hierarchy of patches and the projection of patches on hemicubes take both from here, so that they
//! agree on what an eye sees.

use crate::mesh::Patch;

/// Factor on the nearness of backs: of two faces back to back in one place, the front one must win
/// over rounding.
pub(crate) const RECESS: f64 = 1.0 - 1e-5;

/// Rounding of heights over planes, m and as a share of the largest coordinate.
const HAIR: [f64; 2] = [1e-11, 4e-15];

/// How high over the plane of a patch an eye must be, m: what is in one plane with it is seen edge-on, that is, not at
/// all, whatever rounding makes of it.
pub(crate) fn hair(patches: &[Patch]) -> f64 {
    let corners = patches.iter().flat_map(|patch| &patch.corners);
    let farthest = corners.map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
    HAIR[0].max(HAIR[1] * farthest)
}
