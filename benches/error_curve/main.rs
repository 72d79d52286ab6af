//! Error against triangles: what contact lines, discontinuity lines and exact direct light each gain over
//! a quadtree, and each beside uniform meshes of the same solver with the same switches.
//!
//! The truth is exact direct light and a fine solution's reflected light at fixed places, no picture;
//! triangles are those on surfaces that reflect. Numbers after ~ are extrapolated.
//!
//! `cargo bench --bench error_curve`

mod curve;
mod lookup;
mod truth;

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use radiosity::{Settings, Solution, Surfaces, TriMesh, load, reconstruct, solve, surfaces_of};

use curve::{Needed, Sample, needed, ratio};
use truth::{Truth, is_seen};

/// The error that is compared in the end.
const GOAL: f64 = 0.02;

/// Rays to each triangle of a lamp where its light is not exact.
const RAYS: u32 = 16;

const TOLERANCES: [f64; 7] = [1.0, 0.64, 0.32, 0.16, 0.08, 0.04, 0.02];

/// What a mesh is made with.
struct Stage {
    name: &'static str,
    contacts: bool,
    lines: bool,
    exact: bool,
}

impl Stage {
    /// The switches that a uniform mesh heeds.
    fn uniform(&self) -> [bool; 2] {
        [self.contacts, self.exact]
    }
}

const STAGES: [Stage; 6] = [
    Stage { name: "quadtree", contacts: false, lines: false, exact: false },
    Stage { name: "+ contact lines", contacts: true, lines: false, exact: false },
    Stage { name: "+ discontinuity lines", contacts: true, lines: true, exact: false },
    Stage { name: "+ exact direct light", contacts: true, lines: true, exact: true },
    // What the lines gain by themselves, out of the noise.
    Stage {
        name: "exact light, no discontinuity lines",
        contacts: true,
        lines: false,
        exact: true,
    },
    Stage { name: "exact light on a quadtree", contacts: false, lines: false, exact: true },
];

fn main() -> radiosity::Result<()> {
    // Uniform elements are at most the extent over these long.
    contest("scenes/blocker.obj", &[14.0, 28.0, 56.0, 112.0])?;
    contest("scenes/cornell-box.obj", &[14.0, 28.0, 56.0])
}

fn contest(path: &str, divisions: &[f64]) -> radiosity::Result<()> {
    let start = Instant::now();
    let surfaces = surfaces_of(&load(Path::new(path), &Default::default())?);
    let truth = Truth::new(&surfaces)?;
    let [all, shadow] = truth.sizes();
    println!("\n{path}: {all} places, {shadow} in the shadow set");
    let mut summary = Vec::new();
    let mut uniform = Vec::new();
    for (number, stage) in STAGES.iter().enumerate() {
        let adaptive = TOLERANCES.map(|tolerance| Settings { tolerance, ..Settings::medium() });
        let adaptive = curve(&surfaces, &truth, stage, &adaptive)?;
        // Uniform meshes know no discontinuity lines: those of the stage before will do.
        if number == 0 || STAGES[number - 1].uniform() != stage.uniform() {
            let size = |share: &f64| Some(surfaces.extent / share);
            let settings = |share| Settings { uniform: size(share), ..Settings::medium() };
            let settings: Vec<Settings> = divisions.iter().map(settings).collect();
            uniform = curve(&surfaces, &truth, stage, &settings)?;
        }
        table(stage.name, &adaptive, (divisions, &uniform));
        summary.push((stage.name, needed(&adaptive, GOAL), needed(&uniform, GOAL)));
    }
    conclude(&summary);
    println!("{path} took {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// A mesh for each of the settings, from coarse to fine.
fn curve(
    surfaces: &Surfaces,
    truth: &Truth,
    stage: &Stage,
    settings: &[Settings],
) -> radiosity::Result<Vec<Sample>> {
    let mut surfaces = surfaces.clone();
    if !stage.contacts {
        surfaces.list.iter_mut().for_each(|surface| surface.contacts.clear());
    }
    let sample = |settings: &Settings| {
        let settings = Settings {
            discontinuity_lines: stage.lines,
            shadow_rays: (!stage.exact).then_some(RAYS),
            ..settings.clone()
        };
        let (solution, mesh) = lit(&surfaces, &settings)?;
        let is_counted = |&&leaf: &&_| is_seen(&surfaces, solution.mesh.surface_of(leaf));
        let triangles = mesh.leaves.iter().filter(is_counted).count();
        Ok(Sample { triangles, errors: truth.errors(&mesh) })
    };
    settings.iter().map(sample).collect()
}

/// The solution of a scene, and its triangles.
fn lit(surfaces: &Surfaces, settings: &Settings) -> radiosity::Result<(Solution, TriMesh)> {
    let solution = solve(surfaces, settings, |_| ControlFlow::Continue(()))?;
    let mesh = reconstruct(surfaces, &solution);
    Ok((solution, mesh))
}

/// Prints adaptive and uniform meshes side by side.
fn table(name: &str, adaptive: &[Sample], (divisions, uniform): (&[f64], &[Sample])) {
    println!("\n{name}");
    println!("{:>9}{:>10}{:>8}{:>10}", "tolerance", "triangles", "all %", "shadow %");
    let cells = |sample: &Sample| {
        let [all, shadow] = sample.errors.map(|error| 100.0 * error);
        format!("{:>10}{all:>8.2}{shadow:>10.2}", sample.triangles)
    };
    for (row, sample) in adaptive.iter().enumerate() {
        print!("{:>9}{}", TOLERANCES[row], cells(sample));
        match uniform.get(row) {
            Some(sample) => println!("   uniform 1/{:<4}{}", divisions[row], cells(sample)),
            None => println!(),
        }
    }
}

/// Prints what the error in shadows costs.
fn conclude(summary: &[(&str, Needed, Needed)]) {
    println!("\ntriangles for {:.0} % error in the shadow set", 100.0 * GOAL);
    println!("{:<36}{:>12}{:>12}{:>20}", "", "adaptive", "uniform", "uniform / adaptive");
    for &(name, adaptive, uniform) in summary {
        println!("{name:<36}{adaptive:>12}{uniform:>12}{:>20}", ratio(uniform, adaptive));
    }
}
