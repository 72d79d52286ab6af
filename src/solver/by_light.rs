//! Light of each group of lights by itself, on one mesh that does justice to all of them.
//!
//! Radiosity is linear in what is emitted: once each group has been solved for alone, at a strength of 1, any
//! other strengths and colours take a weighted sum. So that the sum is what a fresh solution would be, nothing may
//! depend on the strengths: the mesh is refined for each group as if it alone shone.

use std::ops::ControlFlow;

use serde::Serialize;

use super::checkpoint::Checkpoint;
use super::clusters::Clusters;
use super::context::Context;
use super::interpolate::{REFLECTED, interpolate};
use super::interreflection::Interreflection;
use super::lit_mesh::VertexLighting;
use super::observer::Observer;
use super::power_balance::PowerBalance;
use super::solution::{Progress, Solution};
use super::start::{DARK, check_reflectances, emitters_on};
use super::stop::{Cancellation, Stop};
use super::work::Work;
use super::{direct_light, direct_pass};
use crate::colour::Rgb;
use crate::direct::DirectLight;
use crate::error::{Error, Result};
use crate::light::{Direct, ElementLight, Optics};
use crate::mesh::Mesh;
use crate::settings::Settings;
use crate::surface::Surfaces;

/// A scene in which one group of lights alone shines, see [`Surfaces::lit_by`].
#[derive(Debug, Serialize)]
pub struct ScaledLight {
    /// The surfaces, lit by that group alone, at a strength of 1.
    pub surfaces: Surfaces,
    /// The strength that it has in the sum.
    pub strength: Rgb,
}

/// The same, ready to be solved.
struct Alone<'a> {
    surfaces: &'a Surfaces,
    emitters: DirectLight,
    clusters: Clusters,
    optics: Optics,
}

/// Lights the same surfaces under each of several lights, all on the same mesh: the solution of each, and their sum
/// at these strengths.
///
/// `scenes` has each light alone and its strength. What is told of each and of the sum, is of the
/// way to them.
///
/// # Errors
/// As [`solve`](super::solve).
pub fn solve_by_light(
    scenes: &[ScaledLight],
    settings: &Settings,
    checkpoint: &mut Checkpoint,
    mut observe: impl FnMut(&Progress) -> ControlFlow<Cancellation>,
) -> Result<(Solution, Vec<Solution>)> {
    let Some(ScaledLight { surfaces: first, .. }) = scenes.first() else {
        return Err(Error::Scene(DARK.to_owned()));
    };
    first.check()?;
    settings.validate()?;
    let settings = &checkpoint.settings(settings);
    let mut observer = Observer::new(&mut observe, checkpoint);
    let alone: Vec<Alone<'_>> = scenes
        .iter()
        .map(|scaled| Alone::new(&scaled.surfaces, settings, &mut observer))
        .collect::<Result<_>>()?;
    let mut mesh = Mesh::new(first, settings);
    let mut lights: Vec<VertexLighting> = alone.iter().map(Alone::lighting).collect();
    for (alone, lighting) in alone.iter().zip(&mut lights) {
        direct_pass::refine(alone.context(), settings, &mut lighting.on(&mut mesh), &mut observer);
    }
    let mut interreflections = Vec::new();
    for (alone, lighting) in alone.iter().zip(&mut lights) {
        let (context, lit) = (alone.context(), &mut lighting.on(&mut mesh));
        direct_light::light_leaves(context, lit, &mut observer);
        let mut interreflection =
            Interreflection::new(context, settings, lit.mesh, lit.light, &mut observer)?;
        interreflection.reach_vertices(context, settings, lit, &mut observer);
        interreflections.push(interreflection);
    }
    let finish = |((alone, mut lighting), interreflection): (
        (&Alone<'_>, VertexLighting),
        Interreflection,
    )| {
        let mut mesh = mesh.clone();
        direct_light::light_leaves(alone.context(), &mut lighting.on(&mut mesh), &mut observer);
        // It has done without the elements that other lights asked for later.
        interpolate(&mesh, &mut lighting.light, REFLECTED);
        interreflection.solution(mesh, alone.optics.clone(), lighting)
    };
    let solutions: Vec<Solution> =
        alone.iter().zip(lights).zip(interreflections).map(finish).collect();
    let strengths: Vec<Rgb> = scenes.iter().map(|scaled| scaled.strength).collect();
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
        let optics = Optics::new(surfaces, &mesh);
        check_reflectances(surfaces, &mesh, &optics)?;
        let emitters = emitters_on(surfaces, settings, &mesh, observer)?;
        let clusters = Clusters::new(surfaces, settings, &mesh);
        Ok(Self { surfaces, emitters, clusters, optics })
    }

    /// None yet.
    fn lighting(&self) -> VertexLighting {
        VertexLighting { work: self.emitters.work(), ..VertexLighting::default() }
    }

    fn context(&self) -> Context<'_> {
        Context::new(self.surfaces, &self.optics, &self.emitters, &self.clusters)
    }
}

/// The solution for all lights at these strengths.
fn sum(solutions: &[Solution], strengths: &[Rgb]) -> Solution {
    let mut sum = solutions[0].clone();
    let each = || solutions.iter().zip(strengths);
    let total =
        |light: &dyn Fn(&Solution) -> Rgb| each().map(|(s, &strength)| strength * light(s)).sum();
    let patches = 0..sum.mesh.patches.len();
    sum.optics.exitance = patches.map(|patch| total(&|s| s.optics.exitance[patch])).collect();
    for vertex in sum.mesh.vertex_ids() {
        let direct = |s: &Solution| s.vertex_light.direct(vertex).unwrap_or_default();
        let direct = Direct {
            irradiance: total(&|s| direct(s).irradiance),
            unoccluded: total(&|s| direct(s).unoccluded),
        };
        sum.vertex_light.set_direct(vertex, direct);
        let indirect = |s: &Solution| s.vertex_light.indirect(vertex).unwrap_or_default();
        sum.vertex_light.set_indirect(vertex, total(&indirect));
    }
    let elements = 0..sum.light.direct.len();
    sum.light = ElementLight {
        direct: elements.clone().map(|e| total(&|s| s.light.direct[e])).collect(),
        indirect: elements.map(|e| total(&|s| s.light.indirect[e])).collect(),
    };
    sum.energy = PowerBalance {
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
