//! A convex piece of a surface, as something that stands in the way.

use glam::DVec3;

use crate::geometry::cut::{Cuts, convex_pieces};
use crate::geometry::{HalfSpace, PlanarPolygon, Polygon};
use crate::surface::{SurfaceId, Surfaces};

/// Corners nearer to each other than this share of the epsilon are one.
const ROUNDING: f64 = 1e-3;

/// A convex piece of a surface.
#[derive(Clone, Debug)]
pub(super) struct Occluder {
    pub(super) corners: Polygon,
    pub(super) plane: HalfSpace,
    /// Index into [`Surfaces::list`], or into the polygons given.
    pub(super) surface: SurfaceId,
}

impl Occluder {
    /// Convex pieces of all surfaces, each double-sided polygon once.
    pub(super) fn all_of(surfaces: &Surfaces) -> impl Iterator<Item = Self> + '_ {
        let fronts = surfaces.list.iter().enumerate().filter(|(_, surface)| !surface.is_back);
        fronts.flat_map(|(number, surface)| {
            let cuts = Cuts { segments: &[], size: f64::INFINITY, epsilon: surfaces.epsilon };
            convex_pieces(&surface.rings, &cuts).into_iter().map(move |piece| Self {
                corners: piece.iter().map(|&p| surface.plane.lift(p)).collect(),
                plane: HalfSpace::new(surface.plane.origin, surface.plane.normal),
                surface: SurfaceId(number as u32),
            })
        })
    }

    /// It as a polygon.
    pub(super) fn polygon(&self) -> PlanarPolygon<'_> {
        PlanarPolygon { corners: &self.corners, plane: self.plane }
    }

    /// True if the segment passes from one side to the other, through the polygon or its border.
    pub(super) fn crosses(&self, a: DVec3, b: DVec3, epsilon: f64) -> bool {
        let (from, to) = (self.plane.depth(a), self.plane.depth(b));
        if from.abs() <= epsilon || to.abs() <= epsilon || from * to > 0.0 {
            return false;
        }
        self.holds(a.lerp(b, from / (from - to)), epsilon)
    }

    /// True if a place on its plane is inside the polygon or on its border.
    pub(super) fn holds(&self, at: DVec3, epsilon: f64) -> bool {
        (0..self.corners.len()).all(|k| {
            let (p, q) = (self.corners[k], self.corners[(k + 1) % self.corners.len()]);
            (q - p).cross(at - p).dot(self.plane.normal) >= -epsilon * (q - p).length()
        })
    }

    /// True if it crosses all segments between corners of two bodies, and so, being convex, all segments.
    pub(super) fn hides(&self, a: &[DVec3], b: &[DVec3], epsilon: f64) -> bool {
        a.iter().all(|&p| b.iter().all(|&q| self.crosses(p, q, epsilon)))
    }

    /// Its part inside of all half spaces, if there is one.
    pub(super) fn inside(&self, hull: &[HalfSpace], epsilon: f64) -> Option<Self> {
        let mut corners: Polygon = self.corners.clone();
        for side in hull {
            if corners.iter().all(|&p| side.depth(p) <= epsilon) {
                return None;
            }
            if corners.iter().any(|&p| side.depth(p) < 0.0) {
                corners = side.clip(&corners);
            }
        }
        // Edges no longer than rounding have no direction.
        let previous = |k: usize| corners[(k + corners.len() - 1) % corners.len()];
        let distinct = |&k: &usize| corners[k].distance(previous(k)) > ROUNDING * epsilon;
        let corners: Polygon = (0..corners.len()).filter(distinct).map(|k| corners[k]).collect();
        (corners.len() >= 3).then_some(Self { corners, ..*self })
    }
}
