//! Uniform and adaptive meshes of one scene, one after the other.

use std::ops::ControlFlow;
use std::time::Instant;

use serde::Serialize;

use super::held_reference::HeldReference;
use super::path_tracer::PathTracer;
use super::plan::ComparisonPlan;
use super::profile::{ShadowProfile, Trace};
use super::reference::Reference;
use super::run::{Division, Family, Run, TimedSurfaces};
use super::verdict::Verdict;
use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::solver::Phase;
use crate::surface::{Surfaces, surfaces_of};

/// Elements of all solutions that may be kept together; beyond, only those to be shown are.
const KEPT: usize = 1_500_000;

/// Phases of a solution, which are taken to be as long as each other.
const PHASES: f64 = Phase::Gathering as u8 as f64 + 1.0;

/// A step of the work, told to the observer.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparisonProgress {
    /// What is being done, in a word or two.
    pub phase: String,
    /// How much of it is done, 0..=1.
    pub done: f64,
    /// Runs that are done: before there is one, nothing can be told.
    pub runs: usize,
}

/// Uniform and adaptive meshes of one scene, measured.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The scene's surfaces.
    #[serde(skip)]
    pub surfaces: Surfaces,
    /// The truth.
    #[serde(skip)]
    pub reference: Reference,
    /// The runs: uniform from coarse to fine, then adaptive.
    pub runs: Vec<Run>,
    /// Who wins, and by how much.
    pub verdict: Verdict,
    /// The runs to be shown: the uniform one with about as many elements as the finest adaptive one, and that;
    /// `None` if a family has no run.
    pub shown: Option<[usize; 2]>,
    /// Across the edge of a shadow, with what the runs to be shown make of it; `None` without such an edge.
    pub profile: Option<(ShadowProfile, [Trace; 2])>,
    /// True if it was stopped before all was done.
    pub interrupted: bool,
}

/// Compares meshes of a scene; when `observe` breaks off, the run under way is given up, no other begins, and the
/// reference stays as it is by then.
///
/// # Errors
/// Those of [`solve`](crate::solver::solve) and of [`Reference::load`]; when it is stopped before the first run is
/// done.
pub fn compare(
    scene: &Scene,
    plan: &ComparisonPlan,
    observe: &mut dyn FnMut(&ComparisonProgress) -> ControlFlow<()>,
) -> Result<Comparison> {
    let start = Instant::now();
    let surfaces = surfaces_of(scene);
    let seconds = start.elapsed().as_secs_f64();
    surfaces.check()?;
    plan.validate()?;
    plan.validate_for(&surfaces)?;
    let mut observer = Reporter { observe, flow: ControlFlow::Continue(()), runs: 0 };
    let tracer = PathTracer::new(&surfaces);
    let truth = HeldReference::begin(&tracer, &plan.reference, &mut |done| {
        observer.tell("first reference", done)
    })?;
    let scene = TimedSurfaces { surfaces: &surfaces, seconds };
    let mut series = Series { scene, plan, tracer: &tracer, truth, runs: Vec::new() };
    series.run(&mut observer)?;
    if series.runs.is_empty() {
        return Err(Error::Scene("stopped before the first run".to_owned()));
    }
    series.sharpen(&mut observer);
    series.sort();
    let shown = shown(&series.runs);
    let profile = shown.and_then(|shown| series.profile(shown, &mut observer));
    let (runs, reference) = (series.runs, series.truth.into_reference());
    let interrupted = observer.flow.is_break();
    let verdict = Verdict::new(&runs, plan.error);
    Ok(Comparison { verdict, profile, shown, interrupted, surfaces, reference, runs })
}

/// Tells a caller how far things are, and remembers if it has had enough.
struct Reporter<'a> {
    observe: &'a mut dyn FnMut(&ComparisonProgress) -> ControlFlow<()>,
    flow: ControlFlow<()>,
    runs: usize,
}

impl Reporter<'_> {
    fn tell(&mut self, phase: &str, done: f64) -> ControlFlow<()> {
        let told =
            (self.observe)(&ComparisonProgress { phase: phase.to_owned(), done, runs: self.runs });
        if told.is_break() {
            self.flow = told;
        }
        self.flow
    }
}

/// Runs on their way.
struct Series<'a> {
    scene: TimedSurfaces<'a>,
    plan: &'a ComparisonPlan,
    tracer: &'a PathTracer<'a>,
    truth: HeldReference<'a>,
    runs: Vec<Run>,
}

impl Series<'_> {
    /// Adaptive runs first: they tell how fine uniform ones have to be.
    fn run(&mut self, observer: &mut Reporter<'_>) -> Result<()> {
        for &tolerance in &self.plan.adaptive {
            self.add(Division { family: Family::Adaptive, knob: tolerance }, observer)?;
        }
        let counts = || self.runs.iter().map(|run| run.elements);
        let range = [counts().min().unwrap_or(0), counts().max().unwrap_or(0)];
        if observer.flow.is_continue() {
            let mut is_over = || observer.tell("sizes", 0.0).is_break();
            for size in self.plan.sizes(self.scene.surfaces, range, &mut is_over) {
                self.add(Division { family: Family::Uniform, knob: size }, observer)?;
            }
        }
        Ok(())
    }

    fn add(&mut self, division: Division, observer: &mut Reporter<'_>) -> Result<()> {
        let Division { family, knob } = division;
        let (settings, name) = match family {
            Family::Uniform => (self.plan.uniform_settings(knob), format!("uniform {knob:.3} m")),
            Family::Adaptive => (self.plan.adaptive_settings(knob), format!("adaptive {knob}")),
        };
        if observer.tell(&name, 0.0).is_break() {
            return Ok(());
        }
        let reference = self.truth.reference();
        let run = Run::new(self.scene, division, &settings, reference, &mut |progress| {
            let done = (f64::from(progress.phase as u8) + progress.done) / PHASES;
            observer.tell(&name, done)
        })?;
        self.runs.extend(run);
        observer.runs = self.runs.len();
        self.spare_memory();
        Ok(())
    }

    /// Judges all runs anew by a reference that resolves their errors, if there is time for that.
    fn sharpen(&mut self, observer: &mut Reporter<'_>) {
        let scores = self.runs.iter().map(|run| &run.score).collect::<Vec<_>>();
        let better = self.truth.sharpened(&scores, &mut |done| observer.tell("reference", done));
        for (run, score) in self.runs.iter_mut().zip(better) {
            run.score = score;
        }
    }

    /// Uniform runs before adaptive ones, either from coarse to fine.
    fn sort(&mut self) {
        let adaptive = |run: &Run| run.family == Family::Adaptive;
        self.runs.sort_by(|a, b| adaptive(a).cmp(&adaptive(b)).then(b.knob.total_cmp(&a.knob)));
    }

    /// The profile, with what the runs to be shown make of it.
    fn profile(
        &self,
        shown: [usize; 2],
        observer: &mut Reporter<'_>,
    ) -> Option<(ShadowProfile, [Trace; 2])> {
        let paths = self.plan.profile_paths;
        if paths == 0 || observer.flow.is_break() {
            return None;
        }
        let surfaces = self.scene.surfaces;
        let observe = &mut |done| observer.tell("profile", done);
        let profile = ShadowProfile::find(self.tracer, self.truth.reference(), paths, observe)?;
        let trace = |run: usize| Some(profile.trace(surfaces, self.runs[run].lit.as_ref()?));
        let [uniform, adaptive] = shown.map(trace);
        let traces = [uniform?, adaptive?];
        Some((profile, traces))
    }

    /// Forgets solutions that will not be shown, if all are too many.
    fn spare_memory(&mut self) {
        let kept: usize = self.runs.iter().filter(|r| r.lit.is_some()).map(|r| r.elements).sum();
        if kept <= KEPT {
            return;
        }
        let is_adaptive = |run: &&Run| run.family == Family::Adaptive;
        let finest = self.runs.iter().filter(is_adaptive).map(|run| run.knob).reduce(f64::min);
        let shown = shown(&self.runs);
        for (number, run) in self.runs.iter_mut().enumerate() {
            let is_finest = run.family == Family::Adaptive && Some(run.knob) == finest;
            if !is_finest && shown.is_none_or(|shown| !shown.contains(&number)) {
                run.lit = None;
            }
        }
    }
}

/// The uniform run nearest, by ratio of elements, to the finest adaptive one, and that.
fn shown(runs: &[Run]) -> Option<[usize; 2]> {
    let of = |family: Family| (0..runs.len()).filter(move |&k| runs[k].family == family);
    let finest = of(Family::Adaptive).min_by(|&a, &b| runs[a].knob.total_cmp(&runs[b].knob))?;
    let gap = |k: usize| (runs[k].elements as f64 / runs[finest].elements as f64).ln().abs();
    let nearest = of(Family::Uniform).min_by(|&a, &b| gap(a).total_cmp(&gap(b)))?;
    Some([nearest, finest])
}
