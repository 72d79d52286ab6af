//! Reflected light at a point, by paths: no mesh, no noise that is not told.

use std::f64::consts::TAU;
use std::ops::Range;

use glam::{DMat3, DVec2, DVec3};

use super::sobol::SobolSequence;
use crate::colour::Rgb;
use crate::direct::Emitters;
use crate::light::Direct;
use crate::mesh::Mesh;
use crate::settings::Settings;
use crate::surface::{Surface, SurfaceId, Surfaces};
use crate::visibility::{Met, Occluders, SurfacePoint};

/// Steps of the R₂ sequence, which fills the unit square evenly ([Roberts 2018]): 1 / g and 1 / g², g³ = g + 1.
///
/// [Roberts 2018]: https://extremelearning.com.au/unreasonable-effectiveness-of-quasirandom-sequences/
pub(super) const R2: DVec2 = DVec2::new(0.754_877_666_246_692_8, 0.569_840_290_998_053_3);

/// The most a path may be sure to go on.
const SURVIVAL: f64 = 0.95;

/// A place on a surface, in front of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Index into [`Surfaces::list`].
    pub surface: SurfaceId,
    /// The place, m.
    pub place: DVec3,
    /// Unit normal.
    pub normal: DVec3,
}

/// What paths from a place have found.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    /// Sum of irradiances by reflected light, W/m².
    pub(super) indirect: Rgb,
    /// Paths that met nothing at all.
    pub(super) escaped: u32,
}

/// Light of a scene anywhere: straight from emitters exactly, the rest by paths.
#[derive(Debug)]
pub(super) struct PathTracer<'a> {
    pub(super) surfaces: &'a Surfaces,
    occluders: Occluders,
    lamps: Emitters,
}

impl<'a> PathTracer<'a> {
    pub(super) fn new(surfaces: &'a Surfaces) -> Self {
        // Of the mesh, only textured lamps have something: they are as many as it has patches of them.
        let mesh = Mesh::new(surfaces, &Settings::medium());
        Self {
            surfaces,
            occluders: Occluders::new(surfaces),
            lamps: Emitters::new(surfaces, &mesh),
        }
    }

    /// Light straight from emitters, W/m².
    pub(super) fn direct(&self, site: &Site) -> Direct {
        self.lamps.shine(&self.occluders, site.place, site.normal)
    }

    /// Diffuse reflectance at a place, its texel included.
    pub(super) fn reflectance(&self, site: &Site) -> Rgb {
        let surface = &self.surfaces[site.surface];
        let reflectance = surface.reflectance_at(surface.plane.flatten(site.place));
        reflectance * texel(self.surfaces, surface, site.place)
    }

    /// Sum over paths of the light that arrives by reflection, W/m² each; their first directions fill the
    /// hemisphere evenly, the second ones and places on lamps too.
    pub(super) fn indirect(&self, site: &Site, paths: Range<u32>, seed: u64) -> Found {
        let frame = frame(site.normal);
        let mut found = Found::default();
        for path in paths {
            let mut numbers = SobolSequence::new(seed, path);
            match self.meet(site.place, frame * cosine_weighted(numbers.pair())) {
                None => found.escaped += 1,
                Some((_, false)) => (),
                Some((met, true)) => found.indirect += self.path(met, numbers),
            }
        }
        found
    }

    /// Share of what a place sees, by its cosine, that is the backs of surfaces.
    pub(super) fn backs(&self, site: &Site, looks: u32) -> f64 {
        let frame = frame(site.normal);
        let is_back = |look: &u32| {
            let direction = cosine_weighted((R2 * f64::from(*look)).fract());
            matches!(self.meet(site.place, frame * direction), Some((_, false)))
        };
        (0..looks).filter(is_back).count() as f64 / f64::from(looks)
    }

    /// What a ray meets first, and whether that is the front of a surface.
    fn meet(&self, place: DVec3, direction: DVec3) -> Option<(Site, bool)> {
        let Met { place, surface, front } = self.occluders.first(place, direction)?;
        let other = if front { None } else { self.surfaces.other_side(surface) };
        let surface = other.unwrap_or(surface);
        let normal = self.surfaces[surface].plane.normal;
        Some((Site { surface, place, normal }, front || other.is_some()))
    }

    /// Radiosity by reflection at a place and along one path from it, W/m²; emission is not part of it.
    ///
    /// B = ρ (direct + B') with B' that of the place which the path meets next, and so on; from the second place
    /// on it goes on with a probability that falls with what it still carries, and then carries that much more.
    fn path(&self, start: Site, mut numbers: SobolSequence) -> Rgb {
        let (mut carried, mut light) = (Rgb::ONE, Rgb::ZERO);
        let mut site = start;
        for bounce in 0.. {
            carried *= self.reflectance(&site);
            let survival = if bounce == 0 { 1.0 } else { carried.max_element().min(SURVIVAL) };
            if carried == Rgb::ZERO {
                break;
            }
            let point = SurfacePoint::new(site.place, site.normal);
            let numbers = &mut numbers;
            light +=
                carried * self.lamps.sample_unbiased(&self.occluders, point, || numbers.number());
            if survival < 1.0 && numbers.coin() >= survival {
                break;
            }
            carried /= survival;
            match self.meet(site.place, frame(site.normal) * cosine_weighted(numbers.pair())) {
                Some((next, true)) => site = next,
                _ => break,
            }
        }
        light
    }
}

/// Colour of the texture at a place; 1 where there is none.
pub(super) fn texel(surfaces: &Surfaces, surface: &Surface, place: DVec3) -> Rgb {
    let texture = surfaces[surface.material].texture;
    texture.zip(surface.uv).map_or(Rgb::ONE, |(texture, uv)| {
        let at = uv.transform_point2(surface.plane.flatten(place));
        surfaces.textures[texture as usize].sample(at)
    })
}

/// A frame whose third axis is the normal.
fn frame(normal: DVec3) -> DMat3 {
    let (u, v) = normal.any_orthonormal_pair();
    DMat3::from_cols(u, v, normal)
}

/// A direction about +z, as many in each as its cosine (Malley: even on the disc, lifted to the sphere).
fn cosine_weighted(square: DVec2) -> DVec3 {
    let (sine, cosine) = (TAU * square.y).sin_cos();
    let radius = square.x.sqrt();
    DVec3::new(radius * cosine, radius * sine, (1.0 - square.x).max(0.0).sqrt())
}
