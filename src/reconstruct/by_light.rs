//! A mesh that keeps the light of each group of lights apart, so that they can be dimmed.

use super::assemble::{EmitterStrength, reconstruct_for};
use super::trimesh::{LightShare, TriMesh};
use crate::colour::Rgb;
use crate::solver::Solution;
use crate::surface::{LightGroup, Surfaces};

/// The triangle mesh of a solution that is the sum of `parts`, each with its group and with the surfaces lit by that
/// alone; the mesh can be [relit](TriMesh::relight).
pub fn reconstruct_by_light(
    surfaces: &Surfaces,
    solution: &Solution,
    parts: impl IntoIterator<Item = (LightGroup, Surfaces, Solution)>,
) -> TriMesh {
    let mut mesh = reconstruct_for(EmitterStrength::Dimmable, surfaces, solution);
    let share = |(group, surfaces, part): (LightGroup, Surfaces, Solution)| {
        let radiosity = reconstruct_for(EmitterStrength::Dimmable, &surfaces, &part).radiosity;
        LightShare { group, radiosity }
    };
    mesh.lights = parts.into_iter().map(share).collect();
    mesh.add_lights();
    mesh
}

impl TriMesh {
    /// Gives one of [`TriMesh::lights`] another strength, in its own unit; `irradiance` is not kept, since only what
    /// leaves a surface is known by light.
    pub fn relight(&mut self, light: usize, strength: Rgb) {
        self.lights[light].group.strength = strength;
        self.irradiance.clear();
        self.add_lights();
    }

    /// Radiosity is the sum of all lights.
    fn add_lights(&mut self) {
        for (vertex, radiosity) in self.radiosity.iter_mut().enumerate() {
            let light = |share: &LightShare| share.group.strength * share.radiosity[vertex];
            *radiosity = self.lights.iter().map(light).sum();
        }
    }
}
