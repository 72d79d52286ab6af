//! Exact form factors of polygons by the integral along their contours.

use std::f64::consts::PI;

use glam::DVec3;

use crate::geometry::HalfSpace;

/// Form factor (0..=1) from a point on a surface with unit `normal` to a polygon, occlusion not included.
///
/// F = 1/2π |Σₖ θₖ n·γₖ| over the edges, θₖ being the angle that edge k fills as seen from the
/// point and γₖ the unit normal of the plane through both ([Lambert 1760]; [Nishita and Nakamae
/// 1985]). What lies below the horizon is clipped away. Exact for any planar polygon not in one
/// plane with the point.
///
/// [Lambert 1760]: https://archive.org/details/lambertsphotome00lambgoog
/// [Nishita and Nakamae 1985]: https://doi.org/10.1145/325165.325169
pub fn point_to_polygon(point: DVec3, normal: DVec3, polygon: &[DVec3]) -> f64 {
    let horizon = HalfSpace::new(point, normal);
    if polygon.iter().all(|&corner| horizon.depth(corner) >= 0.0) {
        return point_to_polygon_above(point, normal, polygon);
    }
    point_to_polygon_above(point, normal, &horizon.clip(polygon))
}

/// As [`point_to_polygon`], for a polygon that is nowhere below the horizon.
pub fn point_to_polygon_above(point: DVec3, normal: DVec3, polygon: &[DVec3]) -> f64 {
    let Some(&last) = polygon.last() else { return 0.0 };
    let mut sum = 0.0;
    let mut a = last - point;
    for &corner in polygon {
        let b = corner - point;
        let cross = a.cross(b);
        let sine = cross.length();
        if sine > f64::MIN_POSITIVE {
            sum += sine.atan2(a.dot(b)) / sine * cross.dot(normal);
        }
        a = b;
    }
    (sum / (2.0 * PI)).abs()
}

/// The vector whose product with any unit normal is the form factor from a point with that normal to the part
/// of a polygon above the horizon of this `normal`, as long as all of that part is above both horizons.
///
/// The same sum as [`point_to_polygon`], without the product: the light vector of [Arvo 1994].
///
/// [Arvo 1994]: https://doi.org/10.1145/192161.192250
pub fn vector_to_polygon(point: DVec3, normal: DVec3, polygon: &[DVec3]) -> DVec3 {
    let above = HalfSpace::new(point, normal).clip(polygon);
    let edge = |k: usize| {
        let (a, b) = (above[k] - point, above[(k + 1) % above.len()] - point);
        let cross = a.cross(b);
        let sine = cross.length();
        if sine > f64::MIN_POSITIVE { cross * (sine.atan2(a.dot(b)) / sine) } else { DVec3::ZERO }
    };
    let sum = (0..above.len()).map(edge).sum::<DVec3>() / (2.0 * PI);
    if sum.dot(normal) < 0.0 { -sum } else { sum }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Point below the corner of a parallel rectangle a × b at distance c (Howell, configuration B-3).
    fn corner_rectangle(a: f64, b: f64, c: f64) -> f64 {
        let (x, y) = (a / c, b / c);
        let (rx, ry) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
        (x / rx * (y / rx).atan() + y / ry * (x / ry).atan()) / (2.0 * PI)
    }

    #[test]
    fn parallel_rectangle_has_its_closed_form() {
        let polygon = [(0.0, 0.0), (0.0, 2.0), (3.0, 2.0), (3.0, 0.0)];
        let polygon = polygon.map(|(x, y)| DVec3::new(x, y, 1.5));
        let f = point_to_polygon(DVec3::ZERO, DVec3::Z, &polygon);
        assert!((f - corner_rectangle(3.0, 2.0, 1.5)).abs() < 1e-12, "{f}");
    }

    #[test]
    fn one_vector_has_the_factors_of_many_normals() {
        let polygon = [(0.3, -0.4, 1.0), (0.5, 0.6, 1.2), (-0.7, 0.2, 0.9)];
        let polygon = polygon.map(|(x, y, z)| DVec3::new(x, y, z));
        let vector = vector_to_polygon(DVec3::ZERO, DVec3::Z, &polygon);
        for (x, y) in [(0.0, 0.0), (0.3, 0.1), (-0.2, 0.4), (0.1, -0.5)] {
            let normal = DVec3::new(x, y, 1.0).normalize();
            let factor = point_to_polygon(DVec3::ZERO, normal, &polygon);
            assert!((vector.dot(normal) - factor).abs() < 1e-12, "{normal}: {factor}");
        }
        let below = polygon.map(|p| p - DVec3::Z);
        let factor = point_to_polygon(DVec3::ZERO, DVec3::Z, &below);
        let vector = vector_to_polygon(DVec3::ZERO, DVec3::Z, &below);
        assert!((vector.z - factor).abs() < 1e-12, "{factor}");
    }

    #[test]
    fn wall_that_begins_at_the_horizon_fills_half() {
        let wall = [(-1e6, 0.0), (1e6, 0.0), (1e6, 1e6), (-1e6, 1e6)];
        let wall = wall.map(|(y, z)| DVec3::new(1e-3, y, z));
        let below = wall.map(|p| p - DVec3::Z * 5e5);
        assert!((point_to_polygon(DVec3::ZERO, DVec3::Z, &wall) - 0.5).abs() < 1e-6);
        assert!((point_to_polygon(DVec3::ZERO, DVec3::Z, &below) - 0.5).abs() < 1e-6);
    }
}
