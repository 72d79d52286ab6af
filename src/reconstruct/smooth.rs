//! Facets of a curved surface share their light where their normals agree.

use std::collections::HashMap;

use super::surface_triangles::{LitCorner, SurfaceTriangles};
use super::trimesh::Irradiance;
use crate::colour::Rgb;

/// Unit normals whose difference is no longer than this are one, and so are reflectances.
const SAME: f64 = 1e-2;

/// A corner of a surface's triangles.
#[derive(Clone, Copy, Debug)]
struct CornerId {
    surface: usize,
    corner: usize,
}

impl CornerId {
    fn of(self, all: &[SurfaceTriangles]) -> &LitCorner {
        &all[self.surface].corners[self.corner]
    }
}

/// Gives corners of curved facets of one paint, at one place and with one normal, the mean of their
/// light, as it leaves and as it arrives.
pub(super) fn average_across_smooth_edges(all: &mut [SurfaceTriangles]) {
    let mut meeting: HashMap<u32, Vec<CornerId>> = HashMap::new();
    for (surface, own) in all.iter().enumerate().filter(|(_, own)| own.curved) {
        for (index, corner) in own.corners.iter().enumerate() {
            meeting.entry(corner.place).or_default().push(CornerId { surface, corner: index });
        }
    }
    for corners in meeting.values().filter(|corners| corners.len() > 1) {
        let means: Vec<_> =
            corners.iter().map(|&corner| mean_of_alike(all, corners, corner)).collect();
        for (&CornerId { surface, corner }, [radiosity, emitted, texture_mean, direct, indirect]) in
            corners.iter().zip(means)
        {
            let corner = &mut all[surface].corners[corner];
            (corner.radiosity, corner.emitted, corner.texture_mean) =
                (radiosity, emitted, texture_mean);
            corner.irradiance = Irradiance { direct, indirect, ..corner.irradiance };
        }
    }
}

/// Means of radiosity, of what of it is emitted, of the texture's means, all to stay in proportion, and of direct and
/// indirect irradiance.
fn mean_of_alike(all: &[SurfaceTriangles], corners: &[CornerId], id: CornerId) -> [Rgb; 5] {
    let (material, own) = (all[id.surface].material, id.of(all));
    let alike = corners
        .iter()
        .filter(|other| all[other.surface].material == material)
        .map(|other| other.of(all))
        .filter(|corner| corner.normal.distance(own.normal) <= SAME)
        .filter(|corner| corner.reflectance.distance(own.reflectance) <= SAME);
    let mut sums = [Rgb::ZERO; 5];
    let mut count = 0.0;
    for LitCorner { radiosity, emitted, texture_mean, irradiance, .. } in alike {
        let light = [*radiosity, *emitted, *texture_mean, irradiance.direct, irradiance.indirect];
        sums.iter_mut().zip(light).for_each(|(sum, light)| *sum += light);
        count += 1.0;
    }
    sums.map(|sum| sum / count)
}
