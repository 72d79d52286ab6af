//! Shadows on a polygon as an eye sees them, cut out of it in its own plane.

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::occluder::Occluder;
use crate::geometry::polygon::area;
use crate::geometry::{HalfSpace, Pieces, PlanarPolygon, Polygon};

/// A convex polygon in the source's plane, m.
type Flat = SmallVec<[DVec2; 8]>;

/// A rectangle along the axes of the source's plane, m.
#[derive(Clone, Copy)]
struct Rectangle {
    low: DVec2,
    high: DVec2,
}

/// A piece of the source, and the rectangle around it.
#[derive(Clone)]
struct SourcePiece {
    outline: Flat,
    bounds: Rectangle,
}

/// Share of the epsilon by which a shadow must reach into a piece: above rounding alone.
const ROUNDING: f64 = 1e-3;

/// What an eye sees of a source.
pub(super) struct VisibleRegion {
    eye: DVec3,
    /// The eye is in front.
    plane: HalfSpace,
    /// The first corner of the source.
    origin: DVec3,
    /// Orthonormal axes of its plane.
    axes: [DVec3; 2],
    whole: Flat,
    pieces: SmallVec<[SourcePiece; 4]>,
    epsilon: f64,
}

/// A half space where it meets the source's plane.
#[derive(Clone, Copy)]
struct Side {
    /// Change of depth, m, by metre along the axes.
    slope: DVec2,
    /// Depth of the source's first corner, m.
    offset: f64,
}

/// A shadow: what is on the inner sides of all its borders.
pub(super) struct Shadow {
    sides: SmallVec<[Side; 4]>,
    /// Around its part on the source.
    bounds: Rectangle,
    /// Area of its part on the source, m².
    pub(super) area: f64,
}

impl Rectangle {
    fn of(outline: &[DVec2]) -> Self {
        let low = outline.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        Self { low, high: outline.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max) }
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && self.high.cmpge(other.low).all()
    }
}

impl From<Flat> for SourcePiece {
    fn from(outline: Flat) -> Self {
        Self { bounds: Rectangle::of(&outline), outline }
    }
}

impl VisibleRegion {
    /// All of `source`, in front of whose plane the eye is; distances up to `epsilon`, m, count as zero.
    pub(super) fn new(eye: DVec3, source: PlanarPolygon<'_>, epsilon: f64) -> Self {
        let normal = source.plane.normal;
        let origin = source.corners[0];
        let x = (source.corners[1] - origin).try_normalize();
        let x = x.unwrap_or_else(|| normal.any_orthonormal_vector());
        let axes = [x, normal.cross(x)];
        let flat = |&p: &DVec3| DVec2::from(axes.map(|axis| (p - origin).dot(axis)));
        let whole: Flat = source.corners.iter().map(flat).collect();
        let mut pieces = SmallVec::new();
        pieces.push(whole.clone().into());
        Self { eye, plane: source.plane, origin, axes, whole, pieces, epsilon }
    }

    /// The pieces left; they do not overlap.
    pub(super) fn pieces(&self) -> Pieces {
        let lift = |p: &DVec2| self.origin + self.axes[0] * p.x + self.axes[1] * p.y;
        self.pieces.iter().map(|piece| piece.outline.iter().map(lift).collect()).collect()
    }

    /// Number of pieces left.
    pub(super) fn len(&self) -> usize {
        self.pieces.len()
    }

    /// True if nothing is left.
    pub(super) fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// The shadow that an occluder throws on the source, if any of it is hit.
    pub(super) fn shadow(&self, occluder: &Occluder) -> Option<Shadow> {
        let height = occluder.plane.depth(self.eye);
        if height.abs() <= 2.0 * self.epsilon {
            return None;
        }
        // What lies behind the source's plane hides nothing.
        let crosses = occluder.corners.iter().any(|&corner| self.plane.depth(corner) < 0.0);
        let clipped = if crosses { self.plane.clip(&occluder.corners) } else { Polygon::new() };
        let front = if crosses { &clipped } else { &occluder.corners };
        let least = ROUNDING * self.epsilon;
        let mut sides = SmallVec::new();
        let (mut on_source, mut spare) = (self.whole.clone(), Flat::new());
        for (k, &from) in front.iter().enumerate() {
            let to = front[(k + 1) % front.len()];
            let Some(side) = self.side([from, to], -height.signum()) else { continue };
            match side.classify(&on_source, least) {
                Classification::Outside => return None,
                Classification::Inside => {}
                Classification::Both => {
                    side.clip(&on_source, 1.0, &mut spare);
                    std::mem::swap(&mut on_source, &mut spare);
                    sides.push(side);
                }
            }
        }
        (front.len() >= 3).then(|| Shadow {
            sides,
            bounds: Rectangle::of(&on_source),
            area: area(&on_source).abs(),
        })
    }

    /// The half space of the eye and an edge, in the source's plane; an edge that points at the eye
    /// bounds nothing.
    fn side(&self, [from, to]: [DVec3; 2], turn: f64) -> Option<Side> {
        let normal = ((from - self.eye).cross(to - self.eye) * turn).try_normalize()?;
        let slope = DVec2::from(self.axes.map(|axis| axis.dot(normal)));
        Some(Side { slope, offset: normal.dot(self.origin - self.eye) })
    }

    /// Takes a shadow out of what is left.
    pub(super) fn subtract(&mut self, shadow: &Shadow) {
        let least = ROUNDING * self.epsilon;
        for k in (0..self.pieces.len()).rev() {
            let SourcePiece { outline, bounds } = &self.pieces[k];
            let is_outside =
                |side: &Side| matches!(side.classify(outline, least), Classification::Outside);
            if bounds.meets(&shadow.bounds) && !shadow.sides.iter().any(is_outside) {
                self.cut(k, &shadow.sides, least);
            }
        }
    }

    /// Replaces a piece by its parts outside of at least one of the sides.
    fn cut(&mut self, piece: usize, sides: &[Side], least: f64) {
        let count = self.pieces.len();
        let (mut rest, mut spare) = (self.pieces[piece].outline.clone(), Flat::new());
        for side in sides {
            match side.classify(&rest, least) {
                // No part is in the shadow after all.
                Classification::Outside => return self.pieces.truncate(count),
                Classification::Inside => {}
                Classification::Both => {
                    let mut outside = Flat::new();
                    side.clip(&rest, -1.0, &mut outside);
                    self.pieces.push(outside.into());
                    side.clip(&rest, 1.0, &mut spare);
                    std::mem::swap(&mut rest, &mut spare);
                }
            }
        }
        self.pieces.swap_remove(piece);
    }
}

impl Shadow {
    /// True if all of the source lies in it.
    pub(super) fn covers_all(&self) -> bool {
        self.sides.is_empty()
    }
}

/// On which sides of a line something lies.
enum Classification {
    Inside,
    Outside,
    Both,
}

impl Side {
    fn depth(&self, p: DVec2) -> f64 {
        self.slope.dot(p) + self.offset
    }

    fn classify(&self, polygon: &[DVec2], least: f64) -> Classification {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for &p in polygon {
            let depth = self.depth(p);
            low = low.min(depth);
            high = high.max(depth);
        }
        match (high > least, low < -least) {
            (false, _) => Classification::Outside,
            (true, false) => Classification::Inside,
            (true, true) => Classification::Both,
        }
    }

    /// Fills `part` with what of a polygon is inside, or outside if `sign` is -1.
    #[inline]
    fn clip(&self, polygon: &[DVec2], sign: f64, part: &mut Flat) {
        part.clear();
        let mut corner = polygon[polygon.len() - 1];
        let mut from = self.depth(corner) * sign;
        for &next in polygon {
            let to = self.depth(next) * sign;
            if from * to < 0.0 {
                part.push(corner.lerp(next, from / (from - to)));
            }
            if to >= 0.0 {
                part.push(next);
            }
            (corner, from) = (next, to);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::Occluders;

    /// Share of a lamp over the eye that is seen past an upright wall of this height over the eye.
    fn seen_past(top: f64) -> f64 {
        let lamp = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let lamp = lamp.map(|(x, z)| DVec3::new(x, 2.0, z));
        let wall = [(-1.0, -9.0), (-1.0, 9.0), (top, 9.0), (top, -9.0)];
        let wall = wall.map(|(y, z)| DVec3::new(0.5, y, z));
        let occluders = Occluders::from_polygons(&[&wall], 1e-6);
        let pieces = occluders.visible_part(DVec3::ZERO, &lamp, DVec3::NEG_Y).unwrap_or_default();
        let area = |p: &Polygon| crate::geometry::area_vector(p).length();
        pieces.iter().map(area).sum::<f64>() / area(&Polygon::from_slice(&lamp))
    }

    #[test]
    fn wall_hides_what_it_reaches_up_to_and_nothing_from_an_eye_at_its_top() {
        assert!((seen_past(0.0) - 1.0).abs() < 1e-12, "{}", seen_past(0.0));
        assert!((seen_past(1.0) - 1.0).abs() < 1e-12, "{}", seen_past(1.0));
        assert!((seen_past(1.25) - 0.9).abs() < 1e-12, "{}", seen_past(1.25));
        assert!((seen_past(2.0) - 0.75).abs() < 1e-12, "{}", seen_past(2.0));
    }
}
