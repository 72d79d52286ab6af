//! Facets of a curved surface share their light where their normals agree.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::sheet::Sheet;
use crate::surface::{Surface, polygon};

/// Unit normals whose difference is no longer than this are one.
const SAME: f64 = 1e-2;

/// Gives corners of curved facets of one paint, at one place and with one normal, the mean of their radiosities.
pub(super) fn average_across_smooth_edges(sheets: &mut [Sheet]) {
    let mut meeting: HashMap<u32, Vec<(usize, usize)>> = HashMap::new();
    for (number, sheet) in sheets.iter().enumerate().filter(|(_, sheet)| sheet.curved) {
        for (index, corner) in sheet.corners.iter().enumerate() {
            meeting.entry(corner.place).or_default().push((number, index));
        }
    }
    for corners in meeting.values().filter(|corners| corners.len() > 1) {
        let means: Vec<_> =
            corners.iter().map(|&corner| mean_of_alike(sheets, corners, corner)).collect();
        for (&(sheet, index), mean) in corners.iter().zip(means) {
            sheets[sheet].corners[index].radiosity = mean;
        }
    }
}

fn mean_of_alike(
    sheets: &[Sheet],
    corners: &[(usize, usize)],
    (sheet, index): (usize, usize),
) -> crate::colour::Rgb {
    let (own, normal) = (&sheets[sheet], sheets[sheet].corners[index].normal);
    let paint = |other: &Sheet| (other.material, other.reflectance);
    let alike = corners
        .iter()
        .filter(|&&(sheet, _)| paint(&sheets[sheet]) == paint(own))
        .map(|&(sheet, index)| &sheets[sheet].corners[index])
        .filter(|corner| corner.normal.distance(normal) <= SAME);
    let (sum, count) = alike.fold((DVec3::ZERO, 0.0), |(s, n), c| (s + c.radiosity, n + 1.0));
    sum / count
}

/// The normal at a place on a surface, m: its own, or that of the curved surface it stands for, blended between the
/// corners by mean value coordinates ([Floater 2003]).
///
/// [Floater 2003]: https://doi.org/10.1016/S0167-8396(03)00002-5
pub(super) fn normal_at(surface: &Surface, place: DVec2) -> DVec3 {
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
