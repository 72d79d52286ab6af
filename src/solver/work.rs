//! What a solution has cost, in counts that are the same on every machine.

use serde::Serialize;

/// Factors from a point to a polygon, by the formula of Lambert, and rays; whatever they were for.
///
/// Hemicubes are counted beside ([`Solution::hemicubes`](super::Solution::hemicubes)): they tell what is
/// visible, and these how much light that is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Work {
    /// Direct light: one for each pair of a place and an emitter, or convex piece of one, that shines there
    /// unless something hides it; the parts that are left of a partly hidden emitter are not counted again.
    pub direct: u64,
    /// Exchange of reflected light: one for each pair of a point of an element and another element.
    pub exchange: u64,
    /// Gathering: one for each pair of a vertex and an element, or part of one, that it looks at.
    pub gathering: u64,
    /// Shadow rays: to lights that are points, and to others where exact cutting has given up.
    pub rays: u64,
}

impl Work {
    /// All evaluations of a form factor from a point to a polygon.
    pub fn form_factors(&self) -> u64 {
        self.direct + self.exchange + self.gathering
    }
}
