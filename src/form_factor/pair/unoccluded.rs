//! Exchanges with nothing between.

use std::f64::consts::PI;

use glam::DVec3;

use super::cubature::Rule;
use super::edges::log_distance;
use crate::form_factor::contour::point_to_polygon_above;
use crate::geometry::area_vector;
use crate::geometry::{HalfSpace, PlanarPolygon, Polygon};

/// Relative error of an exchange by contours, about.
const ACCURACY: f64 = 1e-9;

/// Exchange A₁F₁₂, m², between two convex polygons with nothing between; 0 if they face away from each other.
///
/// What of one lies behind the other is cut away. Near each other, the double integral along
/// the contours; far apart, Gauss's rules over the smaller polygon of the form factor from a
/// point, whose relative error is below 1e-6 there.
pub fn exchange(a: PlanarPolygon<'_>, b: PlanarPolygon<'_>) -> f64 {
    let (Some(front_a), Some(front_b)) = (in_front(a, b), in_front(b, a)) else { return 0.0 };
    let (round_a, round_b) = (Round::about(&front_a), Round::about(&front_b));
    let gap = round_a.centre.distance(round_b.centre) - round_a.radius - round_b.radius;
    let ((small, normal), large, radius) = if round_a.radius < round_b.radius {
        ((&front_a, a.plane.normal), &front_b, round_a.radius)
    } else {
        ((&front_b, b.plane.normal), &front_a, round_b.radius)
    };
    match Rule::for_ratio(gap / radius) {
        Some(rule) => rule.integrate(small, |x| point_to_polygon_above(x, normal, large)),
        None => by_contours(&front_a, &front_b),
    }
}

/// Exchange A₁F₁₂, m², between two polygons that are nowhere behind each other, by the double
/// integral along their contours: 1/2π |∮∮ ln r dx·dy| ([Goral et al. 1984], from Stokes's theorem).
///
/// Exact also where they share edges or nearly touch.
///
/// [Goral et al. 1984]: https://doi.org/10.1145/800031.808601
pub fn by_contours(a: &[DVec3], b: &[DVec3]) -> f64 {
    let unit = Round::about(a).centre.distance(Round::about(b).centre);
    let unit = if unit > 0.0 { unit } else { 1.0 };
    let smaller = area_vector(a).length().min(area_vector(b).length());
    let tolerance = ACCURACY * smaller;
    let pairs = edges_of(a).flat_map(|x| edges_of(b).map(move |y| (x, y)));
    let sum: f64 = pairs.map(|(x, y)| log_distance(x, y, unit, tolerance)).sum();
    (sum / (2.0 * PI)).abs()
}

/// True if two polygons lie in one plane, to within `epsilon`, m: then they exchange nothing, though
/// in the limit of two that approach each other face to face they would.
pub(in crate::form_factor) fn is_level(
    a: PlanarPolygon<'_>,
    b: PlanarPolygon<'_>,
    epsilon: f64,
) -> bool {
    let above = |plane: &HalfSpace, corners: &[DVec3]| {
        corners.iter().any(|&corner| plane.depth(corner) > epsilon)
    };
    !above(&a.plane, b.corners) || !above(&b.plane, a.corners)
}

/// The part of `polygon` in front of `other`'s plane, if there is one.
pub(super) fn in_front(polygon: PlanarPolygon<'_>, other: PlanarPolygon<'_>) -> Option<Polygon> {
    let depth = |corner: &DVec3| other.plane.depth(*corner);
    if polygon.corners.iter().all(|corner| depth(corner) >= 0.0) {
        return Some(Polygon::from_slice(polygon.corners));
    }
    Some(other.plane.clip(polygon.corners)).filter(|part| !part.is_empty())
}

fn edges_of(polygon: &[DVec3]) -> impl Iterator<Item = [DVec3; 2]> + Clone + '_ {
    (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]])
}

/// A sphere around a polygon.
struct Round {
    centre: DVec3,
    radius: f64,
}

impl Round {
    fn about(polygon: &[DVec3]) -> Self {
        let centre = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
        let radius = polygon.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
        Self { centre, radius }
    }
}
