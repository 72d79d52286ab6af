//! How patches reflect and emit.

use rayon::prelude::*;

use crate::colour::Rgb;
use crate::mesh::{Element, Mesh, PatchId, VertexId};
use crate::surface::{Surfaces, mean_reflectance, mean_texture};

/// Diffuse optics of the patches of a mesh; both lists one entry per patch.
#[derive(Clone, Debug, Default)]
pub struct Optics {
    /// Mean diffuse reflectance, textures included.
    pub reflectance: Vec<Rgb>,
    /// Mean exitance, W/m², textures included.
    pub exitance: Vec<Rgb>,
}

impl Optics {
    /// What surfaces say of the patches of their mesh.
    pub fn new(surfaces: &Surfaces, mesh: &Mesh) -> Self {
        let of = |index: usize| {
            let patch = &mesh.patches[index];
            let (surface, outline) = (&surfaces[patch.surface], mesh.outline(patch.root));
            let exitance = surface.exitance * mean_texture(surfaces, surface, &outline)[1];
            (mean_reflectance(surfaces, surface, &outline), exitance)
        };
        let (reflectance, exitance) = (0..mesh.patches.len()).into_par_iter().map(of).unzip();
        Self { reflectance, exitance }
    }

    /// Mean diffuse reflectance of the patch of an element.
    pub fn of(&self, element: &Element) -> Rgb {
        self.reflectance[element.patch.index()]
    }

    /// Radiosity of an element by `irradiance` at a vertex, both W/m².
    pub fn reflected<F: Fn(VertexId) -> Rgb>(
        &self,
        element: &Element,
        irradiance: F,
    ) -> impl Fn(VertexId) -> Rgb + use<F> {
        let reflectance = self.of(element);
        move |vertex| reflectance * irradiance(vertex)
    }

    /// Black patches show no light, so nothing is gained by dividing them.
    pub fn reflects(&self, patch: PatchId) -> bool {
        self.reflectance[patch.index()].max_element() > 0.0
    }

    /// True if the patch is a lamp.
    pub fn shines(&self, patch: PatchId) -> bool {
        self.exitance[patch.index()].max_element() > 0.0
    }
}
