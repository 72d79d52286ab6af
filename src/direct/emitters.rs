//! All emitters of a scene, and what arrives from them at a point.

use glam::DVec3;

use super::emitter::{AreaEmitter, Emitter};
use super::profile::RadianceProfile;
use super::{globe, glow, punctual, sky};
use crate::geometry::cut::{Cuts, convex_pieces};
use crate::light::Direct;
use crate::mesh::Mesh;
use crate::scene::{Light, NamedLight};
use crate::surface::{SurfaceId, Surfaces};
use crate::visibility::{CROWDED, Occluders, SurfacePoint};

/// All emitters of a scene.
#[derive(Clone, Debug)]
pub struct Emitters {
    pub(super) list: Vec<Emitter>,
    /// Rows of cells to each triangle of a light that is always sampled.
    pub(super) rows: Option<u32>,
    /// Radius of the discs on which the light of points is evaluated, m.
    pub(super) blur: f64,
}

impl Emitters {
    /// The emitting surfaces, in convex pieces, and the lights of a scene.
    pub fn new(surfaces: &Surfaces, mesh: &Mesh) -> Self {
        let globes = globe::globes(surfaces);
        let mut in_globe = vec![false; surfaces.list.len()];
        for &facet in globes.iter().flat_map(|globe| &globe.surfaces) {
            in_globe[facet.index()] = true;
        }
        let emitters = surfaces.ids();
        let emitters = emitters.filter(|&id| surfaces[id].is_emitter() && !in_globe[id.index()]);
        let mut areas: Vec<AreaEmitter> =
            emitters.flat_map(|id| areas_of(surfaces, mesh, id)).collect();
        let mut points = Vec::new();
        for NamedLight { light, .. } in &surfaces.lights {
            match *light {
                Light::Sky { sky, irradiance } => {
                    areas.extend(sky::emitters(surfaces, sky, irradiance));
                }
                Light::Sun { direction, irradiance } => {
                    areas.extend(sky::sun(surfaces, direction, irradiance));
                }
                _ => points.push(Emitter::Point(light.clone())),
            }
        }
        areas.retain(|emitter| emitter.exitance.max_element() > 0.0);
        let areas = areas.into_iter().map(Emitter::Area);
        let list = areas.chain(globes.into_iter().map(Emitter::Globe)).chain(points).collect();
        Self { list, rows: None, blur: 0.0 }
    }

    /// With [`Settings::shadow_rays`](crate::settings::Settings::shadow_rays): what hides a polygon is found by about
    /// that many rays to each of its triangles, one through each of equal cells, instead of exactly.
    #[must_use]
    pub fn seen_by(self, rays: Option<u32>) -> Self {
        let rows = rays.map(|rays| f64::from(rays).sqrt().round().max(1.0) as u32);
        Self { rows, ..self }
    }

    /// With the light of points as the mean over discs of this radius, m: between places so far apart, no peak is
    /// missed or taken for wider than it is.
    #[must_use]
    pub fn blurred(self, radius: f64) -> Self {
        Self { blur: radius, ..self }
    }

    /// True if there is no light at all.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// What arrives at a place with unit `normal`.
    pub fn shine(&self, occluders: &Occluders, place: DVec3, normal: DVec3) -> Direct {
        let (all, receiver) = (occluders.all(), SurfacePoint::new(place, normal));
        let mut light = Direct::default();
        for emitter in &self.list {
            let arriving = match emitter {
                Emitter::Point(point) => punctual::shine(point, occluders, receiver),
                emitter => emitter.view(receiver).map(|view| {
                    let seen = self.rows.map_or_else(
                        || view.exact(occluders, &all, CROWDED),
                        |rows| Some(view.sampled_evenly(occluders, rows)),
                    );
                    let seen = seen.unwrap_or_else(|| view.sampled(occluders, 0.0));
                    view.light(seen)
                }),
            };
            light = light + arriving.unwrap_or_default();
        }
        light
    }
}

/// The emitters that an emitting surface is: convex pieces, of its patches where a picture says how bright each is.
fn areas_of(surfaces: &Surfaces, mesh: &Mesh, id: SurfaceId) -> Vec<AreaEmitter> {
    let surface = &surfaces[id];
    let front = globe::front(surface, surfaces.epsilon);
    let profile = RadianceProfile::Diffuse;
    if surfaces[surface.material].emission_texture.is_some() {
        let patches = mesh.patches.iter().filter(|patch| patch.surface == id);
        let pieces = patches.flat_map(|patch| glow::pieces(surfaces, patch));
        return pieces
            .map(|(corners, exitance)| AreaEmitter { corners, front, exitance, profile })
            .collect();
    }
    let cuts = Cuts { segments: &[], size: f64::INFINITY, epsilon: surfaces.epsilon };
    let pieces = convex_pieces(&surface.rings, &cuts);
    let emitter = |piece: &crate::geometry::polygon::Convex| AreaEmitter {
        corners: piece.iter().map(|&p| surface.plane.lift(p)).collect(),
        front,
        exitance: surface.exitance,
        profile,
    };
    pieces.iter().map(emitter).collect()
}
