//! Light on a mesh: direct light exactly, reflected light by progressive refinement, and a last gathering.
//!
//! Three scales of light, three passes. Light straight from emitters carries the hard edges and
//! refines the mesh. Reflected light is exchanged between patches, coarsely. What arrives of it at the vertices is then gathered,
//! and refines the mesh where it varies.

mod direct_pass;
mod element_light;
mod energy;
mod gather;
mod indirect_pass;
mod progressive;
mod transport;

use std::ops::ControlFlow;

use crate::colour::Rgb;
use crate::direct::Lamps;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::refine::Oracle;
use crate::settings::Settings;
use crate::surface::Surfaces;
use crate::visibility::Occluders;

pub use element_light::ElementLight;
pub use energy::Energy;

use direct_pass::World;
use gather::Gatherer;
use progressive::Shooting;

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
    /// Irradiance added for the light still unshot, W/m²; zero when converged.
    pub ambient: Rgb,
}

/// Why a solver stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The unshot power fell below [`Settings::stop`].
    Converged,
    /// [`Settings::max_shots`] were fired.
    ShotLimit,
    /// The observer asked for it.
    Cancelled,
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

/// Tells a caller how far things are, and is told whether to go on.
struct Observer<'a>(&'a mut dyn FnMut(&Progress) -> ControlFlow<()>);

impl Observer<'_> {
    fn tell(&mut self, phase: Phase, done: f64) -> ControlFlow<()> {
        // A phase without steps has no share of them done.
        let done = if done.is_finite() { done.clamp(0.0, 1.0) } else { 0.0 };
        (self.0)(&Progress { phase, done })
    }
}

/// Gathering takes elements in parts where these may change the result by this share of the tolerated error.
const GATHER_SHARE: f64 = 0.1;

/// Lights `surfaces`, telling `observe` about each step; when that breaks off, what is there is finished quickly.
///
/// # Errors
/// When nothing emits light, or a setting is out of its range.
pub fn solve(
    surfaces: &Surfaces,
    settings: &Settings,
    mut observe: impl FnMut(&Progress) -> ControlFlow<()>,
) -> Result<Solution> {
    settings.validate()?;
    settings.validate_for(surfaces.area(), surfaces.extent)?;
    let mut observer = Observer(&mut observe);
    let mut mesh = Mesh::new(surfaces, settings);
    let occluders = Occluders::new(surfaces);
    let lamps = Lamps::new(surfaces, &mesh);
    if lamps.is_empty() {
        return Err(Error::Scene("nothing in the scene emits light".to_owned()));
    }
    let world = World { surfaces, occluders: &occluders, lamps: &lamps };

    let refined = if settings.uniform.is_some() {
        direct_pass::light(world, &mut mesh);
        observer.tell(Phase::Direct, 1.0)
    } else {
        direct_pass::refine(world, settings, &mut mesh, &mut observer)
    };
    let mut light = ElementLight::direct(&mesh);
    let mut shooting = Shooting::new(&mesh, world, settings, &light);
    let stop = match refined {
        ControlFlow::Continue(()) => shooting.run(settings, &mut observer),
        ControlFlow::Break(()) => Stop::Cancelled,
    };
    let received = std::mem::take(&mut shooting.received);
    let Shooting { energy, shots, hemicubes, .. } = shooting;
    let ambient = if stop == Stop::Converged { Rgb::ZERO } else { shooting.ambient() };
    light.settle(&mesh, &received);

    let mut solution =
        Solution { mesh, light, energy, stop, shots, hemicubes: [hemicubes, 0], ambient };
    if stop == Stop::Converged {
        gather(world, settings, &mut solution, &mut observer);
        indirect_pass::interpolate(&mut solution.mesh);
    } else {
        indirect_pass::average(&mut solution.mesh, &solution.light, ambient);
    }
    Ok(solution)
}

/// The last gathering.
fn gather(
    world: World<'_>,
    settings: &Settings,
    solution: &mut Solution,
    observer: &mut Observer<'_>,
) {
    let mesh = &mut solution.mesh;
    let level = direct_pass::mean_radiosity(mesh);
    let fine = GATHER_SHARE * settings.tolerance * level;
    let gatherer = Gatherer::new(world, &solution.light, fine);
    if settings.uniform.is_some() {
        // One step, which there is no breaking off.
        let _ = observer.tell(Phase::Gathering, 0.0);
        solution.hemicubes[1] = indirect_pass::everywhere(&gatherer, mesh);
        return;
    }
    let oracle = Oracle::new(settings, world.surfaces.extent, level);
    let (gathered, flow) =
        indirect_pass::refine(world, settings, (&gatherer, &oracle), mesh, observer);
    solution.hemicubes[1] = gathered;
    if flow.is_break() {
        solution.stop = Stop::Cancelled;
    }
}
