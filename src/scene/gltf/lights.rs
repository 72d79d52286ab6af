//! Cameras and lights (`KHR_lights_punctual`), in our units.

use std::f64::consts::{FRAC_PI_2, PI};

use ::gltf::json;
use ::gltf::json::extensions::scene::khr_lights_punctual::{self, Type};
use ::gltf::json::scene::Node;
use ::gltf::json::validation::Checked;
use glam::{DMat4, DVec3, Vec3};

use super::import::GltfImport;
use crate::colour::LUMENS_PER_WATT;
use crate::error::Result;
use crate::scene::limits::{MAX_RADIANCE, tamed};
use crate::scene::notes::listed;
use crate::scene::{Camera, EmissionUnit, Light, NamedLight};

impl GltfImport<'_> {
    /// Adds a perspective camera that looks along its node's -Z.
    pub(super) fn add_camera(&mut self, camera: &json::Camera, node: &Node, transform: DMat4) {
        let target = direction(transform, DVec3::NEG_Z);
        let up = direction(transform, DVec3::Y);
        let name = node.name.clone().or_else(|| camera.name.clone()).unwrap_or_default();
        let fov = camera.perspective.as_ref().map(|view| f64::from(view.yfov));
        let fov = fov.filter(|fov| *fov > 0.0 && *fov < PI);
        let (Some(vertical_fov), Some(forward), Some(up)) = (fov, target, up) else {
            self.skipped.cameras += 1;
            return;
        };
        if forward.cross(up).length() < 1e-6 {
            self.skipped.cameras += 1;
            return;
        }
        let eye = transform.w_axis.truncate();
        self.scene.cameras.push(Camera { name, eye, target: eye + forward, up, vertical_fov });
    }

    /// Adds a light that shines along its node's -Z, with its own name or the node's; candela become W/sr, lux become W/m².
    pub(super) fn add_light(
        &mut self,
        light: &khr_lights_punctual::Light,
        node: &Node,
        transform: DMat4,
    ) -> Result<()> {
        let Checked::Valid(kind) = light.type_ else {
            return Err(self.file.fail("a light of unknown type"));
        };
        let colour = Vec3::from(light.color).as_dvec3();
        let intensity = tamed(colour * f64::from(light.intensity) / LUMENS_PER_WATT, MAX_RADIANCE);
        let position = transform.w_axis.truncate();
        let Some(direction) = direction(transform, DVec3::NEG_Z) else {
            self.scene.notes.push("a light without direction left out".to_owned());
            return Ok(());
        };
        let range = light.range.map_or(f64::INFINITY, f64::from);
        let named = light.name.clone().or_else(|| node.name.clone());
        let light = match kind {
            Type::Directional => Light::Directional { direction, irradiance: intensity },
            Type::Point => Light::Point { position, intensity },
            Type::Spot => {
                let (inner_angle, outer_angle) = cone(light);
                Light::Spot { position, direction, intensity, inner_angle, outer_angle }
            }
        };
        let name = named.unwrap_or_else(|| light.kind().to_owned());
        if light.position().is_some() && range > 0.0 {
            self.ranges.push((name.clone(), position, range));
        }
        self.scene.lights.push(NamedLight { name, light });
        Ok(())
    }

    /// Tells what lamps of the file mean that is not taken at its word.
    pub(super) fn note_lights(&mut self, emission: EmissionUnit) {
        let Some((low, high)) = self.scene.bounds() else { return };
        let reach = |place: DVec3| (low - place).abs().max((high - place).abs()).length();
        let cut = self.ranges.iter().filter(|(_, place, range)| *range < reach(*place));
        let cut: Vec<String> = cut.map(|(name, ..)| name.clone()).collect();
        if !cut.is_empty() {
            self.scene.notes.push(format!(
                "the range of {} is not taken for an end of its light, which falls off by the square of the distance",
                listed(&cut)
            ));
        }
        if emission == EmissionUnit::Radiance
            && !self.scene.lights.is_empty()
            && self.scene.emitters().next().is_some()
        {
            self.scene.notes.push(
                "emission of materials is taken as W/(m² sr), beside lights in candela or lux: if it is in cd/m², use --emission nits"
                    .to_owned(),
            );
        }
    }
}

/// The unit direction that a node's `axis` has in the world.
fn direction(transform: DMat4, axis: DVec3) -> Option<DVec3> {
    transform.transform_vector3(axis).try_normalize()
}

/// Inner and outer half angle, radians, brought into 0 ≤ inner < outer ≤ π/2.
fn cone(light: &khr_lights_punctual::Light) -> (f64, f64) {
    let spot = light.spot.as_ref();
    let outer = spot.map_or(PI / 4.0, |spot| f64::from(spot.outer_cone_angle));
    let inner = spot.map_or(0.0, |spot| f64::from(spot.inner_cone_angle));
    let outer = if outer > 0.0 { outer.min(FRAC_PI_2) } else { PI / 4.0 };
    let inner = if inner > 0.0 { inner } else { 0.0 };
    // The format wants inner < outer; a hard edge is as close as one can come to more.
    (inner.min(outer * (1.0 - 1e-6)), outer)
}
