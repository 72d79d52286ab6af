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

use super::{AreaLamp, Lamps};
use crate::visibility::{Facet, HalfSpace, Occluders};

/// An edge as high over the receiver as this share of the lamp's corner throws no shadow worth a line:
/// it would be very far away.
const HIGHEST: f64 = 0.999;

impl Lamps {
    /// Segments in the plane of a receiver, m, on which its irradiance by polygons may have a kink or
    /// a bend; they may reach beyond the receiver.
    pub fn lines(&self, occluders: &Occluders, receiver: Facet<'_>) -> Vec<[DVec3; 2]> {
        let mut lines = Vec::new();
        for lamp in &self.areas {
            let above = receiver.plane.clip(&lamp.corners);
            let faces = receiver.corners.iter().any(|&corner| lamp.front.depth(corner) > 0.0);
            if above.is_empty() || !faces {
                continue;
            }
            let source = Facet { corners: &above, plane: lamp.front };
            for occluder in occluders.polygons_between(source, receiver) {
                lamp.lines_by(&above, occluder, receiver.plane, &mut lines);
            }
        }
        lines
    }
}

impl AreaLamp {
    /// The lines that one occluder makes with the part of the lamp above the receiver.
    fn lines_by(
        &self,
        above: &[DVec3],
        occluder: &[DVec3],
        receiver: HalfSpace,
        lines: &mut Vec<[DVec3; 2]>,
    ) {
        let between = self.front.clip(&receiver.clip(occluder));
        for (k, &from) in between.iter().enumerate() {
            let to = between[(k + 1) % between.len()];
            lines.extend(above.iter().filter_map(|&eye| {
                let seen = below(eye, receiver, [from, to])?;
                Some(seen.map(|p| project(eye, p, receiver)))
            }));
        }
        for &pivot in &between {
            for (k, &from) in above.iter().enumerate() {
                let edge = [from, above[(k + 1) % above.len()]];
                let is_below = |eye: &DVec3| receiver.depth(pivot) < HIGHEST * receiver.depth(*eye);
                // On the receiver itself, a corner is the beginning of lines, not a line.
                let stands = receiver.depth(pivot) > f64::EPSILON * pivot.length();
                if stands && edge.iter().all(is_below) {
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
