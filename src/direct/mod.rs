//! Light straight from emitters: exact where a light is a polygon, by rays where it is a point.
//!
//! It carries the hard edges, so it is never carried by the hemicube.

mod candidates;
mod evaluation;
mod glimpse;
mod globe;
mod glow;
mod lamp;
mod lines;
mod patch_light;
mod pool;
mod punctual;
mod rough;
mod sampling;
mod sent;
mod sky;
mod tally;
mod view;

use glam::DVec3;

use crate::form_factor::contour::point_to_polygon_above;
use crate::light::Direct;
use crate::mesh::Mesh;
use crate::scene::{Light, NamedLight};
use crate::surface::Surfaces;
use crate::surface::cut::{Cuts, convex_pieces};
use crate::visibility::{CROWDED, Occluders};

pub use lines::Line;
pub use patch_light::{Outlook, PatchLight};
pub(crate) use sent::Sent;

use lamp::{AreaLamp, Lamp};
use tally::Tally;
use view::{Seen, View};

/// All emitters of a scene.
#[derive(Clone, Debug)]
pub struct Lamps {
    list: Vec<Lamp>,
    /// Rows of cells to each triangle of a light that is always sampled.
    rows: Option<u32>,
    /// Radius of the discs on which the light of points is evaluated, m.
    blur: f64,
    tally: Tally,
}

/// How a lamp's radiance depends on the direction from which it comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RadianceProfile {
    /// Not at all, from a surface.
    Diffuse,
    /// Not at all, from the sky.
    UniformSky,
    /// As that of an overcast sky.
    OvercastSky,
}

impl RadianceProfile {
    /// Irradiance of a place with unit normal by a polygon above its horizon, as a share of the exitance.
    fn weight(self, receiver: (DVec3, DVec3), polygon: &[DVec3]) -> f64 {
        let factor = point_to_polygon_above(receiver.0, receiver.1, polygon);
        match self {
            Self::Diffuse | Self::UniformSky => factor,
            Self::OvercastSky => sky::overcast(receiver, polygon, factor),
        }
    }

    /// Radiance along a unit direction towards the lamp, as a share of the largest.
    fn radiance(self, direction: DVec3) -> f64 {
        match self {
            Self::Diffuse | Self::UniformSky => 1.0,
            Self::OvercastSky => sky::overcast_radiance(direction),
        }
    }

    fn is_sky(self) -> bool {
        self != Self::Diffuse
    }
}

impl Lamps {
    /// The emitting surfaces, in convex pieces, and the lights of a scene.
    pub fn new(surfaces: &Surfaces, mesh: &Mesh) -> Self {
        let globes = globe::globes(surfaces);
        let mut in_globe = vec![false; surfaces.list.len()];
        for &facet in globes.iter().flat_map(|globe| &globe.surfaces) {
            in_globe[facet as usize] = true;
        }
        let emitters = surfaces.list.iter().enumerate().filter(|(_, s)| s.is_emitter());
        let emitters = emitters.filter(|(number, _)| !in_globe[*number]);
        let mut areas: Vec<AreaLamp> =
            emitters.flat_map(|(number, _)| areas_of(surfaces, mesh, number)).collect();
        let mut points = Vec::new();
        for NamedLight { light, .. } in &surfaces.lights {
            match *light {
                Light::Sky { sky, irradiance } => {
                    areas.extend(sky::lamps(surfaces, sky, irradiance));
                }
                Light::Sun { direction, irradiance } => {
                    areas.extend(sky::sun(surfaces, direction, irradiance));
                }
                _ => points.push(Lamp::Point(light.clone())),
            }
        }
        areas.retain(|lamp| lamp.exitance.max_element() > 0.0);
        let areas = areas.into_iter().map(Lamp::Area);
        let list = areas.chain(globes.into_iter().map(Lamp::Globe)).chain(points).collect();
        Self { list, rows: None, blur: 0.0, tally: Tally::default() }
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

    /// How often light has been evaluated so far: pairs of a place and a lamp, or convex piece of one, that
    /// shines there unless something hides it.
    pub fn evaluations(&self) -> u64 {
        self.tally.evaluations()
    }

    /// Shadow rays so far: to lights that are points, and to others where exact cutting has given up.
    pub fn rays(&self) -> u64 {
        self.tally.rays()
    }

    /// Evaluations and rays so far.
    pub(crate) fn counts(&self) -> [u64; 2] {
        [self.evaluations(), self.rays()]
    }

    /// Counts on from these.
    pub(crate) fn count_from(&self, [evaluations, rays]: [u64; 2]) {
        self.tally.set(evaluations, rays);
    }

    /// What arrives at a place with unit `normal`.
    pub fn shine(&self, occluders: &Occluders, place: DVec3, normal: DVec3) -> Direct {
        let all = occluders.all();
        let (mut light, mut evaluations, mut rays) = (Direct::default(), 0, 0);
        for lamp in &self.list {
            let arriving = match lamp {
                Lamp::Point(point) => punctual::shine(point, occluders, (place, normal)),
                lamp => lamp.view((place, normal)).map(|view| {
                    let seen = self.rows.map_or_else(
                        || view.exact(occluders, &all, CROWDED),
                        |rows| Some(view.sampled_evenly(occluders, rows)),
                    );
                    let seen = seen.unwrap_or_else(|| view.sampled(occluders, 0.0));
                    (view.light(seen), seen.rays)
                }),
            };
            if let Some((arriving, more)) = arriving {
                light = light + arriving;
                evaluations += 1;
                rays += more;
            }
        }
        self.tally.add(evaluations, rays);
        light
    }
}

/// The lamps that an emitting surface is: convex pieces, of its patches where a picture says how bright each is.
fn areas_of(surfaces: &Surfaces, mesh: &Mesh, number: usize) -> Vec<AreaLamp> {
    let surface = &surfaces.list[number];
    let front = globe::front(surface, surfaces.tolerance);
    let profile = RadianceProfile::Diffuse;
    if surfaces.materials[surface.material as usize].emission_texture.is_some() {
        let patches = mesh.patches.iter().filter(|patch| patch.surface == number as u32);
        let pieces = patches.flat_map(|patch| glow::pieces(surfaces, patch));
        return pieces
            .map(|(corners, exitance)| AreaLamp { corners, front, exitance, profile })
            .collect();
    }
    let cuts = Cuts { segments: &[], size: f64::INFINITY, tolerance: surfaces.tolerance };
    let pieces = convex_pieces(&surface.rings, &cuts);
    let lamp = |piece: &crate::surface::polygon::Convex| AreaLamp {
        corners: piece.iter().map(|&p| surface.plane.lift(p)).collect(),
        front,
        exitance: surface.exitance,
        profile,
    };
    pieces.iter().map(lamp).collect()
}
