//! Where the light of a shooter goes, and how near is near.

use crate::mesh::ElementId;

/// Elements nearer to each other than this many of their sizes exchange light by their parts.
///
/// At 1, two rooms joined by a door (medium) err by 0.83 % for 0.72 %; at 4, by 0.56 %, in 1.4 times the time.
pub(super) const NEAR: f64 = 2.0;

/// What is nearer to an element's centre than this share of its size is too close for the centre to
/// see for all of it.
///
/// At 0.2, the Cornell box (medium) is as it is; at 0.8, two rooms take 1.1 times the time and err no less.
pub(super) const CLOSE: f64 = 0.4;

/// An element looks by its parts if more than this share of its view is close.
///
/// At 0.025, shadows in two rooms (medium) err by 0.89 % for 0.78 %; at 0.1 nothing changes there.
pub(super) const CLOSE_SHARE: f64 = 0.05;

/// Where the light of one patch goes.
#[derive(Clone, Debug, Default)]
pub(super) struct Row {
    pub(super) links: Vec<Link>,
    /// Share of the light that meets nothing.
    pub(super) escaped: f64,
    /// Share of the light that meets the black backs of surfaces.
    pub(super) on_backs: f64,
    /// Factors from a point to a polygon that it took.
    pub(super) factors: u64,
}

/// An exchange of light between two elements.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub(super) source: ElementId,
    pub(super) receiver: ElementId,
    /// Form factor from source to receiver times the source's area, m².
    pub(super) exchange_area: f64,
}
