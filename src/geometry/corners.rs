//! Plane geometry of single polygons: area, flatness, simplicity, triangles.

use glam::{DVec2, DVec3};

/// Area times unit normal, m² (Newell's formula; exact for planar polygons, concave ones too).
pub(crate) fn area_vector(corners: &[DVec3]) -> DVec3 {
    let Some(&origin) = corners.first() else { return DVec3::ZERO };
    let wedges = corners.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin));
    0.5 * wedges.sum::<DVec3>()
}

/// Length of the longest edge, m.
pub(crate) fn longest_edge(corners: &[DVec3]) -> f64 {
    let ends = corners.iter().zip(corners.iter().cycle().skip(1));
    ends.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// Largest distance of a corner from the plane through the mean corner across `normal`, m.
pub(crate) fn bulge(corners: &[DVec3], normal: DVec3) -> f64 {
    let mean = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
    corners.iter().map(|corner| (corner - mean).dot(normal).abs()).fold(0.0, f64::max)
}

/// Coordinates in the plane across the unit vector `normal`; counter-clockwise stays so.
pub(crate) fn flattened(corners: &[DVec3], normal: DVec3) -> Vec<DVec2> {
    let (u, v) = normal.any_orthonormal_pair();
    let origin = corners.first().copied().unwrap_or_default();
    let turned = if u.cross(v).dot(normal) < 0.0 { -v } else { v };
    let flat = |corner: &DVec3| DVec2::new((corner - origin).dot(u), (corner - origin).dot(turned));
    corners.iter().map(flat).collect()
}

/// Twice the signed area of the triangle `a b c`; positive if counter-clockwise.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// True if no two edges touch except neighbours in their common corner.
pub(crate) fn is_simple(corners: &[DVec2]) -> bool {
    let count = corners.len();
    let edge = |index: usize| [corners[index], corners[(index + 1) % count]];
    let spike = (0..count).any(|index| {
        let ([a, b], [_, c]) = (edge(index), edge((index + 1) % count));
        turn(a, b, c) == 0.0 && (b - a).dot(c - b) < 0.0
    });
    let neighbours =
        |first: usize, second: usize| second == first + 1 || (first == 0 && second + 1 == count);
    let mut pairs =
        (0..count).flat_map(|first| (first + 1..count).map(move |second| (first, second)));
    !spike && !pairs.any(|(i, j)| !neighbours(i, j) && segments_touch(edge(i), edge(j)))
}

fn segments_touch([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let boxes_meet = a.min(b).cmple(c.max(d)).all() && c.min(d).cmple(a.max(b)).all();
    let opposite =
        |first: f64, second: f64| !((first > 0.0 && second > 0.0) || (first < 0.0 && second < 0.0));
    boxes_meet && opposite(turn(a, b, c), turn(a, b, d)) && opposite(turn(c, d, a), turn(c, d, b))
}

/// Cuts a polygon into triangles of its corners by clipping ears ([Meisters 1975]).
///
/// Corners on the line between their neighbours stay corners of triangles. Polygons that are not
/// simple also come apart, then without a promise about which part of the plane is covered.
///
/// [Meisters 1975]: https://doi.org/10.2307/2319703
pub(crate) fn triangulate(corners: &[DVec2]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut triangles = Vec::with_capacity(corners.len().saturating_sub(2));
    while left.len() >= 3 {
        let ear = (0..left.len())
            .find(|&place| is_ear(corners, &left, place))
            .unwrap_or_else(|| bluntest(corners, &left));
        triangles.push(around(&left, ear));
        left.remove(ear);
    }
    triangles
}

fn around(left: &[usize], place: usize) -> [usize; 3] {
    let count = left.len();
    [left[(place + count - 1) % count], left[place], left[(place + 1) % count]]
}

fn is_ear(corners: &[DVec2], left: &[usize], place: usize) -> bool {
    let [a, b, c] = around(left, place).map(|index| corners[index]);
    let inside = |p: DVec2| {
        let outer = p == a || p == b || p == c;
        !outer && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0
    };
    turn(a, b, c) > 0.0 && !left.iter().any(|&other| inside(corners[other]))
}

/// The place whose triangle turns most to the left: the least harm where there is no ear.
fn bluntest(corners: &[DVec2], left: &[usize]) -> usize {
    let size = |place: usize| {
        let [a, b, c] = around(left, place).map(|index| corners[index]);
        turn(a, b, c)
    };
    (0..left.len()).max_by(|&i, &j| size(i).total_cmp(&size(j))).unwrap_or(0)
}

/// True if `values` at `corners` are those of one affine function, to within 10⁻⁵ of their span.
pub(crate) fn is_affine(corners: &[DVec2], values: &[DVec2]) -> bool {
    let (Some(&p0), Some(&q0)) = (corners.first(), values.first()) else { return true };
    let wedge = |&i: &usize| (corners[i] - p0).perp_dot(corners[i + 1] - p0);
    let widest = (1..corners.len() - 1).max_by(|i, j| wedge(i).abs().total_cmp(&wedge(j).abs()));
    let Some(i) = widest else { return true };
    let (u, v, area) = (corners[i] - p0, corners[i + 1] - p0, wedge(&i));
    let span = values.iter().map(|q| (q - q0).length()).fold(0.0, f64::max);
    corners.iter().zip(values).all(|(p, q)| {
        let (s, t) = ((p - p0).perp_dot(v) / area, u.perp_dot(p - p0) / area);
        let expected = q0 + s * (values[i] - q0) + t * (values[i + 1] - q0);
        (q - expected).length() <= 1e-5 * span
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[[f64; 2]]) -> Vec<DVec2> {
        list.iter().map(|&p| p.into()).collect()
    }

    fn area_of(corners: &[DVec2], triangles: &[[usize; 3]]) -> f64 {
        let area = |t: &[usize; 3]| 0.5 * turn(corners[t[0]], corners[t[1]], corners[t[2]]);
        triangles.iter().map(area).sum()
    }

    #[test]
    fn triangles_of_a_concave_polygon_keep_its_area_and_orientation() {
        let l = points(&[[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]]);
        let triangles = triangulate(&l);
        assert_eq!(triangles.len(), 4);
        assert!((area_of(&l, &triangles) - 3.0).abs() < 1e-12);
        for t in &triangles {
            assert!(turn(l[t[0]], l[t[1]], l[t[2]]) > 0.0, "{t:?}");
        }
    }

    #[test]
    fn corners_in_the_middle_of_an_edge_survive_triangulation() {
        let square = points(&[[0., 0.], [1., 0.], [2., 0.], [2., 2.], [0., 2.]]);
        for start in 0..5 {
            let mut corners = square.clone();
            corners.rotate_left(start);
            let triangles = triangulate(&corners);
            for t in &triangles {
                assert!(turn(corners[t[0]], corners[t[1]], corners[t[2]]) > 0.0, "{start} {t:?}");
            }
            assert!((area_of(&corners, &triangles) - 4.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_hole_reached_by_a_bridge_stays_a_hole() {
        let ring = points(&[
            [0., 0.],
            [4., 0.],
            [4., 4.],
            [0., 4.],
            [0., 0.],
            [1., 1.],
            [1., 3.],
            [3., 3.],
            [3., 1.],
            [1., 1.],
        ]);
        assert!(!is_simple(&ring));
        assert!((area_of(&ring, &triangulate(&ring)) - 12.0).abs() < 1e-12);
    }

    #[test]
    fn bow_ties_and_spikes_are_not_simple() {
        assert!(is_simple(&points(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]])));
        assert!(!is_simple(&points(&[[0., 0.], [1., 1.], [1., 0.], [0., 1.]])));
        assert!(!is_simple(&points(&[[0., 0.], [2., 0.], [1., 0.], [1., 1.]])));
    }

    #[test]
    fn flattening_keeps_area_and_orientation() {
        let corners = [DVec3::ZERO, DVec3::Z, DVec3::Z + DVec3::X, DVec3::X];
        let vector = area_vector(&corners);
        assert_eq!(vector, DVec3::Y);
        let flat = flattened(&corners, vector.normalize());
        assert!((area_of(&flat, &triangulate(&flat)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn trapezoid_with_square_picture_is_not_affine() {
        let trapezoid = points(&[[0., 0.], [2., 0.], [1.5, 1.], [0.5, 1.]]);
        let square = points(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]]);
        assert!(!is_affine(&trapezoid, &square));
        assert!(is_affine(&square, &square));
        assert!(is_affine(&trapezoid, &trapezoid));
    }
}
