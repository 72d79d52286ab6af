//! What stands between two polygons.

use glam::DVec3;
use smallvec::SmallVec;

use super::shadow::Seen;
use super::{Facet, HalfSpace, Occluder, Occluders, Pieces, Polygon};
use crate::scene::area_vector;

/// Corners nearer to each other than this share of the tolerance are one.
const ROUNDING: f64 = 1e-3;

/// The parts of occluders that lie in the convex hull of two polygons, in front of both.
#[derive(Debug)]
pub struct Between {
    parts: Vec<Occluder>,
    tolerance: f64,
    /// True if one of them hides each polygon from the other.
    hides_all: bool,
}

impl Occluders {
    /// What stands between two polygons that face each other.
    pub fn between(&self, a: Facet<'_>, b: Facet<'_>) -> Between {
        let tolerance = self.tolerance;
        let near = self.near(a, b);
        if near.is_empty() {
            return Between { parts: Vec::new(), tolerance, hides_all: false };
        }
        let near = near.iter().map(|&index| &self.polygons[index as usize]);
        let hides_all = near.clone().any(|occluder| hides(occluder, a, b, tolerance));
        let hull = hull(a, b, tolerance);
        let along = (b.corners[0] - a.corners[0]).normalize_or_zero();
        let parts = near.filter_map(|occluder| inside(occluder, &hull, tolerance));
        // What hides most comes first: it leaves the others little to cut.
        let mut parts: Vec<(f64, Occluder)> =
            parts.map(|part| (area_vector(&part.corners).dot(along).abs(), part)).collect();
        parts.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        Between { parts: parts.into_iter().map(|(_, part)| part).collect(), tolerance, hides_all }
    }

    /// The numbers of the occluders of which a part stands between two polygons that face each other.
    pub fn numbers_between(&self, a: Facet<'_>, b: Facet<'_>) -> impl Iterator<Item = u32> {
        let near = self.near(a, b);
        let hull = if near.is_empty() { SmallVec::new() } else { hull(a, b, self.tolerance) };
        let stands = move |&index: &u32| {
            inside(&self.polygons[index as usize], &hull, self.tolerance).is_some()
        };
        near.into_iter().filter(stands)
    }

    /// An occluder by its number, below [`Self::len`].
    pub fn facet(&self, number: u32) -> Facet<'_> {
        let Occluder { corners, plane, .. } = &self.polygons[number as usize];
        Facet { corners, plane: *plane }
    }

    /// Number of occluders.
    pub fn len(&self) -> usize {
        self.polygons.len()
    }

    /// True if nothing hides anything.
    pub fn is_empty(&self) -> bool {
        self.polygons.is_empty()
    }

    /// True if nothing stands between two polygons that face each other.
    pub fn is_clear(&self, a: Facet<'_>, b: Facet<'_>) -> bool {
        self.numbers_between(a, b).next().is_none()
    }

    /// The occluders of which something is in the box around two polygons and in front of both.
    fn near(&self, a: Facet<'_>, b: Facet<'_>) -> SmallVec<[u32; 16]> {
        let corners = || a.corners.iter().chain(b.corners).copied();
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let tolerance = self.tolerance;
        let mut near: SmallVec<[u32; 16]> = SmallVec::new();
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
                    near.push(index);
                }
                true
            },
        );
        near
    }
}

impl Between {
    /// Distances that count as zero, m.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// True if nothing stands between the polygons.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// True if one occluder hides all of each polygon from all of the other; false does not mean
    /// that something is seen.
    pub fn hides_all(&self) -> bool {
        self.hides_all
    }

    /// The pieces of `source`, one of the two polygons, that `eye`, on the other one, sees.
    ///
    /// The eye must be in front of the source's plane.
    pub fn visible_part(&self, eye: DVec3, source: Facet<'_>) -> Pieces {
        let mut seen = Seen::new(eye, source, self.tolerance);
        for part in &self.parts {
            if let Some(shadow) = seen.shadow(part) {
                seen.subtract(&shadow);
            }
            if seen.is_empty() {
                break;
            }
        }
        seen.pieces()
    }
}

/// The part of an occluder inside of all half spaces, if there is one.
fn inside(occluder: &Occluder, hull: &[HalfSpace], tolerance: f64) -> Option<Occluder> {
    let mut corners: Polygon = occluder.corners.clone();
    for side in hull {
        if corners.iter().all(|&p| side.depth(p) <= tolerance) {
            return None;
        }
        if corners.iter().any(|&p| side.depth(p) < 0.0) {
            corners = side.clip(&corners);
        }
    }
    // Edges no longer than rounding have no direction.
    let previous = |k: usize| corners[(k + corners.len() - 1) % corners.len()];
    let distinct = |&k: &usize| corners[k].distance(previous(k)) > ROUNDING * tolerance;
    let corners: Polygon = (0..corners.len()).filter(distinct).map(|k| corners[k]).collect();
    (corners.len() >= 3).then_some(Occluder { corners, ..*occluder })
}

/// The half spaces whose intersection is the convex hull of two polygons.
fn hull(a: Facet<'_>, b: Facet<'_>, tolerance: f64) -> SmallVec<[HalfSpace; 16]> {
    let mut sides: SmallVec<[HalfSpace; 16]> = SmallVec::new();
    sides.extend([a.plane, b.plane]);
    sides.extend(supports(a.corners, b.corners, tolerance));
    sides.extend(supports(b.corners, a.corners, tolerance));
    sides
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
