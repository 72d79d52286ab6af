//! What every writer asks of a mesh: its colours on a screen and a few words about them.

use glam::DVec3;

use super::group::Group;
use super::stamp::Stamp;
use crate::colour::{Rgb, srgb_from_linear};
use crate::reconstruct::TriMesh;
use crate::scene::Texture;
use crate::tone::{Exposure, exposure_scale, exposure_value, tone_map};

/// Name of the curve behind [`tone_map`], for the record.
pub(crate) const TONE_CURVE: &str = "PBR Neutral for diffuse surfaces, linear up to 0.4";

/// A mesh, its stamp and the exposure that follows from both.
#[derive(Debug)]
pub(crate) struct ExposedMesh<'a> {
    pub(crate) mesh: &'a TriMesh,
    pub(crate) stamp: &'a Stamp,
    /// Factor on radiosity before the tone curve, m²/W.
    pub(crate) scale: f64,
    /// [`TriMesh::local_origin`].
    pub(crate) origin: DVec3,
    /// [`Texture::white`] of the mesh's textures.
    pub(crate) whites: Vec<f64>,
}

impl<'a> ExposedMesh<'a> {
    pub(crate) fn new(mesh: &'a TriMesh, stamp: &'a Stamp) -> Self {
        debug_assert!(mesh.positions.iter().all(|position| position.is_finite()));
        debug_assert!(mesh.normals.iter().all(|normal| normal.is_normalized()));
        debug_assert!(mesh.radiosity.iter().all(|radiosity| radiosity.is_finite()));
        let whites = mesh.textures.iter().map(Texture::white).collect();
        Self {
            mesh,
            stamp,
            scale: exposure_scale(mesh, stamp.exposure),
            origin: mesh.local_origin(),
            whites,
        }
    }

    /// Linear colour, 0..=1, of the light that leaves a vertex.
    pub(crate) fn colour(&self, vertex: u32) -> Rgb {
        tone_map(self.mesh.radiosity[vertex as usize] * self.scale)
    }

    /// Linear colour, 0..=1, that is to be shown at a vertex of a group, or to be multiplied by its picture's colours
    /// once they are divided by the picture's white.
    pub(crate) fn shown(&self, vertex: u32, group: &Group) -> Rgb {
        let Some(texture) = group.texture else {
            return self.colour(vertex);
        };
        tone_map(self.mesh.light(vertex as usize) * self.whites[texture as usize] * self.scale)
    }

    /// Sentences for the comments of text headers, one a line.
    pub(crate) fn remarks(&self) -> Vec<String> {
        let mode = match self.stamp.exposure {
            Exposure::Automatic | Exposure::Found(_) => "automatic",
            Exposure::Ev(_) => "chosen",
        };
        let ev = exposure_value(self.scale);
        let mut remarks = vec![
            format!("Light on a mesh, by radiosity {}; metres, Y up.", env!("CARGO_PKG_VERSION")),
            format!(
                "Colours: radiosity in W/m^2 times {:.6e} (EV {ev:.2}, {mode}), tone curve {TONE_CURVE}, sRGB.",
                self.scale
            ),
        ];
        if !self.stamp.finished {
            remarks.push("Unfinished: the solver was stopped before it was done.".to_owned());
        }
        remarks
    }
}

/// sRGB-coded values, 0..=1, of a linear colour.
pub(crate) fn coded(colour: Rgb) -> [f64; 3] {
    colour.to_array().map(srgb_from_linear)
}

/// The nearest finite single-precision numbers.
pub(crate) fn singles(vector: DVec3) -> [f32; 3] {
    let limit = f64::from(f32::MAX);
    vector.to_array().map(|x| x.clamp(-limit, limit) as f32)
}
