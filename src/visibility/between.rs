//! What stands between two polygons.

use glam::DVec3;
use smallvec::SmallVec;

use super::shaft::Pieces;
use super::{Facet, HalfSpace, Occluder, Occluders};

/// The occluders that may stand between two polygons.
#[derive(Debug)]
pub struct Between<'a> {
    occluders: &'a Occluders,
    found: SmallVec<[u32; 16]>,
    /// True if one of them hides each polygon from the other.
    hides_all: bool,
}

impl Occluders {
    /// The occluders of which some part lies in the convex hull of two polygons, in front of both.
    pub fn between(&self, a: Facet<'_>, b: Facet<'_>) -> Between<'_> {
        let corners = || a.corners.iter().chain(b.corners).copied();
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let tolerance = self.tolerance;
        let mut found: SmallVec<[u32; 16]> = SmallVec::new();
        self.for_each(
            |box_low, box_high| {
                let reaches = |plane: &HalfSpace| {
                    let furthest =
                        DVec3::select(plane.normal.cmpge(DVec3::ZERO), box_high, box_low);
                    plane.depth(furthest) > tolerance
                };
                low.cmplt(box_high).all()
                    && high.cmpgt(box_low).all()
                    && reaches(&a.plane)
                    && reaches(&b.plane)
            },
            |index, occluder| {
                let reaches = |plane: &HalfSpace| {
                    occluder.corners.iter().any(|&p| plane.depth(p) > tolerance)
                };
                if reaches(&a.plane) && reaches(&b.plane) {
                    found.push(index);
                }
                true
            },
        );
        let mut between = Between { occluders: self, found, hides_all: false };
        between.keep_inside(a, b);
        let hides_all = between.found().any(|occluder| hides(occluder, a, b, tolerance));
        Between { hides_all, ..between }
    }
}

impl Between<'_> {
    /// True if nothing stands between the polygons.
    pub fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// True if one occluder hides all of each polygon from all of the other; false does not mean
    /// that something is seen.
    pub fn hides_all(&self) -> bool {
        self.hides_all
    }

    /// The pieces of `source`, one of the two polygons, that `eye`, on the other one, sees.
    ///
    /// `source` must be counter-clockwise seen from the eye, and the eye in front of its plane.
    pub fn visible_part(&self, eye: DVec3, source: Facet<'_>) -> Pieces {
        let mut pieces = Pieces::new();
        pieces.push(source.corners.into());
        for occluder in self.found() {
            self.occluders.subtract(&mut pieces, eye, occluder, source.plane);
            if pieces.is_empty() {
                break;
            }
        }
        pieces
    }

    fn found(&self) -> impl Iterator<Item = &Occluder> + '_ {
        self.found.iter().map(|&index| &self.occluders.polygons[index as usize])
    }

    /// Drops what lies outside of the convex hull.
    fn keep_inside(&mut self, a: Facet<'_>, b: Facet<'_>) {
        if self.found.is_empty() {
            return;
        }
        let (polygons, tolerance) = (&self.occluders.polygons, self.occluders.tolerance);
        for side in supports(a.corners, b.corners, tolerance)
            .chain(supports(b.corners, a.corners, tolerance))
        {
            self.found.retain(|index| {
                polygons[*index as usize].corners.iter().any(|&p| side.depth(p) > tolerance)
            });
        }
    }
}

/// The half spaces that hold both polygons and have an edge of the first and a corner of the second
/// on their border.
fn supports<'a>(
    edges: &'a [DVec3],
    corners: &'a [DVec3],
    tolerance: f64,
) -> impl Iterator<Item = HalfSpace> + 'a {
    let through = move |k: usize, corner: DVec3| {
        let (from, to) = (edges[k], edges[(k + 1) % edges.len()]);
        let plane = HalfSpace::new(from, (to - from).cross(corner - from).try_normalize()?);
        let (mut low, mut high) = (0.0_f64, 0.0_f64);
        for &p in edges.iter().chain(corners) {
            low = low.min(plane.depth(p));
            high = high.max(plane.depth(p));
        }
        if low >= -tolerance {
            Some(plane)
        } else {
            (high <= tolerance).then(|| plane.complement())
        }
    };
    (0..edges.len()).flat_map(move |k| corners.iter().filter_map(move |&corner| through(k, corner)))
}

/// True if an occluder crosses all segments between corners, and so, being convex, all segments.
fn hides(occluder: &Occluder, a: Facet<'_>, b: Facet<'_>, tolerance: f64) -> bool {
    a.corners.iter().all(|&p| b.corners.iter().all(|&q| occluder.crosses(p, q, tolerance)))
}
