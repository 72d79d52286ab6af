//! Light on a mesh: direct light exactly, reflected light by progressive refinement, and a last gathering.
//!
//! Three scales of light, three passes. Light straight from emitters carries the hard edges and
//! refines the mesh. Reflected light is exchanged between patches, coarsely. What arrives of it at
//! the vertices is then gathered, and refines the mesh where it varies.

mod power_balance;
mod stop;
mod work;

pub mod relaxation;

mod solution;

mod checkpoint;
mod observer;

mod clusters;
mod gather_points;

mod context;
mod element_emitters;
mod interpolate;
mod lit_mesh;
mod sources;
mod start;

mod arrival;
mod spread;
mod unfinished;

mod direct_light;

mod direct_pass;

mod links;
mod parts;
mod transport;

mod glare;
mod progressive;

mod gather;
mod indirect_pass;

mod interreflection;

mod by_light;
mod snapshots;

mod illuminance;
mod work_plane;

use std::ops::ControlFlow;

use crate::error::Result;
use crate::light::Optics;
use crate::mesh::Mesh;
use crate::settings::Settings;
use crate::surface::Surfaces;

pub use by_light::{ScaledLight, solve_by_light};
pub use checkpoint::Checkpoint;
pub use illuminance::{Reading, read};
pub use power_balance::PowerBalance;
pub use solution::{Phase, Progress, Solution};
pub(crate) use sources::mean_radiosity_shown;
pub use stop::{Cancellation, Stop};
pub use work::Work;
pub use work_plane::{Evenness, WorkPlane};

use clusters::Clusters;
use context::Context;
use interreflection::Interreflection;
use lit_mesh::VertexLighting;
use observer::Observer;
use start::{check_reflectances, emitters_on};

/// Lights `surfaces`, telling `observe` about each step; when that breaks off, what is there is
/// finished quickly.
///
/// # Errors
/// When nothing emits light, a setting is out of its range, a surface reflects all of the light or
/// more, or over-relaxation makes the light grow instead of settling it.
pub fn solve(
    surfaces: &Surfaces,
    settings: &Settings,
    observe: impl FnMut(&Progress) -> ControlFlow<Cancellation>,
) -> Result<Solution> {
    solve_with(surfaces, settings, Plan::default(), observe).map(|(solution, _)| solution)
}

/// What a solution is to leave besides itself.
#[derive(Debug, Default)]
pub struct Plan<'a> {
    /// Numbers of shots of reflected light after which it is wanted, too; 0 is what comes straight from
    /// emitters.
    pub snapshots: &'a [usize],
    /// Where work is kept as it is done, and taken up again.
    pub checkpoint: Option<&'a mut Checkpoint>,
}

/// The same by a plan; and what the light was at the snapshots, with the light still unshot estimated as ambient.
///
/// All snapshots have the mesh that direct light has refined. Those that the exchange did not go beyond
/// are left out; [`Solution::reflected_shots`] tells them apart.
///
/// # Errors
/// As [`solve`].
pub fn solve_with(
    surfaces: &Surfaces,
    settings: &Settings,
    plan: Plan<'_>,
    mut observe: impl FnMut(&Progress) -> ControlFlow<Cancellation>,
) -> Result<(Solution, Vec<Solution>)> {
    surfaces.check()?;
    settings.validate()?;
    settings.validate_for(surfaces.divided_area(), surfaces.extent)?;
    let mut nowhere = Checkpoint::default();
    let Plan { snapshots, checkpoint } = plan;
    let checkpoint = checkpoint.unwrap_or(&mut nowhere);
    let settings = &checkpoint.settings(settings);
    let mut observer = Observer::new(&mut observe, checkpoint);
    let mut mesh = Mesh::new(surfaces, settings);
    let optics = Optics::new(surfaces, &mesh);
    check_reflectances(surfaces, &mesh, &optics)?;
    let emitters = emitters_on(surfaces, settings, &mesh, &mut observer)?;
    let clusters = Clusters::new(surfaces, settings, &mesh);
    let context = Context::new(surfaces, &optics, &emitters, &clusters);

    let mut lighting = VertexLighting { work: emitters.work(), ..VertexLighting::default() };
    let lit = &mut lighting.on(&mut mesh);
    direct_pass::refine(context, settings, lit, &mut observer);
    direct_light::light_leaves(context, lit, &mut observer);
    let snapshots = snapshots::snapshots(context, settings, lit, snapshots, &mut observer)?;
    let mut interreflection =
        Interreflection::new(context, settings, lit.mesh, lit.light, &mut observer)?;
    interreflection.reach_vertices(context, settings, lit, &mut observer);
    Ok((interreflection.solution(mesh, optics, lighting), snapshots))
}
