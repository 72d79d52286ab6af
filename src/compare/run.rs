//! One solution of a comparison: how good it is, and what it cost.

use std::ops::ControlFlow;
use std::time::Instant;

use serde::Serialize;

use super::memory::Peak;
use super::reference::Reference;
use super::score::{Score, score};
use crate::error::Result;
use crate::mesh::{Divided, ElementId, SizeBin};
use crate::reconstruct::{Angles, TriMesh, reconstruct};
use crate::settings::Settings;
use crate::solver::{Cancellation, Phase, Progress, Solution, Stop, Work, solve};
use crate::surface::Surfaces;

/// How a mesh is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Family {
    /// Every element at most so long.
    Uniform,
    /// Where the light asks for it.
    Adaptive,
}

impl Family {
    /// Both, uniform first.
    pub const ALL: [Self; 2] = [Self::Uniform, Self::Adaptive];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Adaptive => "adaptive",
        }
    }
}

/// A family, and what it is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Division {
    /// How the mesh is divided.
    pub family: Family,
    /// The size of elements, m, or the tolerance.
    pub knob: f64,
}

/// What every run begins with.
#[derive(Clone, Copy, Debug)]
pub struct TimedSurfaces<'a> {
    /// The scene's surfaces.
    pub surfaces: &'a Surfaces,
    /// What they took, s.
    pub seconds: f64,
}

/// Time by phase, s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// From the scene to surfaces and contact lines; done once, and counted for every run.
    pub surfaces: f64,
    /// Patches, occluders, lamps; direct light, and the mesh refined by it.
    pub direct: f64,
    /// Exchange of reflected light.
    pub reflected: f64,
    /// Reflected light at the vertices, and the mesh refined by it.
    pub gathering: f64,
    /// From the solution to triangles.
    pub triangles: f64,
}

impl Seconds {
    /// All together.
    pub fn total(&self) -> f64 {
        self.surfaces + self.direct + self.reflected + self.gathering + self.triangles
    }
}

/// A solution and its triangles.
#[derive(Clone, Debug)]
pub struct Lit {
    /// The solution.
    pub solution: Solution,
    /// Its triangles.
    pub mesh: TriMesh,
}

/// A solution, measured.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// How its mesh was divided.
    pub family: Family,
    /// The size of elements, m, or the tolerance.
    pub knob: f64,
    /// All settings.
    #[serde(skip)]
    pub settings: Settings,
    /// True if the solver came to its end.
    pub converged: bool,
    /// Leaves on surfaces that reflect; on others no light shows, and only uniform meshes divide them.
    pub elements: usize,
    /// All leaves.
    pub leaves: usize,
    /// Triangles.
    pub triangles: usize,
    /// Vertices of the triangles.
    pub vertices: usize,
    /// Coarse pieces of surfaces.
    pub patches: usize,
    /// Patches that have shot.
    pub shots: usize,
    /// Hemicubes looked through: over patches, and over vertices.
    pub hemicubes: [usize; 2],
    /// Evaluations of form factors, and shadow rays.
    pub work: Work,
    /// Time by phase.
    pub seconds: Seconds,
    /// Most memory beyond what was in use before, bytes; `None` where the system does not tell.
    pub peak_memory: Option<u64>,
    /// What is missing of the emitted power, as a share of it.
    pub imbalance: f64,
    /// Errors.
    pub score: Score,
    /// Leaves by level, from 0.
    pub levels: Vec<usize>,
    /// Leaves by size.
    pub sizes: Vec<SizeBin>,
    /// Elements divided, by reason.
    pub divided: Divided,
    /// Smallest angles of the triangles.
    pub angles: Angles,
    /// Places inside edges of neighbouring leaves, all resolved.
    pub hanging: usize,
    /// What it looks like; only runs to be shown keep it where memory is short.
    #[serde(skip)]
    pub lit: Option<Lit>,
}

impl Run {
    /// Solves and measures. Nothing of it, if `observe` has broken off by then.
    ///
    /// # Errors
    /// Those of [`solve`].
    pub fn new(
        TimedSurfaces { surfaces, seconds }: TimedSurfaces<'_>,
        Division { family, knob }: Division,
        settings: &Settings,
        reference: &Reference,
        observe: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
    ) -> Result<Option<Self>> {
        let peak = Peak::start();
        let mut clock = Clock::new(seconds);
        let solution = solve(surfaces, settings, |progress| {
            clock.enter(progress.phase);
            observe(progress).map_break(|()| Cancellation::Caller)
        })?;
        if solution.stop.is_cancelled() {
            return Ok(None);
        }
        clock.leave();
        let mesh = reconstruct(surfaces, &solution);
        let seconds = clock.seconds();
        let peak_memory = peak.bytes();
        let score = score(reference, &mesh, surfaces.extent);
        let leaves = &solution.mesh;
        let reflects = |leaf: ElementId| surfaces[leaves.surface_of(leaf)].reflects();
        Ok(Some(Self {
            family,
            knob,
            settings: settings.clone(),
            converged: solution.stop == Stop::Converged,
            elements: leaves.leaves().filter(|&leaf| reflects(leaf)).count(),
            leaves: leaves.leaves().count(),
            triangles: mesh.triangles.len(),
            vertices: mesh.positions.len(),
            patches: leaves.patches.len(),
            shots: solution.shots,
            hemicubes: solution.hemicubes,
            work: solution.work,
            seconds,
            peak_memory,
            imbalance: solution.energy.imbalance(),
            score,
            levels: leaves.leaves_by_level(),
            sizes: leaves.leaves_by_size(),
            divided: leaves.divided(),
            angles: mesh.angles(),
            hanging: mesh.hanging,
            lit: Some(Lit { solution, mesh }),
        }))
    }
}

/// Tells how long each phase takes.
struct Clock {
    seconds: Seconds,
    phase: Option<Phase>,
    since: Instant,
}

impl Clock {
    fn new(surfaces: f64) -> Self {
        let seconds = Seconds { surfaces, ..Seconds::default() };
        Self { seconds, phase: Some(Phase::Direct), since: Instant::now() }
    }

    fn enter(&mut self, phase: Phase) {
        if self.phase != Some(phase) {
            self.switch(Some(phase));
        }
    }

    /// All phases of the solver are over.
    fn leave(&mut self) {
        self.switch(None);
    }

    fn switch(&mut self, next: Option<Phase>) {
        let now = Instant::now();
        *match self.phase {
            Some(Phase::Emitters | Phase::Direct | Phase::Lines) => &mut self.seconds.direct,
            Some(Phase::Shooting) => &mut self.seconds.reflected,
            Some(Phase::Gathering) => &mut self.seconds.gathering,
            None => &mut self.seconds.triangles,
        } += (now - self.since).as_secs_f64();
        (self.phase, self.since) = (next, now);
    }

    fn seconds(mut self) -> Seconds {
        self.switch(None);
        self.seconds
    }
}
