//! The work of `radiosity solve` itself: with its checkpoint, and with lights kept apart if they are to be.

use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;
use radiosity::reconstruct::reconstruct_by_light;
use radiosity::solver::{Cancellation, Checkpoint, Progress};
use radiosity::surface::LightGroup;
use radiosity::{
    Error, Plan, Result, ScaledLight, Settings, Solution, Surfaces, TriMesh, reconstruct,
    solve_by_light, solve_with,
};
use serde::Serialize;

use super::interrupt::Interrupt;
use super::meter::Meter;
use super::options::CheckpointOptions;

/// Most lights that are kept apart: each takes a solution of its own.
const MOST_LIGHTS: usize = 32;

/// Whether lights can be dimmed afterwards.
#[derive(Debug, Args)]
pub(crate) struct RelightOptions {
    /// Keep lights apart, by the names of materials and lights, so that `radiosity relight` can dim and colour them
    ///
    /// Each is solved for by itself, on a mesh fine enough for all. `--relightable='desk*,spot*'` keeps those that
    /// match a pattern together; all others go by their names.
    #[arg(long, value_name = "PATTERN,...", num_args = 0..=1, require_equals = true, value_delimiter = ',')]
    #[arg(help_heading = "Writing", conflicts_with_all = ["history", "snapshots"])]
    relightable: Option<Vec<String>>,
}

impl RelightOptions {
    /// Whether something is written that keeps lights apart.
    pub(crate) fn check(&self, outputs: &[PathBuf]) -> Result<()> {
        let keeps =
            |path: &PathBuf| path.extension().is_some_and(|end| end.eq_ignore_ascii_case("glb"));
        if self.relightable.is_none() || outputs.iter().any(keeps) {
            return Ok(());
        }
        let message = "only a GLB keeps lights apart; write one, as in -o FILE.glb".to_owned();
        Err(Error::Setting { name: "relightable", message })
    }
}

/// What is to be lit, and how.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lighting<'a> {
    pub(crate) surfaces: &'a Surfaces,
    pub(crate) settings: &'a Settings,
    pub(crate) checkpoint: &'a CheckpointOptions,
    pub(crate) relight: &'a RelightOptions,
    pub(crate) snapshots: &'a [usize],
}

/// What came of it.
#[derive(Debug)]
pub(crate) struct LitScene {
    pub(crate) solution: Solution,
    pub(crate) snapshots: Vec<Solution>,
    pub(crate) mesh: TriMesh,
}

impl Lighting<'_> {
    pub(crate) fn run(self, interrupt: &Interrupt, meter: &mut Meter) -> Result<LitScene> {
        match &self.relight.relightable {
            None => self.together(interrupt, meter),
            Some(patterns) => self.apart(patterns, interrupt, meter),
        }
    }

    fn together(self, interrupt: &Interrupt, meter: &mut Meter) -> Result<LitScene> {
        let Self { surfaces, settings, snapshots, .. } = self;
        let (solution, snapshots) =
            self.kept(surfaces, interrupt, meter, |checkpoint, observe| {
                let plan = Plan { snapshots, checkpoint: Some(checkpoint) };
                solve_with(surfaces, settings, plan, observe)
            })?;
        meter.begin("triangles");
        let mesh = reconstruct(surfaces, &solution);
        Ok(LitScene { solution, snapshots, mesh })
    }

    fn apart(
        self,
        patterns: &[String],
        interrupt: &Interrupt,
        meter: &mut Meter,
    ) -> Result<LitScene> {
        let Self { surfaces, settings, .. } = self;
        let groups = surfaces.light_groups(patterns);
        check_count(groups.len())?;
        let scene = |group: &LightGroup| ScaledLight {
            surfaces: surfaces.lit_by(group, patterns),
            strength: group.strength,
        };
        let scenes: Vec<ScaledLight> = groups.iter().map(scene).collect();
        let (solution, parts) = self.kept(&scenes, interrupt, meter, |checkpoint, observe| {
            solve_by_light(&scenes, settings, checkpoint, observe)
        })?;
        meter.begin("triangles");
        let parts = groups.into_iter().zip(scenes).zip(parts);
        let parts = parts.map(|((group, scaled), part)| (group, scaled.surfaces, part));
        let mesh = reconstruct_by_light(surfaces, &solution, parts);
        Ok(LitScene { solution, snapshots: Vec::new(), mesh })
    }

    /// Does `work` on a `subject` with its checkpoint.
    fn kept<R>(
        self,
        subject: &impl Serialize,
        interrupt: &Interrupt,
        meter: &mut Meter,
        work: impl FnOnce(
            &mut Checkpoint,
            &mut dyn FnMut(&Progress) -> ControlFlow<Cancellation>,
        ) -> Result<R>,
    ) -> Result<R> {
        let (mut checkpoint, goes_on) = self.checkpoint.open(subject, self.settings)?;
        if goes_on {
            meter.tell("going on from the checkpoint");
        }
        let done = work(&mut checkpoint, &mut |progress| {
            interrupt.worth_writing();
            meter.follow(progress);
            interrupt.flow()
        });
        if done.is_err() && !goes_on {
            self.checkpoint.remove();
        }
        if let Some(failure) = checkpoint.failure() {
            meter.tell(&format!("note: the checkpoint is of no use any more: {failure}"));
        }
        done
    }
}

fn check_count(count: usize) -> Result<()> {
    let message = match count {
        0 => "nothing in the scene emits light".to_owned(),
        1..=MOST_LIGHTS => return Ok(()),
        _ => format!(
            "{count} lights are more than the {MOST_LIGHTS} that can be kept apart; keep some together, as in --relightable='lamp*'"
        ),
    };
    Err(Error::Setting { name: "relightable", message })
}
