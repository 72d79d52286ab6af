//! Direct light at the places that a picture shows, not only at vertices.

use std::ops::ControlFlow;

use glam::DVec3;

use crate::colour::Rgb;
use crate::direct::{DirectLight, Emitters};
use crate::mesh::{ElementId, Mesh};
use crate::surface::Surfaces;
use crate::visibility::Occluders;

/// Evaluates direct light anywhere, as the solver does at vertices.
#[derive(Debug)]
pub(super) struct FinalGather<'a> {
    surfaces: &'a Surfaces,
    mesh: &'a Mesh,
    light: DirectLight,
}

impl<'a> FinalGather<'a> {
    /// What each patch sees of the lamps takes a while; `None` if `observe` has broken off by then.
    pub(super) fn new(
        surfaces: &'a Surfaces,
        mesh: &'a Mesh,
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Option<Self> {
        let mut flow = observe(0.0);
        let (lamps, occluders) = (Emitters::new(surfaces, mesh), Occluders::new(surfaces));
        let light = DirectLight::observed(lamps, occluders, mesh, |_| {
            if flow.is_continue() {
                flow = observe(0.0);
            }
            flow
        });
        flow.is_continue().then_some(Self { surfaces, mesh, light })
    }

    /// Irradiance straight from emitters, W/m², at a place on a leaf.
    ///
    /// Seen, like a vertex, from a hair inside the patch, so that what stands along its border neither
    /// hides it nor leaks light to it.
    pub(super) fn direct(&self, leaf: ElementId, place: DVec3) -> Rgb {
        let plane = &self.surfaces[self.mesh.surface_of(leaf)].plane;
        let patch = self.mesh[leaf].patch;
        let site = self.mesh.site(patch, plane.flatten(place));
        self.light.at(patch, site).light.irradiance
    }

    /// Diffuse reflectance at a place on a leaf, without the texture's part; none where emission and reflected light
    /// are in one picture, which cannot tell a change of the one from a change of the other.
    pub(super) fn reflectance(&self, leaf: ElementId, place: DVec3) -> Rgb {
        let surface = &self.surfaces[self.mesh.surface_of(leaf)];
        let material = &self.surfaces[surface.material];
        if surface.is_emitter() && material.texture.or(material.emission_texture).is_some() {
            return Rgb::ZERO;
        }
        surface.reflectance_at(surface.plane.flatten(place))
    }
}
