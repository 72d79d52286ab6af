//! What stands between two polygons.

use glam::DVec3;
use smallvec::SmallVec;

use super::occluder::Occluder;
use super::occluders::Occluders;
use super::shadow::VisibleRegion;
use super::shaft::{ConvexBody, Shaft};
use crate::geometry::area_vector;
use crate::geometry::{Pieces, PlanarPolygon};

/// The parts of occluders that lie in the convex hull of two polygons, in front of both.
#[derive(Debug)]
pub struct Between {
    parts: Vec<Occluder>,
    epsilon: f64,
    /// True if one of them hides each polygon from the other.
    hides_all: bool,
}

impl Occluders {
    /// What stands between two polygons that face each other.
    pub fn between(&self, a: PlanarPolygon<'_>, b: PlanarPolygon<'_>) -> Between {
        let epsilon = self.epsilon;
        let shaft = Shaft::between(&ConvexBody::polygon(a), &ConvexBody::polygon(b), epsilon);
        let mut near: SmallVec<[&Occluder; 16]> = SmallVec::new();
        self.for_each_in(&self.all(), &shaft, |number, _| {
            near.push(&self.polygons[number.index()]);
            true
        });
        let hides_all = near.iter().any(|occluder| occluder.hides(a.corners, b.corners, epsilon));
        let along = (b.corners[0] - a.corners[0]).normalize_or_zero();
        let parts = near.iter().filter_map(|occluder| occluder.inside(shaft.sides(), epsilon));
        // What hides most comes first: it leaves the others little to cut.
        let mut parts: Vec<(f64, Occluder)> =
            parts.map(|part| (area_vector(&part.corners).dot(along).abs(), part)).collect();
        parts.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        Between { parts: parts.into_iter().map(|(_, part)| part).collect(), epsilon, hides_all }
    }

    /// True if nothing stands between two polygons that face each other.
    pub fn is_clear(&self, a: PlanarPolygon<'_>, b: PlanarPolygon<'_>) -> bool {
        let shaft = Shaft::between(&ConvexBody::polygon(a), &ConvexBody::polygon(b), self.epsilon);
        let mut clear = true;
        self.for_each_in(&self.all(), &shaft, |_, occluder| {
            clear &= occluder.inside(shaft.sides(), self.epsilon).is_none();
            clear
        });
        clear
    }
}

impl Between {
    /// Distances that count as zero, m.
    pub fn epsilon(&self) -> f64 {
        self.epsilon
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
    pub fn visible_part(&self, eye: DVec3, source: PlanarPolygon<'_>) -> Pieces {
        let mut seen = VisibleRegion::new(eye, source, self.epsilon);
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
