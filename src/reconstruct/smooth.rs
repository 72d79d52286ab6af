//! Facets of a curved surface share their light where their normals agree.

use std::collections::HashMap;

use glam::DVec3;

use super::sheet::Sheet;

/// Unit normals whose difference is no longer than this are one.
const SAME: f64 = 1e-2;

/// Gives corners of curved facets of one paint, at one place and with one normal, the mean of their
/// radiosities.
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
