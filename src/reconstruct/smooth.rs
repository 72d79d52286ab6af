//! Facets of a curved surface share their light where their normals agree.

use std::collections::HashMap;

use super::sheet::{Corner, Sheet};
use super::trimesh::Irradiance;
use crate::colour::Rgb;

/// Unit normals whose difference is no longer than this are one, and so are reflectances.
const SAME: f64 = 1e-2;

/// Gives corners of curved facets of one paint, at one place and with one normal, the mean of their
/// light, as it leaves and as it arrives.
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
        for (&(sheet, index), [radiosity, emitted, texture_mean, direct, indirect]) in
            corners.iter().zip(means)
        {
            let corner = &mut sheets[sheet].corners[index];
            (corner.radiosity, corner.emitted, corner.texture_mean) =
                (radiosity, emitted, texture_mean);
            corner.irradiance = Irradiance { direct, indirect, ..corner.irradiance };
        }
    }
}

/// Means of radiosity, of what of it is emitted, of the texture's means, all to stay in proportion, and of direct and
/// indirect irradiance.
fn mean_of_alike(
    sheets: &[Sheet],
    corners: &[(usize, usize)],
    (sheet, index): (usize, usize),
) -> [Rgb; 5] {
    let (material, own) = (sheets[sheet].material, &sheets[sheet].corners[index]);
    let alike = corners
        .iter()
        .filter(|&&(sheet, _)| sheets[sheet].material == material)
        .map(|&(sheet, index)| &sheets[sheet].corners[index])
        .filter(|corner| corner.normal.distance(own.normal) <= SAME)
        .filter(|corner| corner.reflectance.distance(own.reflectance) <= SAME);
    let mut sums = [Rgb::ZERO; 5];
    let mut count = 0.0;
    for Corner { radiosity, emitted, texture_mean, irradiance, .. } in alike {
        let light = [*radiosity, *emitted, *texture_mean, irradiance.direct, irradiance.indirect];
        sums.iter_mut().zip(light).for_each(|(sum, light)| *sum += light);
        count += 1.0;
    }
    sums.map(|sum| sum / count)
}
