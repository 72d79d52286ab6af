//! Laws of solutions that are ended early: coarse, but not wrong.

use std::ops::ControlFlow;

use crate::common::{assert_sane, mean_radiosity, shipped};
use radiosity::light::Direct;
use radiosity::mesh::{Mesh, VertexId};
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

/// Corners of patches that are on an edge of another patch of their surface, with the ends of that edge; none where a
/// contact line runs.
fn hanging(mesh: &Mesh) -> Vec<(VertexId, [VertexId; 2])> {
    let outlines = || mesh.patches.iter().map(|patch| &mesh[patch.root].corners[..]);
    let edges: Vec<[VertexId; 2]> = outlines()
        .flat_map(|corners| {
            (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]])
        })
        .collect();
    let is_on = |vertex: VertexId, [a, b]: [VertexId; 2]| {
        let [a, b, at] = [a, b, vertex].map(|v| mesh[v].position);
        let beyond = a.distance(at) + at.distance(b) - a.distance(b);
        a.distance(at) > 1e-6 && at.distance(b) > 1e-6 && beyond < 1e-9
    };
    let mut corners: Vec<VertexId> = outlines().flatten().copied().collect();
    corners.sort_unstable();
    corners.dedup();
    let on_edge = |&vertex: &VertexId| {
        let mut own = edges.iter().filter(|[a, _]| mesh[*a].surface == mesh[vertex].surface);
        Some((vertex, *own.find(|edge| is_on(vertex, **edge))?))
    };
    corners.retain(|&vertex| !mesh[vertex].on_contact);
    corners.iter().filter_map(on_edge).collect()
}

#[test]
fn light_on_its_way_does_not_ripple_where_patches_of_different_sizes_meet() {
    let surfaces = surfaces_of(&shipped("cornell-box.obj"));
    let settings = Settings { max_shots: Some(28), ..settings() };
    let solution = solve(&surfaces, &settings, |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(solution.stop, Stop::ShotLimit);
    let mesh = &solution.mesh;
    // Without the ambient light, which is even.
    let light = |vertex: VertexId| {
        let indirect = solution.vertex_light.indirect(vertex).unwrap();
        (indirect - solution.ambient).element_sum()
    };
    let (mut count, mut ripple, mut sum) = (0, 0.0, 0.0);
    for (vertex, [a, b]) in hanging(mesh) {
        let [from, to, at] = [a, b, vertex].map(|v| mesh[v].position);
        let share = from.distance(at) / from.distance(to);
        let between = light(a) * (1.0 - share) + light(b) * share;
        ripple += (light(vertex) - between).abs();
        (count, sum) = (count + 1, sum + between);
    }
    assert!(count > 8, "{count} corners on edges");
    // Means of those patches alone whose corners they are would come to 26 %.
    assert!(ripple < 0.18 * sum, "{} of the light in {count} places", ripple / sum);
}
