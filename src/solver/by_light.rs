//! Light of each group of lights by itself, on one mesh that does justice to all of them.
//!
//! Radiosity is linear in what is emitted: once each group has been solved for alone, at a strength of 1, any
//! other strengths and colours take a weighted sum. So that the sum is what a fresh solution would be, nothing may
//! depend on the strengths: the mesh is refined for each group as if it alone shone.

use std::ops::ControlFlow;

use super::direct_pass::{self, World};
use super::groups::Groups;
use super::interpolate::{REFLECTED, interpolate};
use super::{
    Checkpoint, DARK, ElementLight, Energy, Exchange, Observer, Progress, Solution, Stop, Work,
    check_reflectances, lamps_on, reflect,
};
use crate::colour::Rgb;
use crate::direct::PatchLight;
use crate::error::{Error, Result};
use crate::mesh::{Direct, Mesh};
use crate::settings::Settings;
use crate::surface::Surfaces;

/// A scene in which one group of lights alone shines.
struct Alone<'a> {
    surfaces: &'a Surfaces,
    light: PatchLight,
    groups: Groups,
    /// By patch, W/m².
    exitance: Vec<Rgb>,
    /// By vertex: direct light, and irradiance by reflected light, W/m².
    known: Vec<(Option<Direct>, Option<Rgb>)>,
}

/// Lights the same surfaces under each of several lights, all on the same mesh: the solution of each, and their sum
/// at these strengths.
///
/// `scenes` has each light alone and its strength, see [`Surfaces::lit_by`]. What is told of each and of the sum, is of the
/// way to them; elements of [`Solution::light`] are those that the first light had.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn solve_by_light(
    scenes: &[(Surfaces, Rgb)],
    settings: &Settings,
    checkpoint: &mut Checkpoint,
    mut observe: impl FnMut(&Progress) -> ControlFlow<()>,
) -> Result<(Solution, Vec<Solution>)> {
    let Some((first, _)) = scenes.first() else { return Err(Error::Scene(DARK.to_owned())) };
    first.check()?;
    settings.validate()?;
    let settings = &checkpoint.settings(settings);
    let mut observer = Observer::new(&mut observe, checkpoint);
    let mut alone: Vec<Alone<'_>> = scenes
        .iter()
        .map(|(surfaces, _)| Alone::new(surfaces, settings, &mut observer))
        .collect::<Result<_>>()?;
    let mut mesh = Mesh::new(first, settings);
    for alone in &mut alone {
        alone.take_over(&mut mesh);
        direct_pass::refine(alone.world(), settings, &mut mesh, &mut observer);
        alone.leave(&mesh);
    }
    let mut exchanges = Vec::new();
    for alone in &mut alone {
        alone.take_over(&mut mesh);
        direct_pass::light_leaves(alone.world(), &mut mesh, &mut observer);
        let mut exchange = Exchange::new(alone.world(), settings, &mesh, &mut observer)?;
        let (gathered, work) =
            reflect(alone.world(), settings, (&mut mesh, &mut exchange), &mut observer);
        exchanges.push((exchange, gathered, work));
        alone.leave(&mesh);
    }
    let finish = |(alone, (exchange, gathered, work)): (&Alone<'_>, (Exchange, usize, Work))| {
        let mut mesh = mesh.clone();
        alone.take_over(&mut mesh);
        direct_pass::light_leaves(alone.world(), &mut mesh, &mut observer);
        // It has done without the elements that other lights asked for later.
        interpolate(&mut mesh, REFLECTED);
        exchange.solution(mesh, gathered, work)
    };
    let solutions: Vec<Solution> = alone.iter().zip(exchanges).map(finish).collect();
    let strengths: Vec<Rgb> = scenes.iter().map(|(_, strength)| *strength).collect();
    Ok((sum(&solutions, &strengths), solutions))
}

impl<'a> Alone<'a> {
    fn new(
        surfaces: &'a Surfaces,
        settings: &Settings,
        observer: &mut Observer<'_>,
    ) -> Result<Self> {
        settings.validate_for(surfaces.divided_area(), surfaces.extent)?;
        let mesh = Mesh::new(surfaces, settings);
        check_reflectances(surfaces, &mesh)?;
        let light = lamps_on(surfaces, settings, &mesh, observer)?;
        let groups = Groups::new(surfaces, settings, &mesh);
        let exitance = mesh.patches.iter().map(|patch| patch.exitance).collect();
        Ok(Self { surfaces, light, groups, exitance, known: Vec::new() })
    }

    fn world(&self) -> World<'_> {
        World::new(self.surfaces, &self.light, &self.groups)
    }

    /// Lights a mesh with what is known of this light, and puts out all other.
    fn take_over(&self, mesh: &mut Mesh) {
        for (patch, exitance) in mesh.patches.iter_mut().zip(&self.exitance) {
            patch.exitance = *exitance;
        }
        let known = self.known.iter().copied().chain(std::iter::repeat((None, None)));
        for (vertex, light) in mesh.vertices.iter_mut().zip(known) {
            (vertex.direct, vertex.indirect) = light;
        }
    }

    /// Remembers what a mesh says of this light; vertices are only ever added.
    fn leave(&mut self, mesh: &Mesh) {
        self.known = mesh.vertices.iter().map(|vertex| (vertex.direct, vertex.indirect)).collect();
    }
}

/// The solution for all lights at these strengths.
fn sum(solutions: &[Solution], strengths: &[Rgb]) -> Solution {
    let mut sum = solutions[0].clone();
    let each = || solutions.iter().zip(strengths);
    let total =
        |light: &dyn Fn(&Solution) -> Rgb| each().map(|(s, &strength)| strength * light(s)).sum();
    for patch in 0..sum.mesh.patches.len() {
        sum.mesh.patches[patch].exitance = total(&|s| s.mesh.patches[patch].exitance);
    }
    for vertex in 0..sum.mesh.vertices.len() {
        let direct = |s: &Solution| s.mesh.vertices[vertex].direct.unwrap_or_default();
        sum.mesh.vertices[vertex].direct = Some(Direct {
            irradiance: total(&|s| direct(s).irradiance),
            unoccluded: total(&|s| direct(s).unoccluded),
        });
        let indirect = |s: &Solution| s.mesh.vertices[vertex].indirect.unwrap_or_default();
        sum.mesh.vertices[vertex].indirect = Some(total(&indirect));
    }
    let elements = 0..sum.light.direct.len();
    sum.light = ElementLight {
        direct: elements.clone().map(|e| total(&|s| s.light.direct[e])).collect(),
        indirect: elements.map(|e| total(&|s| s.light.indirect[e])).collect(),
    };
    sum.energy = Energy {
        emitted: total(&|s| s.energy.emitted),
        absorbed: total(&|s| s.energy.absorbed),
        on_backs: total(&|s| s.energy.on_backs),
        escaped: total(&|s| s.energy.escaped),
        unshot: total(&|s| s.energy.unshot),
    };
    sum.ambient = total(&|s| s.ambient);
    sum.stop = solutions.iter().map(|s| s.stop).find(|&s| s != Stop::Converged).unwrap_or(sum.stop);
    sum.shots = solutions.iter().map(|s| s.shots).sum();
    sum.hemicubes = [0, 1].map(|k| solutions.iter().map(|s| s.hemicubes[k]).sum());
    sum.work = solutions.iter().map(|s| s.work).sum();
    sum.history = solutions.iter().flat_map(|s| s.history.iter().copied()).collect();
    sum
}

impl std::iter::Sum for Work {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |a, b| Self {
            direct: a.direct + b.direct,
            exchange: a.exchange + b.exchange,
            gathering: a.gathering + b.gathering,
            rays: a.rays + b.rays,
        })
    }
}
