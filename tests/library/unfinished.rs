//! Laws of solutions that are ended early: coarse, but not wrong.

use std::ops::ControlFlow;

use crate::common::{assert_sane, mean_radiosity, shipped};
use radiosity::light::Direct;
use radiosity::mesh::VertexId;
use radiosity::solver::{Cancellation, Phase, Progress, Stop};
use radiosity::{Settings, Solution, Surfaces, reconstruct, solve, surfaces_of};

/// When the work is ended.
const STAGES: [(Phase, f64); 6] = [
    (Phase::Emitters, 0.0),
    (Phase::Direct, 0.0),
    (Phase::Direct, 0.5),
    (Phase::Shooting, 0.0),
    (Phase::Shooting, 0.4),
    (Phase::Gathering, 0.3),
];

/// Fine enough for shadows to matter.
fn settings() -> Settings {
    Settings { max_level: 2, hemicube_resolution: 64, ..Settings::draft() }
}

fn ended_at(surfaces: &Surfaces, (phase, done): (Phase, f64)) -> Solution {
    let solution = solve(surfaces, &settings(), |progress: &Progress| {
        let is_enough = (progress.phase, progress.done) >= (phase, done);
        if is_enough { ControlFlow::Break(Cancellation::Caller) } else { ControlFlow::Continue(()) }
    });
    let solution = solution.unwrap();
    assert_eq!(solution.stop, Stop::Cancelled(Cancellation::Caller));
    solution
}

/// Share of the direct light that would arrive in the open at some vertices which does arrive.
fn visible(solution: &Solution, vertices: &[VertexId]) -> f64 {
    let sum = |of: fn(Direct) -> f64| -> f64 {
        vertices.iter().map(|&v| of(solution.vertex_light.direct(v).unwrap())).sum()
    };
    sum(|direct| direct.irradiance.element_sum()) / sum(|direct| direct.unoccluded.element_sum())
}

/// Corners of patches that no lamp shines on, though it would if nothing stood between.
fn hidden(solution: &Solution) -> Vec<VertexId> {
    let mesh = &solution.mesh;
    let corners = mesh.patches.iter().flat_map(|patch| mesh[patch.root].corners.iter().copied());
    let is_hidden =
        |direct: Direct| direct.unoccluded.element_sum() > 0.0 && direct.visible() < 0.01;
    corners.filter(|&v| is_hidden(solution.vertex_light.direct(v).unwrap())).collect()
}

fn what_is_ended_early_is_coarse_but_not_wrong(name: &str, tolerance: f64) {
    let surfaces = surfaces_of(&shipped(name));
    let whole = solve(&surfaces, &settings(), |_| ControlFlow::Continue(())).unwrap();
    let expected = mean_radiosity(&reconstruct(&surfaces, &whole));
    let dark = hidden(&whole);
    assert!(dark.len() > 20, "{name} has {} dark places", dark.len());
    let mut wrong = Vec::new();
    for stage in STAGES {
        let solution = ended_at(&surfaces, stage);
        let mesh = reconstruct(&surfaces, &solution);
        assert_sane(&mesh);
        let error = mean_radiosity(&mesh) / expected - 1.0;
        let told = format!("{name} at {stage:?}: {:+.1} %", 100.0 * error);
        println!("{told}");
        wrong.extend((error.abs() >= tolerance).then_some(told));
        let share = visible(&solution, &dark);
        assert!(share < 0.03, "{name} at {stage:?}: {share:.3} of the light in dark places");
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn a_box_ended_early_is_coarse_but_not_wrong() {
    what_is_ended_early_is_coarse_but_not_wrong("cornell-box.obj", 0.05);
}

#[test]
fn an_office_ended_early_is_coarse_but_not_wrong() {
    what_is_ended_early_is_coarse_but_not_wrong("office.obj", 0.1);
}
