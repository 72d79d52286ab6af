//! The part of a light that a point sees: the light minus the shadows that occluders throw on it.

use glam::DVec3;
use smallvec::SmallVec;

use super::blockers::Blockers;
use super::occluder::Occluder;
use super::occluders::Occluders;
use super::shadow::{Shadow, VisibleRegion};
use super::shaft::Shaft;
use crate::geometry::{Pieces, PlanarPolygon};
use crate::surface::SurfaceId;

/// Beyond this many pieces, or shadows, a shaft is crowded, and cutting on costs more than sampling.
pub const CROWDED: usize = 96;

/// Shadows are sorted by size in lots of this many; so in a crowd, none is cut before it is known for one.
const BATCH: usize = CROWDED + 1;

/// An eye and what it looks at.
#[derive(Clone, Copy, Debug)]
pub struct Pyramid<'a> {
    /// The eye, in front of the plane of the base.
    pub apex: DVec3,
    /// A polygon whose front it sees.
    pub base: PlanarPolygon<'a>,
}

impl Occluders {
    /// The pieces of `source` that `eye` sees.
    ///
    /// `source` is convex and planar, counter-clockwise seen from `eye`, which is in front of its plane.
    /// Exact for any number of convex occluders, but for those in one plane with the eye.
    /// `None` if so many stand in the way that cutting them out does not pay.
    pub fn visible_part(&self, eye: DVec3, source: &[DVec3], normal: DVec3) -> Option<Pieces> {
        let view = Pyramid { apex: eye, base: PlanarPolygon::new(source, normal) };
        self.visible_among(view, &self.all(), CROWDED, |_| false)
    }

    /// As [`Self::visible_part`] of the base of `view`, with nothing in the way but `blockers`, and of these not those
    /// whose surfaces are to be `ignored`; `None` at more than `most` pieces or shadows.
    pub fn visible_among(
        &self,
        view: Pyramid<'_>,
        blockers: &Blockers,
        most: usize,
        ignored: impl Fn(SurfaceId) -> bool,
    ) -> Option<Pieces> {
        let seen = VisibleRegion::new(view.apex, view.base, self.epsilon);
        let mut rest = ShadowSubtraction::new(seen, most.min(CROWDED));
        if let Blockers::Few(list) = blockers {
            // So few that looking for those in the shaft takes longer than cutting.
            let mut occluders = list.iter().map(|&number| &self.polygons[number.index()]);
            occluders.all(|occluder| ignored(occluder.surface) || rest.shade_by(occluder));
        } else {
            let shaft = Shaft::from_eye(view.apex, view.base);
            self.for_each_in(blockers, &shaft, |_, occluder| {
                ignored(occluder.surface) || rest.shade_by(occluder)
            });
        }
        rest.pieces()
    }

    /// As [`Self::visible_part`], however many stand in the way.
    pub fn visible_pieces(&self, eye: DVec3, source: &[DVec3], normal: DVec3) -> Pieces {
        let source = PlanarPolygon::new(source, normal);
        let shaft = Shaft::from_eye(eye, source);
        let seen = VisibleRegion::new(eye, source, self.epsilon);
        let mut rest = ShadowSubtraction::new(seen, usize::MAX);
        self.for_each_in(&self.all(), &shaft, |_, occluder| rest.shade_by(occluder));
        rest.pieces().unwrap_or_default()
    }

    /// True if something may stand between `eye` and a part of `source`.
    pub fn may_be_hidden(&self, eye: DVec3, source: &[DVec3], normal: DVec3) -> bool {
        let shaft = Shaft::from_eye(eye, PlanarPolygon::new(source, normal));
        let mut found = false;
        self.for_each(
            |low, high| shaft.meets_box(low, high, self.epsilon),
            |_, occluder| {
                let height = occluder.plane.depth(eye);
                found |= height.abs() > 2.0 * self.epsilon
                    && shaft.meets(&occluder.corners, self.epsilon);
                !found
            },
        );
        found
    }
}

/// What is seen, while shadows are taken out of it.
struct ShadowSubtraction {
    seen: VisibleRegion,
    /// Still to be taken out.
    shadows: Vec<Shadow>,
    /// Shadows so far.
    count: usize,
    /// More pieces or shadows than this are too many.
    most: usize,
}

impl ShadowSubtraction {
    fn new(seen: VisibleRegion, most: usize) -> Self {
        Self { seen, shadows: Vec::new(), count: 0, most }
    }

    /// Adds the shadow of an occluder; false if going on is of no use.
    fn shade_by(&mut self, occluder: &Occluder) -> bool {
        let shadow = self.seen.shadow(occluder);
        self.count += usize::from(shadow.is_some());
        self.shadows.extend(shadow);
        if self.shadows.last().is_some_and(Shadow::covers_all)
            || (self.shadows.len() >= BATCH && !self.is_crowded())
        {
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
