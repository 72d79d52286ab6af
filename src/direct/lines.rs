//! Discontinuity lines: where the view of an emitter begins or ceases to be cut by an edge.
//!
//! The part of an emitter that a receiver sees changes its shape where the receiver crosses a plane through
//! a corner of the emitter and an edge of an occluder, or through an edge of the emitter and a corner of an
//! occluder; there irradiance has a kink or a bend. Such planes meet the receiver in projections: of
//! the occluder's edge from the emitter's corner, and of the emitter's edge through the occluder's corner.
//!
//! Based on: D¹ and D² events of [Heckbert 1992] and [Lischinski, Tampieri and Greenberg 1992], without
//! those of three edges, which are curved and weaker. Not every line is an event: what else stands in
//! the way is not looked at, so whoever uses a line must ask how strong it is.
//!
//! [Heckbert 1992]: https://www.cs.cmu.edu/~ph/discon.ps.gz
//! [Lischinski, Tampieri and Greenberg 1992]: https://doi.org/10.1109/38.163625

use glam::DVec3;
use smallvec::SmallVec;

use super::emitter::AreaEmitter;
use super::ids::EmitterId;
use crate::geometry::{HalfSpace, PlanarPolygon};
use crate::visibility::{OccluderId, Occluders};

/// An edge as high over the receiver as this share of the emitter's corner throws no shadow worth a line:
/// it would be very far away.
const HIGHEST: f64 = 0.999;

/// Emitters of more corners are round: of what an edge hides of them, only the first and the last corner make lines.
const ROUND: usize = 6;

/// A discontinuity line, perhaps.
#[derive(Clone, Copy, Debug)]
pub struct EventLine {
    /// Its ends, m.
    pub ends: [DVec3; 2],
    /// What interpolation over the receiver's width may lose for want of it, at most, W/m² of irradiance.
    pub bound: f64,
    /// The number of the emitter whose view changes.
    pub(crate) emitter: EmitterId,
}

/// An emitter that shines on a receiver.
pub(super) struct Shining<'a> {
    pub(super) number: EmitterId,
    pub(super) emitter: &'a AreaEmitter,
    /// The part of it above the receiver.
    pub(super) above: &'a [DVec3],
    pub(super) receiver: PlanarPolygon<'a>,
    /// Most irradiance by it, W/m².
    pub(super) most: f64,
    /// Lines that may lose less than this, W/m² of irradiance, are left out.
    pub(super) least: f64,
}

impl Shining<'_> {
    /// The lines that occluders make with the emitter.
    pub(super) fn lines(
        &self,
        occluders: &Occluders,
        numbers: impl Iterator<Item = OccluderId>,
    ) -> Vec<EventLine> {
        let mut lines = Vec::new();
        numbers.for_each(|number| self.lines_by(occluders, number, &mut lines));
        lines
    }

    /// The lines that one occluder makes.
    fn lines_by(&self, occluders: &Occluders, occluder: OccluderId, lines: &mut Vec<EventLine>) {
        let receiver = self.receiver.plane;
        let between = self.emitter.front.clip(&receiver.clip(occluders.polygon(occluder).corners));
        let n = between.len();
        for (k, &from) in between.iter().enumerate() {
            let edge = [from, between[(k + 1) % n]];
            for eye in self.eyes(edge) {
                self.add(below(eye, receiver, edge), eye, lines);
            }
        }
        if self.above.len() > ROUND {
            return;
        }
        for &pivot in &between {
            // On the receiver itself, a corner is the beginning of lines, not a line.
            if receiver.depth(pivot) <= f64::EPSILON * pivot.length() {
                continue;
            }
            for (k, &from) in self.above.iter().enumerate() {
                let edge = [from, self.above[(k + 1) % self.above.len()]];
                let is_below = |eye: &DVec3| receiver.depth(pivot) < HIGHEST * receiver.depth(*eye);
                if edge.iter().all(is_below) {
                    let ends = edge.map(|eye| project(eye, pivot, receiver));
                    self.keep(ends, self.penumbra(edge[0], pivot), lines);
                }
            }
        }
    }

    /// The corners of the emitter from which an edge throws lines.
    fn eyes(&self, [from, to]: [DVec3; 2]) -> SmallVec<[DVec3; 8]> {
        if self.above.len() <= ROUND {
            return self.above.into();
        }
        // Those that the edge hides first and last.
        let across = (to - from).cross(self.above[0] - from);
        let aside = |eye: &DVec3| (*eye - from).normalize_or_zero().dot(across);
        let order = |a: &&DVec3, b: &&DVec3| aside(a).total_cmp(&aside(b));
        let first = self.above.iter().min_by(order);
        first.into_iter().chain(self.above.iter().max_by(order)).copied().collect()
    }

    /// Adds what an edge, or the part of it below an eye, throws.
    fn add(&self, edge: Option<[DVec3; 2]>, eye: DVec3, lines: &mut Vec<EventLine>) {
        if let Some(edge) = edge {
            let ends = edge.map(|p| project(eye, p, self.receiver.plane));
            self.keep(ends, self.penumbra(eye, edge[0].midpoint(edge[1])), lines);
        }
    }

    /// Width of the shadow's border that something throws, m: ℓ dₒᵣ / dₗₒ.
    fn penumbra(&self, eye: DVec3, occluder: DVec3) -> f64 {
        let size = self.above[0].distance(self.above[self.above.len() / 2]);
        let [low, high] = [occluder, eye].map(|p| self.receiver.plane.depth(p));
        size * low / (high - low).max(f64::MIN_POSITIVE)
    }

    /// Adds a line if it may matter.
    ///
    /// Over a width w, interpolation loses at most U min(1, w/4W) min(1, length/w) of what crosses a border of width
    /// W, where the emitter sends U.
    fn keep(&self, ends: [DVec3; 2], penumbra: f64, lines: &mut Vec<EventLine>) {
        let corners = self.receiver.corners;
        let width = corners[0].distance(corners[corners.len() / 2]);
        let steep = (width / (4.0 * penumbra).max(f64::MIN_POSITIVE)).min(1.0);
        let bound = self.most * steep * (ends[0].distance(ends[1]) / width).min(1.0);
        if bound > self.least {
            lines.push(EventLine { ends, bound, emitter: self.number });
        }
    }
}

/// The part of an edge that is lower over the receiver than an eye.
fn below(eye: DVec3, receiver: HalfSpace, [from, to]: [DVec3; 2]) -> Option<[DVec3; 2]> {
    let top = HIGHEST * receiver.depth(eye);
    let depth = |p: DVec3| top - receiver.depth(p);
    let (a, b) = (depth(from), depth(to));
    if a <= 0.0 && b <= 0.0 {
        return None;
    }
    let crossing = || from.lerp(to, a / (a - b));
    Some([if a < 0.0 { crossing() } else { from }, if b < 0.0 { crossing() } else { to }])
}

/// Where the ray from an eye through a lower point meets the receiver's plane.
fn project(eye: DVec3, through: DVec3, receiver: HalfSpace) -> DVec3 {
    let (high, low) = (receiver.depth(eye), receiver.depth(through));
    eye.lerp(through, high / (high - low))
}
