//! Light on a mesh: direct light exactly, reflected light by progressive refinement, and a last gathering.
//!
//! Three scales of light, three passes. Light straight from emitters carries the hard edges and
//! refines the mesh. Reflected light is exchanged between patches, coarsely. What arrives of it at
//! the vertices is then gathered, and refines the mesh where it varies.

mod direct_pass;
mod element_light;
mod energy;
mod gather;
mod groups;
mod indirect_pass;
mod lookout;
mod parts;
mod probe;
mod progressive;
pub mod relaxation;
mod sources;
mod stages;
mod transport;
mod work;
mod work_plane;

use std::ops::ControlFlow;

use crate::colour::Rgb;
use crate::direct::{Lamps, PatchLight};
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::refine::{Oracle, mean_radiosity};
use crate::settings::Settings;
use crate::surface::Surfaces;
use crate::visibility::Occluders;

pub use element_light::ElementLight;
pub use energy::Energy;
pub use probe::{Reading, read};
pub use work::Work;
pub use work_plane::{Evenness, WorkPlane};

use direct_pass::World;
use gather::Gatherer;
use groups::Groups;
use progressive::Shooting;
use relaxation::Step;
use sources::Sources;

/// A lit mesh, and how it came to be.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The mesh, with light at its vertices.
    pub mesh: Mesh,
    /// Light on the elements that there were when reflected light was exchanged, constant over each.
    pub light: ElementLight,
    /// Where the emitted power has gone.
    pub energy: Energy,
    /// Why the solver stopped.
    pub stop: Stop,
    /// Patches that have shot, emitters included and each time counted.
    pub shots: usize,
    /// Hemicubes looked through: over patches, and over vertices.
    pub hemicubes: [usize; 2],
    /// What was evaluated.
    pub work: Work,
    /// Irradiance added for the light still unshot, W/m²; zero when converged.
    pub ambient: Rgb,
    /// How the exchange of reflected light converged, patch by patch.
    pub history: Vec<Step>,
}

impl Solution {
    /// Shots of reflected light, those of emitters not counted.
    pub fn reflected_shots(&self) -> usize {
        self.history.last().map_or(0, |step| step.shots)
    }
}

/// Why a solver stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The unshot power fell below [`Settings::stop`]; of a [`relaxation::System`], its residual
    /// below what was asked for.
    Converged,
    /// A whole sweep over a [`relaxation::System`] has changed no radiosity by as much as was
    /// asked for.
    Unchanged,
    /// [`Settings::max_shots`] were fired, or as many rows of a system relaxed.
    ShotLimit,
    /// The observer asked for it.
    Cancelled,
    /// What is unshot grew a millionfold, or has not come to a new low in a hundred sweeps.
    Diverged,
}

/// A step of the work, told to the observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub phase: Phase,
    /// How much of the phase is done, 0..=1.
    pub done: f64,
}

/// The passes of a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Phase {
    /// Direct light, refining the mesh.
    Direct,
    /// Exchange of reflected light.
    Shooting,
    /// Indirect light at vertices.
    Gathering,
}

/// Tells a caller how far things are, and remembers if it has had enough.
struct Observer<'a> {
    observe: &'a mut dyn FnMut(&Progress) -> ControlFlow<()>,
    flow: ControlFlow<()>,
}

impl Observer<'_> {
    fn tell(&mut self, phase: Phase, done: f64) -> ControlFlow<()> {
        if self.flow.is_continue() {
            self.flow = (self.observe)(&Progress { phase, done: done.clamp(0.0, 1.0) });
        }
        self.flow
    }
}

/// What is said of a scene without light.
const DARK: &str = "nothing in the scene emits light; give a material an emission \
                    (Ke in an MTL file, emissiveFactor in glTF) or add a light";

/// Gathering resolves differences down to this share of the tolerated error.
const GATHER_SHARE: f64 = 0.13;

/// How often light is gathered: from what the exchange left on the elements, then from what the first
/// gathering found at their vertices. A third changed no result.
const ROUNDS: usize = 2;

/// Lights `surfaces`, telling `observe` about each step; when that breaks off, what is there is
/// finished quickly.
///
/// # Errors
/// When nothing emits light, a setting is out of its range, a surface reflects all of the light or
/// more, or over-relaxation makes the light grow instead of settling it.
pub fn solve(
    surfaces: &Surfaces,
    settings: &Settings,
    observe: impl FnMut(&Progress) -> ControlFlow<()>,
) -> Result<Solution> {
    solve_in_stages(surfaces, settings, &[], observe).map(|(solution, _)| solution)
}

/// The same, and what the light was after each of these numbers of `shots` of reflected light, 0
/// being what comes straight from emitters, with the light still unshot estimated as ambient.
///
/// All stages have the mesh that direct light has refined. Those that the exchange did not go beyond
/// are left out; [`Solution::reflected_shots`] tells them apart.
///
/// # Errors
/// As [`solve`].
pub fn solve_in_stages(
    surfaces: &Surfaces,
    settings: &Settings,
    shots: &[usize],
    mut observe: impl FnMut(&Progress) -> ControlFlow<()>,
) -> Result<(Solution, Vec<Solution>)> {
    settings.validate()?;
    settings.validate_for(surfaces.divided_area(), surfaces.extent)?;
    let mut observer = Observer { observe: &mut observe, flow: ControlFlow::Continue(()) };
    let mut mesh = Mesh::new(surfaces, settings);
    check_reflectances(surfaces, &mesh)?;
    let lamps = Lamps::new(surfaces, &mesh).seen_by(settings.shadow_rays);
    if lamps.is_empty() {
        return Err(Error::Scene(DARK.to_owned()));
    }
    let light = PatchLight::new(lamps, Occluders::new(surfaces), &mesh);
    let groups = Groups::new(surfaces, settings, &mesh);
    let world = World { surfaces, occluders: light.occluders(), light: &light, groups: &groups };

    direct_pass::refine(world, settings, &mut mesh, &mut observer);
    direct_pass::light_leaves(world, settings, &mut mesh);
    let stages = stages::stages(world, settings, (&mesh, shots), &mut observer)?;
    let mut exchange = Exchange::new(world, settings, &mesh, &mut observer)?;
    let (gathered, gathering) = if exchange.stop == Stop::Converged {
        gather(world, settings, (&mut mesh, &mut exchange), &mut observer)
    } else {
        exchange.spread(&mut mesh);
        (0, 0)
    };
    let work = Work { gathering, ..Work::new(world.light.lamps(), exchange.factors) };
    Ok((exchange.solution(mesh, gathered, work), stages))
}

/// Whether light dies away: loading a file sees to it, a scene made in code may not.
fn check_reflectances(surfaces: &Surfaces, mesh: &Mesh) -> Result<()> {
    mesh.patches.iter().try_for_each(|patch| {
        let material = surfaces.list[patch.surface as usize].material as usize;
        let name = format_args!("material \"{}\"", surfaces.materials[material].name);
        relaxation::check_reflectance(patch.reflectance, name)
    })
}

/// Indirect light at vertices, the mesh refined to it. Returns how often light was gathered, and how many
/// factors that took.
fn gather(
    world: World<'_>,
    settings: &Settings,
    (mesh, exchange): (&mut Mesh, &mut Exchange),
    observer: &mut Observer<'_>,
) -> (usize, u64) {
    let fine = GATHER_SHARE * settings.tolerance * mean_radiosity(mesh);
    let oracle = Oracle::of_reflected_light(settings, world.surfaces.extent, mesh);
    let scene = (world.surfaces, world.occluders, world.groups);
    let mut gatherer = Gatherer::new(scene, settings, exchange.sources(mesh), fine);
    for round in 1..=ROUNDS {
        indirect_pass::refine((settings, &oracle), &mut gatherer, mesh, observer);
        direct_pass::light_leaves(world, settings, mesh);
        if round < ROUNDS && observer.flow.is_continue() {
            indirect_pass::interpolate(mesh);
            gatherer.replace_sources(mesh, Sources::of_vertices(mesh));
        }
    }
    if observer.flow.is_break() {
        exchange.stop = Stop::Cancelled;
    }
    indirect_pass::interpolate(mesh);
    (gatherer.gathered, gatherer.factors)
}

/// Reflected light, exchanged between the patches of a mesh as it is.
struct Exchange {
    light: ElementLight,
    energy: Energy,
    stop: Stop,
    shots: usize,
    hemicubes: usize,
    factors: u64,
    ambient: Rgb,
    history: Vec<Step>,
}

impl Exchange {
    fn new(
        world: World<'_>,
        settings: &Settings,
        mesh: &Mesh,
        observer: &mut Observer<'_>,
    ) -> Result<Self> {
        let mut light = ElementLight::direct(mesh);
        let mut shooting = Shooting::new(mesh, world, settings, &light);
        let (stop, history) = shooting.run(settings, observer)?;
        light.settle(mesh, &shooting.received);
        let ambient = if stop == Stop::Converged {
            light.scale_to_the_rest(mesh, shooting.ambient());
            Rgb::ZERO
        } else {
            shooting.ambient()
        };
        let Shooting { energy, shots, hemicubes, factors, .. } = shooting;
        Ok(Self { light, energy, stop, shots, hemicubes, factors, ambient, history })
    }

    /// The solution that this comes to, its light on the vertices of `mesh` by so many hemicubes.
    fn solution(self, mesh: Mesh, gathered: usize, work: Work) -> Solution {
        let Self { light, energy, stop, shots, hemicubes, ambient, history, .. } = self;
        let hemicubes = [hemicubes, gathered];
        Solution { mesh, light, energy, stop, shots, hemicubes, work, ambient, history }
    }

    /// What a gathering vertex sees.
    fn sources(&self, mesh: &Mesh) -> Sources {
        let mut irradiance = self.light.indirect_at_vertices(mesh);
        for (sum, vertex) in irradiance.iter_mut().zip(&mesh.vertices) {
            *sum += vertex.direct.unwrap_or_default().irradiance;
        }
        Sources::new(mesh, &self.light, irradiance)
    }

    /// Gives all vertices the mean of the elements around them, and the ambient light.
    fn spread(&self, mesh: &mut Mesh) {
        let indirect = self.light.indirect_at_vertices(mesh);
        for (vertex, indirect) in mesh.vertices.iter_mut().zip(indirect) {
            vertex.indirect = Some(indirect + self.ambient);
        }
    }
}
