//! Whether triangles in a plane cover each other.

use glam::DVec2;

use crate::geometry::polygon::{bounds, edges};

/// A triangle, counter-clockwise.
pub(super) type FlatTriangle = [DVec2; 3];

/// Whether two triangles have more in common than a border `tolerance` wide.
pub(super) fn overlap(a: &FlatTriangle, b: &FlatTriangle, tolerance: f64) -> bool {
    let ([a_low, a_high], [b_low, b_high]) = (bounds(a), bounds(b));
    let common = a_high.min(b_high) - a_low.max(b_low);
    common.min_element() > tolerance && !is_beside(a, b, tolerance) && !is_beside(b, a, tolerance)
}

/// Whether all of `b` lies beyond one edge of `a`; where two convex polygons do not meet, an edge of one
/// parts them.
fn is_beside(a: &FlatTriangle, b: &FlatTriangle, tolerance: f64) -> bool {
    edges(a).any(|[from, to]| {
        let inward = (to - from).normalize_or_zero().perp();
        b.iter().all(|&corner| (corner - from).dot(inward) <= tolerance)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(x: f64, y: f64) -> FlatTriangle {
        [DVec2::new(x, y), DVec2::new(x + 1.0, y), DVec2::new(x, y + 1.0)]
    }

    #[test]
    fn triangles_that_share_an_edge_or_a_corner_do_not_overlap() {
        let other = [DVec2::X, DVec2::ONE, DVec2::Y];
        assert!(!overlap(&triangle(0.0, 0.0), &other, 1e-9));
        assert!(!overlap(&triangle(0.0, 0.0), &triangle(1.0, 0.0), 1e-9));
        assert!(!overlap(&triangle(0.0, 0.0), &triangle(0.6, 0.6), 1e-9));
    }

    #[test]
    fn triangles_that_share_area_overlap() {
        assert!(overlap(&triangle(0.0, 0.0), &triangle(0.0, 0.0), 1e-9));
        assert!(overlap(&triangle(0.0, 0.0), &triangle(0.4, 0.4), 1e-9));
        let inside = triangle(0.0, 0.0).map(|corner| corner * 0.1 + DVec2::splat(0.2));
        assert!(overlap(&triangle(0.0, 0.0), &inside, 1e-9));
    }
}
