//! What stands between two polygons.

use glam::DVec3;
use smallvec::SmallVec;

use super::shadow::Seen;
use super::shaft::{Body, Shaft};
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
        let shaft = Shaft::between(&Body::polygon(a), &Body::polygon(b), tolerance);
        let mut near: SmallVec<[&Occluder; 16]> = SmallVec::new();
        self.for_each_in(&self.all(), &shaft, |number, _| {
            near.push(&self.polygons[number as usize]);
            true
        });
        let hides_all =
            near.iter().any(|occluder| hides(occluder, a.corners, b.corners, tolerance));
        let along = (b.corners[0] - a.corners[0]).normalize_or_zero();
        let parts = near.iter().filter_map(|occluder| inside(occluder, shaft.sides(), tolerance));
        // What hides most comes first: it leaves the others little to cut.
        let mut parts: Vec<(f64, Occluder)> =
            parts.map(|part| (area_vector(&part.corners).dot(along).abs(), part)).collect();
        parts.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        Between { parts: parts.into_iter().map(|(_, part)| part).collect(), tolerance, hides_all }
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
        let shaft = Shaft::between(&Body::polygon(a), &Body::polygon(b), self.tolerance);
        let mut clear = true;
        self.for_each_in(&self.all(), &shaft, |_, occluder| {
            clear &= inside(occluder, shaft.sides(), self.tolerance).is_none();
            clear
        });
        clear
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
pub(super) fn inside(occluder: &Occluder, hull: &[HalfSpace], tolerance: f64) -> Option<Occluder> {
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

/// True if an occluder crosses all segments between corners of two bodies, and so, being convex, all segments.
pub(super) fn hides(occluder: &Occluder, a: &[DVec3], b: &[DVec3], tolerance: f64) -> bool {
    a.iter().all(|&p| b.iter().all(|&q| occluder.crosses(p, q, tolerance)))
}
