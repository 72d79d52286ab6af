//! Normals of the curved surfaces that facets stand for.

use glam::{DVec2, DVec3};

use crate::geometry::polygon;
use crate::surface::Surface;

/// The normal at a place on a surface, m: its own, or that of the curved surface it stands for,
/// blended between the corners by mean value coordinates ([Floater 2003]).
///
/// [Floater 2003]: https://doi.org/10.1016/S0167-8396(03)00002-5
pub(crate) fn normal_at(surface: &Surface, place: DVec2) -> DVec3 {
    let Some(ring) = surface.rings.first().filter(|r| r.len() == surface.normals.len()) else {
        return surface.plane.normal;
    };
    let n = ring.len();
    let size = polygon::area(ring).abs().sqrt();
    for (k, edge) in polygon::edges(ring).enumerate() {
        if polygon::distance(edge, place) <= 1e-6 * size {
            let share = edge[0].distance(place) / edge[0].distance(edge[1]);
            let blend = surface.normals[k].lerp(surface.normals[(k + 1) % n], share.min(1.0));
            return blend.normalize_or(surface.plane.normal);
        }
    }
    let half_angle = |k: usize| {
        let (a, b) = (ring[k % n] - place, ring[(k + 1) % n] - place);
        (a.angle_to(b) / 2.0).tan()
    };
    let weight = |k: usize| (half_angle(k + n - 1) + half_angle(k)) / ring[k].distance(place);
    let blend: DVec3 = (0..n).map(|k| surface.normals[k] * weight(k)).sum();
    blend.normalize_or(surface.plane.normal)
}
