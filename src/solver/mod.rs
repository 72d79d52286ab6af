//! Light on a mesh: direct light exactly, reflected light by progressive refinement, and a last gathering.
//!
//! Three scales of light, three passes. Light straight from emitters carries the hard edges and
//! refines the mesh. Reflected light is exchanged between patches, coarsely. What arrives of it at
//! the vertices is then gathered, and refines the mesh where it varies.

mod arrival;
mod by_light;
mod checkpoint;
mod direct_pass;
mod element_light;
mod energy;
mod gather;
mod glare;
mod groups;
mod indirect_pass;
mod interpolate;
mod lookout;
mod observer;
mod outlooks;
mod parts;
mod probe;
mod progressive;
pub mod relaxation;
mod sources;
mod stages;
mod transport;
mod unfinished;
mod work;
mod work_plane;

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};

use crate::colour::Rgb;
use crate::direct::{Lamps, PatchLight};
use crate::error::{Error, Result};
use crate::mesh::{ElementId, Mesh};
use crate::refine::{Oracle, tolerated_direct};
use crate::settings::Settings;
use crate::surface::Surfaces;
use crate::visibility::Occluders;

pub use by_light::solve_by_light;
pub use checkpoint::Checkpoint;
pub use element_light::ElementLight;
pub use energy::Energy;
pub use probe::{Reading, read};
pub(crate) use sources::level;
pub use work::Work;
pub use work_plane::{Evenness, WorkPlane};

use direct_pass::World;
use gather::Gatherer;
use groups::Groups;
use interpolate::{REFLECTED, interpolate};
use observer::Observer;
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
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
    /// What each patch sees of the lamps.
    Lamps,
    /// Direct light, refining the mesh.
    Direct,
    /// Lines on which direct light has a kink or a bend.
    Lines,
    /// Exchange of reflected light.
    Shooting,
    /// Indirect light at vertices.
    Gathering,
}

/// What is said of a scene without light.
const DARK: &str = "nothing in the scene emits light; give a material an emission \
                    (Ke in an MTL file, emissiveFactor in glTF) or add a light";

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
    solve_with(surfaces, settings, Plan::default(), observe).map(|(solution, _)| solution)
}

/// What a solution is to leave besides itself.
#[derive(Debug, Default)]
pub struct Plan<'a> {
    /// Numbers of shots of reflected light after which it is wanted, too; 0 is what comes straight from
    /// emitters.
    pub stages: &'a [usize],
    /// Where work is kept as it is done, and taken up again.
    pub checkpoint: Option<&'a mut Checkpoint>,
}

/// The same by a plan; and what the light was at the stages, with the light still unshot estimated as ambient.
///
/// All stages have the mesh that direct light has refined. Those that the exchange did not go beyond
/// are left out; [`Solution::reflected_shots`] tells them apart.
///
/// # Errors
/// As [`solve`].
pub fn solve_with(
    surfaces: &Surfaces,
    settings: &Settings,
    plan: Plan<'_>,
    mut observe: impl FnMut(&Progress) -> ControlFlow<()>,
) -> Result<(Solution, Vec<Solution>)> {
    surfaces.check()?;
    settings.validate()?;
    settings.validate_for(surfaces.divided_area(), surfaces.extent)?;
    let mut nowhere = Checkpoint::default();
    let Plan { stages, checkpoint } = plan;
    let checkpoint = checkpoint.unwrap_or(&mut nowhere);
    let settings = &checkpoint.settings(settings);
    let mut observer = Observer::new(&mut observe, checkpoint);
    let mut mesh = Mesh::new(surfaces, settings);
    check_reflectances(surfaces, &mesh)?;
    let light = lamps_on(surfaces, settings, &mesh, &mut observer)?;
    let groups = Groups::new(surfaces, settings, &mesh);
    let world = World::new(surfaces, &light, &groups);

    direct_pass::refine(world, settings, &mut mesh, &mut observer);
    direct_pass::light_leaves(world, &mut mesh, &mut observer);
    let stages = stages::stages(world, settings, (&mesh, stages), &mut observer)?;
    let mut exchange = Exchange::new(world, settings, &mesh, &mut observer)?;
    let (gathered, work) = reflect(world, settings, (&mut mesh, &mut exchange), &mut observer);
    Ok((exchange.solution(mesh, gathered, work), stages))
}

/// Light of points is evaluated on discs with so many of the shortest sides of elements as their radius: what these can
/// follow.
const BLUR: f64 = 4.0;

/// All light straight from emitters on the patches of a mesh; there must be some.
fn lamps_on(
    surfaces: &Surfaces,
    settings: &Settings,
    mesh: &Mesh,
    observer: &mut Observer<'_>,
) -> Result<PatchLight> {
    // What is left of lamps once there has been enough is told to the end.
    let _ = observer.begin(Phase::Lamps, 0.0..1.0);
    let blur = BLUR * settings.min_element.metres(surfaces.extent);
    let lamps = Lamps::new(surfaces, mesh).seen_by(settings.shadow_rays).blurred(blur);
    if lamps.is_empty() {
        return Err(Error::Scene(DARK.to_owned()));
    }
    let tolerated = tolerated_direct(settings, surfaces.extent, mesh);
    let occluders = Occluders::new(surfaces);
    let observe = |done| observer.tell(Phase::Lamps, done);
    Ok(PatchLight::observed(lamps, occluders, mesh, observe).tolerating(mesh, tolerated))
}

/// Whether light dies away: loading a file sees to it, a scene made in code may not.
fn check_reflectances(surfaces: &Surfaces, mesh: &Mesh) -> Result<()> {
    mesh.patches.iter().try_for_each(|patch| {
        let material = surfaces.list[patch.surface as usize].material as usize;
        let name = format_args!("material \"{}\"", surfaces.materials[material].name);
        relaxation::check_reflectance(patch.reflectance, name)
    })
}

/// Brings reflected light to the vertices: gathered, if all has been exchanged. Returns how often light was
/// gathered, and what all of it took.
fn reflect(
    world: World<'_>,
    settings: &Settings,
    (mesh, exchange): (&mut Mesh, &mut Exchange),
    observer: &mut Observer<'_>,
) -> (usize, Work) {
    let (gathered, gathering) = if exchange.stop == Stop::Converged {
        gather(world, settings, (mesh, exchange), observer)
    } else {
        exchange.spread(mesh);
        (0, 0)
    };
    (gathered, Work { gathering, ..Work::new(world.light.lamps(), exchange.factors) })
}

/// Indirect light at vertices, the mesh refined to it. Returns how often light was gathered, and how many
/// factors that took.
fn gather(
    world: World<'_>,
    settings: &Settings,
    (mesh, exchange): (&mut Mesh, &mut Exchange),
    observer: &mut Observer<'_>,
) -> (usize, u64) {
    let scene = (world.surfaces, world.occluders, world.groups);
    let sources = exchange.sources(mesh);
    let level = sources.level(mesh);
    let oracle = Oracle::of_reflected_light(settings, world.surfaces.extent, level);
    let mut gatherer = Gatherer::new(scene, settings, (mesh, sources, level));
    for round in 1..=ROUNDS {
        indirect_pass::refine((settings, &oracle), &mut gatherer, mesh, observer);
        direct_pass::light_leaves(world, mesh, observer);
        if observer.flow.is_break() {
            break;
        }
        if round < ROUNDS {
            interpolate(mesh, REFLECTED);
            gatherer.replace_sources(mesh, Sources::of_vertices(mesh));
        }
    }
    if observer.flow.is_break() {
        exchange.stop = Stop::Cancelled;
        exchange.give_corners(mesh);
    }
    interpolate(mesh, REFLECTED);
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
        let mut shooting = Shooting::new(mesh, world, settings, (&light, observer));
        let (stop, history) = shooting.run(settings)?;
        light.settle(mesh, &shooting.received);
        let ambient = if stop == Stop::Converged {
            light.scale_to_the_rest(mesh, shooting.ambient());
            Rgb::ZERO
        } else {
            shooting.ambient_of_the_rest()
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

    /// Gives corners of patches that lack reflected light what the patch has of it.
    fn give_corners(&self, mesh: &mut Mesh) {
        for patch in 0..mesh.patches.len() {
            let root = mesh.patches[patch].root;
            for corner in mesh[root].corners.clone() {
                let light = self.light.indirect[root.index()];
                mesh.vertices[corner.index()].indirect.get_or_insert(light);
            }
        }
    }

    /// Gives corners of leaves the mean of the elements around them, and the ambient light; all other vertices
    /// what is between.
    fn spread(&self, mesh: &mut Mesh) {
        let indirect = self.light.indirect_at_vertices(mesh);
        mesh.vertices.iter_mut().for_each(|vertex| vertex.indirect = None);
        let leaves: Vec<ElementId> = mesh.leaves().collect();
        for corner in
            leaves.into_iter().flat_map(|leaf| mesh[leaf].corners.clone()).collect::<Vec<_>>()
        {
            mesh.vertices[corner.index()].indirect = Some(indirect[corner.index()] + self.ambient);
        }
        interpolate(mesh, REFLECTED);
    }
}
