//! Light at places that are no vertices, in mid-air even: what an illuminance meter would show there.

use std::ops::ControlFlow;

use glam::DVec3;

use super::clusters::Clusters;
use super::context::GatherContext;
use super::gather::Gatherer;
use super::solution::Solution;
use super::sources::Sources;
use crate::colour::{LUMENS_PER_WATT, Rgb, luminance};
use crate::direct::Emitters;
use crate::form_factor::hemicube::{Hemicube, HemicubeScene, turn};
use crate::settings::Settings;
use crate::surface::Surfaces;
use crate::visibility::{Occluders, SurfacePoint};
use crate::watch::{Enough, in_batches};

/// What arrives at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// Where, m.
    pub place: DVec3,
    /// Unit normal of the plane that it arrives on.
    pub normal: DVec3,
    /// Irradiance straight from emitters, W/m².
    pub direct: Rgb,
    /// Irradiance by reflected light, W/m².
    pub indirect: Rgb,
}

impl Reading {
    /// Illuminance straight from emitters, lx.
    pub fn direct_lux(&self) -> f64 {
        luminance(self.direct) * LUMENS_PER_WATT
    }

    /// Illuminance by reflected light, lx.
    pub fn indirect_lux(&self) -> f64 {
        luminance(self.indirect) * LUMENS_PER_WATT
    }

    /// Illuminance, lx.
    pub fn lux(&self) -> f64 {
        self.direct_lux() + self.indirect_lux()
    }
}

/// Reads a solution at points: direct light exactly, reflected light by a hemicube over each.
///
/// `settings` are those of the solution. `observe` is told of the share done; when it breaks off, the rest is
/// left out.
pub fn read(
    surfaces: &Surfaces,
    settings: &Settings,
    solution: &Solution,
    points: &[SurfacePoint],
    observe: impl FnMut(f64) -> ControlFlow<()>,
) -> Vec<Reading> {
    let Solution { mesh, vertex_light, .. } = solution;
    let occluders = Occluders::new(surfaces);
    let emitters = Emitters::new(surfaces, mesh).seen_by(settings.shadow_rays);
    let sources = Sources::of_solution(solution);
    let mean = sources.mean_radiosity_shown(mesh, vertex_light);
    let clusters = Clusters::new(surfaces, settings, mesh);
    let surroundings = GatherContext { surfaces, occluders: &occluders, clusters: &clusters };
    let gatherer = Gatherer::new(surroundings, settings, mesh, sources, mean);
    let targets = HemicubeScene::new(&mesh.patches);
    let hemicube = |_: &Enough| Hemicube::new(gatherer.delta(), &targets, &occluders);
    let numbered: Vec<_> = points.iter().copied().enumerate().collect();
    let reading = |hemicube: &mut Hemicube<'_>, &(k, point): &(usize, SurfacePoint)| Reading {
        place: point.position,
        normal: point.normal,
        direct: emitters.shine(&occluders, point.position, point.normal).irradiance,
        indirect: gatherer.at(mesh, hemicube, point, turn(k as f64)),
    };
    in_batches(&numbered, hemicube, reading, observe)
}
