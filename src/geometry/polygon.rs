//! Convex polygons in a plane: area, centroid, cutting along a line; and rings, which need not be convex.

use glam::DVec2;
use smallvec::SmallVec;

/// A convex polygon, counter-clockwise.
pub type Convex = SmallVec<[DVec2; 4]>;

/// A closed ring of corners; the last is joined to the first.
pub type Ring = Vec<DVec2>;

/// A piece of a straight line, from its first to its second point.
pub type Segment = [DVec2; 2];

/// Signed area of a ring, m²; positive if counter-clockwise.
pub fn area(ring: &[DVec2]) -> f64 {
    let Some(&first) = ring.first() else { return 0.0 };
    edges(ring).map(|[a, b]| (a - first).perp_dot(b - first)).sum::<f64>() / 2.0
}

/// Centre of gravity of a ring's interior, or of its corners if it has no area.
pub fn centroid(ring: &[DVec2]) -> DVec2 {
    let first = ring[0];
    let (mut moment, mut doubled) = (DVec2::ZERO, 0.0);
    for [a, b] in edges(ring) {
        let cross = (a - first).perp_dot(b - first);
        moment += (a - first + (b - first)) * cross;
        doubled += cross;
    }
    if doubled.abs() > f64::MIN_POSITIVE {
        first + moment / (3.0 * doubled)
    } else {
        ring.iter().sum::<DVec2>() / ring.len() as f64
    }
}

/// Edges of a ring, in its order.
pub fn edges(ring: &[DVec2]) -> impl Iterator<Item = Segment> + '_ {
    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
}

/// Lines along the edges of a convex polygon, which is to their left.
pub fn borders(polygon: &[DVec2]) -> SmallVec<[Line; 8]> {
    edges(polygon).map(Line::through).collect()
}

/// The part of a segment strictly to the left of all lines.
pub fn clip(segment: Segment, lines: &[Line], epsilon: f64) -> Option<Segment> {
    let inside = lines.iter().try_fold(segment, |part, line| line.split_segment(part, epsilon)[0]);
    inside.filter(|[a, b]| a.distance(*b) > epsilon)
}

/// Smallest and largest coordinates of some points.
pub fn bounds<'a>(points: impl IntoIterator<Item = &'a DVec2>) -> [DVec2; 2] {
    let empty = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    points.into_iter().fold(empty, |[low, high], &p| [low.min(p), high.max(p)])
}

/// True if `point` is inside by the even-odd rule.
pub fn contains(rings: &[Ring], point: DVec2) -> bool {
    let crossings = rings.iter().flat_map(|ring| edges(ring)).filter(|[a, b]| {
        (a.y > point.y) != (b.y > point.y)
            && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossings.count() % 2 == 1
}

/// Distance of a point from a segment, m.
pub fn distance([a, b]: Segment, point: DVec2) -> f64 {
    let along = b - a;
    let share = (point - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    (a + along * share.clamp(0.0, 1.0)).distance(point)
}

/// An oriented straight line.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    point: DVec2,
    /// Unit normal, to the left of the line's direction.
    normal: DVec2,
}

impl Line {
    /// The line from the first to the second of two distinct points.
    pub fn through([a, b]: Segment) -> Self {
        Self { point: a, normal: (b - a).normalize_or_zero().perp() }
    }

    /// Signed distance of a point, m, zero within `epsilon`; positive to the left.
    pub fn side(&self, point: DVec2, epsilon: f64) -> f64 {
        let distance = (point - self.point).dot(self.normal);
        if distance.abs() <= epsilon { 0.0 } else { distance }
    }

    /// The parts of a segment to the left and to the right; what runs along the line belongs to neither.
    pub fn split_segment(&self, [a, b]: Segment, epsilon: f64) -> [Option<Segment>; 2] {
        let (from, to) = (self.side(a, epsilon), self.side(b, epsilon));
        if from * to < 0.0 {
            let crossing = a.lerp(b, from / (from - to));
            let parts = [Some([a, crossing]), Some([crossing, b])];
            return if from > 0.0 { parts } else { [parts[1], parts[0]] };
        }
        match from + to {
            sum if sum > 0.0 => [Some([a, b]), None],
            sum if sum < 0.0 => [None, Some([a, b])],
            _ => [None, None],
        }
    }

    /// The parts of a convex polygon to the left and to the right, corners on the line belonging to both.
    pub fn split(&self, polygon: &[DVec2], epsilon: f64) -> [Option<Convex>; 2] {
        let sides: SmallVec<[f64; 8]> = polygon.iter().map(|&p| self.side(p, epsilon)).collect();
        if sides.iter().all(|&side| side >= 0.0) {
            return [Some(polygon.into()), None];
        }
        if sides.iter().all(|&side| side <= 0.0) {
            return [None, Some(polygon.into())];
        }
        let (mut left, mut right) = (Convex::new(), Convex::new());
        for (k, (&point, &side)) in polygon.iter().zip(&sides).enumerate() {
            let next = (k + 1) % polygon.len();
            if side >= 0.0 {
                left.push(point);
            }
            if side <= 0.0 {
                right.push(point);
            }
            if side * sides[next] < 0.0 {
                let crossing = point.lerp(polygon[next], side / (side - sides[next]));
                left.push(crossing);
                right.push(crossing);
            }
        }
        [Some(left), Some(right)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn square() -> Convex {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from).into()
    }

    proptest! {
        #[test]
        fn splitting_keeps_the_area(x0 in -1.0..2.0, y0 in -1.0..2.0, x1 in -1.0..2.0, y1 in -1.0..2.0) {
            let line = Line::through([DVec2::new(x0, y0), DVec2::new(x1, y1)]);
            let parts = line.split(&square(), 1e-12);
            let total: f64 = parts.iter().flatten().map(|part| area(part)).sum();
            prop_assert!((total - 1.0).abs() < 1e-9, "{total}");
        }
    }

    #[test]
    fn centroid_of_a_triangle_is_the_mean_of_its_corners() {
        let corners = [DVec2::new(1.0, 1.0), DVec2::new(4.0, 1.0), DVec2::new(1.0, 7.0)];
        assert!(centroid(&corners).distance(DVec2::new(2.0, 3.0)) < 1e-12);
    }

    #[test]
    fn a_hole_is_outside() {
        let hole = square().iter().rev().map(|p| *p * 0.5 + DVec2::splat(0.25)).collect();
        let rings = [square().to_vec(), hole];
        assert!(!contains(&rings, DVec2::splat(0.5)));
        assert!(contains(&rings, DVec2::splat(0.1)));
    }
}
