//! Discontinuity lines: where the view of a lamp begins or ceases to be cut by an edge.
//!
//! The part of a lamp that a receiver sees changes its shape where the receiver crosses a plane through
//! a corner of the lamp and an edge of an occluder, or through an edge of the lamp and a corner of an
//! occluder; there irradiance has a kink or a bend. Such planes meet the receiver in projections: of
//! the occluder's edge from the lamp's corner, and of the lamp's edge through the occluder's corner.
//!
//! Based on: D¹ and D² events of [Heckbert 1992] and [Lischinski, Tampieri and Greenberg 1992], without
//! those of three edges, which are curved and weaker. Not every line is an event: what else stands in
//! the way is not looked at, so whoever uses a line must ask how strong it is.
//!
//! [Heckbert 1992]: https://www.cs.cmu.edu/~ph/discon.ps.gz
//! [Lischinski, Tampieri and Greenberg 1992]: https://doi.org/10.1109/38.163625

use glam::DVec3;

use super::lamp::AreaLamp;
use super::rims::Rims;
use crate::visibility::{Facet, HalfSpace, Occluders};

/// An edge as high over the receiver as this share of the lamp's corner throws no shadow worth a line:
/// it would be very far away.
const HIGHEST: f64 = 0.999;

/// Of a crowd of occluders, which of their edges count: those on rims, of at least this length, m.
pub(super) type Crowd<'a> = Option<(&'a Rims, f64)>;

/// A discontinuity line, perhaps.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Its ends, m.
    pub ends: [DVec3; 2],
    /// The number of the lamp whose view changes.
    pub(crate) lamp: u32,
}

impl AreaLamp {
    /// The lines that occluders make with the part of the lamp, which has this number, above the receiver.
    pub(super) fn lines(
        &self,
        (lamp, receiver): (u32, Facet<'_>),
        among: (&Occluders, Crowd<'_>),
        occluders: impl Iterator<Item = u32>,
    ) -> impl Iterator<Item = Line> {
        let mut lines = Vec::new();
        if let Some(above) = self.above(receiver) {
            occluders.for_each(|occluder| {
                self.lines_by(&above, among, (occluder, receiver.plane), &mut lines);
            });
        }
        lines.into_iter().map(move |ends| Line { ends, lamp })
    }

    /// The lines that one occluder makes with the part of the lamp above the receiver.
    fn lines_by(
        &self,
        above: &[DVec3],
        (occluders, crowd): (&Occluders, Crowd<'_>),
        (occluder, receiver): (u32, HalfSpace),
        lines: &mut Vec<[DVec3; 2]>,
    ) {
        let whole = occluders.facet(occluder).corners;
        let between = self.front.clip(&receiver.clip(whole));
        let length = |k: usize| between[k].distance(between[(k + 1) % between.len()]);
        let is_long = |k: usize| crowd.is_none_or(|(_, least)| length(k) >= least);
        // What is cut has edges of its own.
        let rims = crowd.filter(|_| between.as_slice() == whole).map(|(rims, _)| rims);
        for (k, &from) in between.iter().enumerate() {
            let to = between[(k + 1) % between.len()];
            let bounds = |eye: &&DVec3| {
                is_long(k) && rims.is_none_or(|rims| rims.is_rim(occluder, k, **eye))
            };
            let eyes = above.iter().filter(bounds);
            lines.extend(eyes.filter_map(|&eye| {
                let seen = below(eye, receiver, [from, to])?;
                Some(seen.map(|p| project(eye, p, receiver)))
            }));
        }
        for (corner, &pivot) in between.iter().enumerate() {
            for (k, &from) in above.iter().enumerate() {
                let edge = [from, above[(k + 1) % above.len()]];
                let is_below = |eye: &DVec3| receiver.depth(pivot) < HIGHEST * receiver.depth(*eye);
                // On the receiver itself, a corner is the beginning of lines, not a line.
                let stands = receiver.depth(pivot) > f64::EPSILON * pivot.length();
                let n = between.len();
                let ends = is_long(corner) || is_long((corner + n - 1) % n);
                let counts = ends && rims.is_none_or(|rims| rims.is_peak(occluder, corner, edge));
                if stands && counts && edge.iter().all(is_below) {
                    lines.push(edge.map(|eye| project(eye, pivot, receiver)));
                }
            }
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
