//! Cuts a planar region into convex pieces of bounded size along given segments.
//!
//! A binary space partition of the region's bounding rectangle: first an even grid, so that
//! lines extended past the ends of a segment never run far; then, within a cell, the segments.

use glam::DVec2;

use super::polygon::{
    Convex, Line, Ring, Segment, borders, bounds, centroid, clip, contains, edges,
};

/// How a region is cut.
#[derive(Clone, Copy, Debug)]
pub struct Cuts<'a> {
    /// Segments that no piece may have in its inside.
    pub segments: &'a [Segment],
    /// Longest side of a piece along the axes, m; may be exceeded by a quarter.
    pub size: f64,
    /// Distances that count as zero, m.
    pub epsilon: f64,
}

/// A convex cell and the parts of segments that run through its inside.
struct BspCell {
    polygon: Convex,
    segments: Vec<Segment>,
}

/// The convex pieces of the region inside `rings` (even-odd); together they are the region.
pub fn convex_pieces(rings: &[Ring], cuts: &Cuts<'_>) -> Vec<Convex> {
    let [low, high] = bounds(rings.iter().flatten());
    let rectangle = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let outline = rings.iter().flat_map(|ring| edges(ring));
    let segments = outline.chain(cuts.segments.iter().copied());

    let mut pieces = Vec::new();
    let mut cells = vec![BspCell::new(rectangle.into(), segments, cuts.epsilon)];
    while let Some(cell) = cells.pop() {
        if let Some(line) = grid_line(&cell, cuts).or_else(|| segment_line(&cell, cuts.epsilon)) {
            cells.extend(cell.split(&line, cuts.epsilon));
        } else if contains(rings, centroid(&cell.polygon)) {
            pieces.push(cell.polygon);
        }
    }
    pieces
}

impl BspCell {
    /// Keeps of the segments what is inside.
    fn new(polygon: Convex, segments: impl Iterator<Item = Segment>, epsilon: f64) -> Self {
        let borders = borders(&polygon);
        let segments = segments.filter_map(|s| clip(s, &borders, epsilon)).collect();
        Self { polygon, segments }
    }

    /// The two sides of a line; segments along it are on the border now and dropped.
    fn split(&self, line: &Line, epsilon: f64) -> impl Iterator<Item = Self> {
        let parts = [1, 0].map(|side| {
            let polygon = line.split(&self.polygon, epsilon)[side].clone();
            let segments = self.segments.iter();
            let segments = segments.filter_map(|&s| line.split_segment(s, epsilon)[side]).collect();
            polygon.map(|polygon| Self { polygon, segments })
        });
        parts.into_iter().flatten()
    }
}

/// The line of an even grid that divides a cell that is too large, moved onto a parallel segment if
/// one is near.
fn grid_line(cell: &BspCell, cuts: &Cuts<'_>) -> Option<Line> {
    let [low, high] = bounds(&cell.polygon);
    let extent = high - low;
    // Rounding must not decide how squares are cut.
    let axis = usize::from(extent.y > extent.x + cuts.epsilon);
    let parts = ((extent[axis] - cuts.epsilon) / cuts.size - 0.25).ceil();
    if parts < 2.0 {
        return None;
    }
    let step = extent[axis] / parts;
    let even = low[axis] + (parts / 2.0).floor() * step;
    let parallel = cell.segments.iter().filter(|[a, b]| (a[axis] - b[axis]).abs() <= cuts.epsilon);
    let at = parallel
        .map(|[a, _]| a[axis])
        .filter(|at| (at - even).abs() < 0.4 * step)
        .min_by(|a, b| (a - even).abs().total_cmp(&(b - even).abs()))
        .unwrap_or(even);
    let mut ends = [low, high];
    ends[0][axis] = at;
    ends[1][axis] = at;
    Some(Line::through(ends))
}

/// The line along the segment that needs the least extension to cross its cell.
fn segment_line(cell: &BspCell, epsilon: f64) -> Option<Line> {
    let reach = |&segment: &Segment| {
        let line = Line::through(segment);
        let [left, _] = line.split(&cell.polygon, epsilon);
        let chord: Vec<DVec2> = left
            .iter()
            .flatten()
            .copied()
            .filter(|&p| line.side(p, epsilon * 2.0) == 0.0)
            .collect();
        let length = segment[0].distance(segment[1]);
        let longest = chord.iter().map(|p| p.distance(chord[0])).fold(length, f64::max);
        // Rounding must not decide between segments of equal length, or that all cross the whole cell.
        [length / longest * 1e6, length / epsilon].map(f64::round)
    };
    let best = cell.segments.iter().max_by(|a, b| {
        let (a, b) = (reach(a), reach(b));
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    });
    best.map(|&segment| Line::through(segment))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::{area, distance};

    fn ring(corners: &[(f64, f64)]) -> Ring {
        corners.iter().map(|&c| DVec2::from(c)).collect()
    }

    fn region_with_hole() -> Vec<Ring> {
        let outer = ring(&[(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (2.0, 1.2), (2.0, 2.0), (0.0, 2.0)]);
        vec![outer, ring(&[(0.5, 0.5), (0.7, 1.4), (1.5, 1.1)])]
    }

    #[test]
    fn pieces_together_are_the_region() {
        let rings = region_with_hole();
        let expected: f64 = rings.iter().map(|r| area(r)).sum();
        let cuts = Cuts { segments: &[], size: 0.4, epsilon: 1e-9 };
        let pieces = convex_pieces(&rings, &cuts);
        let total: f64 = pieces.iter().map(|p| area(p)).sum();
        assert!((total - expected.abs()).abs() < 1e-9, "{total} of {expected}");
        for piece in &pieces {
            let [low, high] = bounds(piece);
            assert!((high - low).max_element() < 0.51, "{piece:?} is too long");
        }
    }

    #[test]
    fn no_segment_runs_through_a_piece() {
        let segment = [DVec2::new(0.1, 0.2), DVec2::new(2.6, 0.45)];
        let cuts = Cuts { segments: &[segment], size: 10.0, epsilon: 1e-9 };
        for piece in convex_pieces(&region_with_hole(), &cuts) {
            let borders = borders(&piece);
            assert!(clip(segment, &borders, 1e-7).is_none(), "{piece:?} is cut by the segment");
            assert!(distance(segment, piece[0]).is_finite());
        }
    }
}
