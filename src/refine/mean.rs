//! The mean radiosity that errors are shares of.

use crate::colour::{Rgb, strength};
use crate::light::{Optics, VertexLight};
use crate::mesh::{Element, Mesh};

/// Estimate of the mean radiosity of the scene's surfaces, W/m², from the direct light at the corners of leaves.
///
/// Interreflection is taken as in a closed room: 1 / (1 - mean reflectance) times the direct light.
pub fn mean_radiosity(mesh: &Mesh, optics: &Optics, light: &VertexLight) -> f64 {
    let (mut area, mut reflected, mut reflectance) = (0.0, 0.0, 0.0);
    for leaf in mesh.leaves() {
        let Element { ref corners, patch, area: part, .. } = mesh[leaf];
        let light: Rgb =
            corners.iter().filter_map(|&v| light.direct(v)).map(|d| d.irradiance).sum();
        reflected +=
            strength(optics.reflectance[patch.index()] * light) / corners.len() as f64 * part;
        reflectance += strength(optics.reflectance[patch.index()]) * part;
        area += part;
    }
    reflected / (area - reflectance).max(f64::MIN_POSITIVE)
}
