//! The part of a light that a point sees: the light minus the shadows that occluders throw on it.

use glam::DVec3;
use smallvec::SmallVec;

use super::clip::{Facet, HalfSpace, Polygon};
use super::{Occluder, Occluders};

/// The visible pieces of a polygon; they do not overlap.
pub type Pieces = SmallVec<[Polygon; 2]>;

/// Beyond this many pieces a shaft is crowded, and cutting on costs more than sampling.
const CROWDED: usize = 96;

/// Everything between a point and a polygon: a pyramid.
struct Shaft {
    sides: SmallVec<[HalfSpace; 10]>,
    low: DVec3,
    high: DVec3,
}

impl Shaft {
    /// `source` must lie above the eye's horizon and not in one plane with the eye.
    fn new(eye: DVec3, source: &[DVec3], towards_eye: HalfSpace) -> Self {
        let mut sides: SmallVec<[HalfSpace; 10]> =
            cone(eye, source, towards_eye.depth(eye)).collect();
        sides.push(towards_eye);
        let corners = || source.iter().copied().chain([eye]);
        Self {
            sides,
            low: corners().fold(DVec3::INFINITY, DVec3::min),
            high: corners().fold(DVec3::NEG_INFINITY, DVec3::max),
        }
    }

    /// False only if no part of the box is inside.
    fn meets_box(&self, low: DVec3, high: DVec3, tolerance: f64) -> bool {
        let reaches = |side: &HalfSpace| {
            let furthest = DVec3::select(side.normal.cmpge(DVec3::ZERO), high, low);
            side.depth(furthest) > tolerance
        };
        self.low.cmple(high).all() && self.high.cmpge(low).all() && self.sides.iter().all(reaches)
    }

    /// False only if no part of the polygon is inside.
    fn meets(&self, polygon: &[DVec3], tolerance: f64) -> bool {
        let reaches = |side: &HalfSpace| polygon.iter().any(|&p| side.depth(p) > tolerance);
        self.sides.iter().all(reaches)
    }
}

/// The half spaces of all rays from `eye` through a polygon that it sees from the front (`height`
/// positive) or back.
fn cone(eye: DVec3, polygon: &[DVec3], height: f64) -> impl Iterator<Item = HalfSpace> + '_ {
    let inward = -height.signum();
    (0..polygon.len()).filter_map(move |k| {
        let (a, b) = (polygon[k] - eye, polygon[(k + 1) % polygon.len()] - eye);
        // An edge that points at the eye bounds nothing.
        (a.cross(b) * inward).try_normalize().map(|normal| HalfSpace::new(eye, normal))
    })
}

impl Occluders {
    /// The pieces of `source` that `eye` sees.
    ///
    /// `source` is convex and planar, counter-clockwise seen from `eye`, which is in front of its plane.
    /// Exact for any number of convex occluders, but for those in one plane with the eye.
    /// `None` if so many stand in the way that cutting them out does not pay.
    pub fn visible_part(&self, eye: DVec3, source: &[DVec3], normal: DVec3) -> Option<Pieces> {
        self.visible_pieces(eye, source, normal, CROWDED)
    }

    /// As [`Self::visible_part`], giving up at more than `most` pieces.
    pub fn visible_pieces(
        &self,
        eye: DVec3,
        source: &[DVec3],
        normal: DVec3,
        most: usize,
    ) -> Option<Pieces> {
        let facet = Facet::new(source, normal);
        let shaft = Shaft::new(eye, source, facet.plane);
        let mut pieces = Pieces::new();
        pieces.push(Polygon::from_slice(source));
        self.for_each(
            |low, high| shaft.meets_box(low, high, self.tolerance),
            |_, occluder| {
                if shaft.meets(&occluder.corners, self.tolerance) {
                    subtract(&mut pieces, (eye, facet), occluder, self.tolerance);
                }
                !pieces.is_empty() && pieces.len() <= most
            },
        );
        (pieces.len() <= most).then_some(pieces)
    }

    /// True if something may stand between `eye` and a part of `source`.
    pub fn may_be_hidden(&self, eye: DVec3, source: &[DVec3], normal: DVec3) -> bool {
        let shaft = Shaft::new(eye, source, HalfSpace::new(source[0], normal));
        let mut found = false;
        self.for_each(
            |low, high| shaft.meets_box(low, high, self.tolerance),
            |_, occluder| {
                let height = occluder.plane.depth(eye);
                found |= height.abs() > 2.0 * self.tolerance
                    && shaft.meets(&occluder.corners, self.tolerance);
                !found
            },
        );
        found
    }
}

/// Takes the shadow that an occluder throws from an eye out of the pieces of a source in front of which
/// the eye is.
pub(super) fn subtract(
    pieces: &mut Pieces,
    (eye, source): (DVec3, Facet<'_>),
    occluder: &Occluder,
    tolerance: f64,
) {
    let height = occluder.plane.depth(eye);
    if height.abs() <= 2.0 * tolerance {
        return;
    }
    // What lies behind the source's plane hides nothing.
    let crosses = occluder.corners.iter().any(|&corner| source.plane.depth(corner) < 0.0);
    let clipped = if crosses { source.plane.clip(&occluder.corners) } else { Polygon::new() };
    let front = if crosses { &clipped } else { &occluder.corners };
    if front.is_empty() {
        return;
    }
    let shadow: SmallVec<[HalfSpace; 8]> = cone(eye, front, height).collect();
    let tolerance = tolerance * 1e-3;
    let misses = |polygon: &[DVec3]| {
        shadow.iter().any(|side| polygon.iter().all(|&p| side.depth(p) <= tolerance))
    };
    if misses(source.corners) {
        return;
    }
    let mut cut = Pieces::new();
    pieces.retain(|piece| {
        let is_clear = misses(piece);
        if !is_clear {
            subtract_cone(piece, &shadow, tolerance, &mut cut);
        }
        is_clear
    });
    pieces.append(&mut cut);
}

/// Adds to `visible` what of a piece is outside of at least one of the half spaces.
fn subtract_cone(piece: &Polygon, cone: &[HalfSpace], tolerance: f64, visible: &mut Pieces) {
    let mut rest = piece.clone();
    for side in cone {
        if rest.iter().any(|&p| side.depth(p) < -tolerance) {
            let outside = side.complement().clip(&rest);
            if !outside.is_empty() {
                visible.push(outside);
            }
            rest = side.clip(&rest);
        }
        if rest.is_empty() {
            return;
        }
    }
}
