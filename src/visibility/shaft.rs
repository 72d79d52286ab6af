//! The part of a light that a point sees: the light minus the shadows that occluders throw on it.

use glam::DVec3;
use smallvec::SmallVec;

use super::clip::{Facet, HalfSpace, Polygon};
use super::shadow::{Seen, Shadow};
use super::{Occluder, Occluders};

/// The visible pieces of a polygon; they do not overlap.
pub type Pieces = SmallVec<[Polygon; 2]>;

/// Beyond this many pieces, or shadows, a shaft is crowded, and cutting on costs more than sampling.
const CROWDED: usize = 96;

/// Shadows are sorted by size in lots of this many.
const BATCH: usize = 64;

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

    /// As [`Self::visible_part`], giving up at more than `most` pieces or shadows.
    pub fn visible_pieces(
        &self,
        eye: DVec3,
        source: &[DVec3],
        normal: DVec3,
        most: usize,
    ) -> Option<Pieces> {
        let facet = Facet::new(source, normal);
        let shaft = Shaft::new(eye, source, facet.plane);
        let mut shade = Shade::new(Seen::new(eye, facet, self.tolerance), most);
        self.for_each(
            |low, high| shaft.meets_box(low, high, self.tolerance),
            |_, occluder| !shaft.meets(&occluder.corners, self.tolerance) || shade.by(occluder),
        );
        shade.pieces()
    }

    /// As [`Self::visible_part`], where no other occluders than those of these numbers are in the way.
    pub fn visible_behind(
        &self,
        among: &[u32],
        eye: DVec3,
        source: &[DVec3],
        normal: DVec3,
    ) -> Option<Pieces> {
        let seen = Seen::new(eye, Facet::new(source, normal), self.tolerance);
        let mut shade = Shade::new(seen, CROWDED);
        let mut occluders = among.iter().map(|&number| &self.polygons[number as usize]);
        // `all` stops where nothing is left to see.
        occluders.all(|occluder| shade.by(occluder));
        shade.pieces()
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

/// What is seen, while shadows are taken out of it.
struct Shade {
    seen: Seen,
    /// Still to be taken out.
    shadows: Vec<Shadow>,
    /// Shadows so far.
    count: usize,
    /// More pieces or shadows than this are too many.
    most: usize,
}

impl Shade {
    fn new(seen: Seen, most: usize) -> Self {
        Self { seen, shadows: Vec::new(), count: 0, most }
    }

    /// Adds the shadow of an occluder; false if going on is of no use.
    fn by(&mut self, occluder: &Occluder) -> bool {
        let shadow = self.seen.shadow(occluder);
        self.count += usize::from(shadow.is_some());
        self.shadows.extend(shadow);
        if self.shadows.len() >= BATCH || self.shadows.last().is_some_and(Shadow::covers_all) {
            self.subtract();
        }
        !self.seen.is_empty() && !self.is_crowded()
    }

    fn is_crowded(&self) -> bool {
        self.seen.len() > self.most || self.count > self.most
    }

    /// Takes the shadows out of what is seen, the largest first: it leaves the others little to cut.
    fn subtract(&mut self) {
        let mut order: SmallVec<[(f64, usize); BATCH]> = SmallVec::new();
        order.extend(self.shadows.iter().enumerate().map(|(k, shadow)| (shadow.area, k)));
        order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        for (_, k) in order {
            if self.seen.is_empty() {
                break;
            }
            self.seen.subtract(&self.shadows[k]);
        }
        self.shadows.clear();
    }

    /// What is left, unless it is too many pieces.
    fn pieces(mut self) -> Option<Pieces> {
        if !self.is_crowded() {
            self.subtract();
        }
        (self.seen.is_empty() || !self.is_crowded()).then(|| self.seen.pieces())
    }
}
