//! Light on its way, to turn and look at: a page with the Cornell box after 1, 2, 24 and 100 shots,
//! each with its error against the light after 1000 shots, which stands beside it.

use std::ops::ControlFlow;
use std::path::Path;

use radiosity::page::{self, Cell, Model, Step, Table, Viewer, WipePicture, html};
use radiosity::render::{self, Display, RenderOptions, View};
use radiosity::scene::{Camera, LoadOptions};
use radiosity::solver::Progress;
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Plan, Settings, Solution, TriMesh, load, reconstruct, solve_with, surfaces_of};

fn main() -> radiosity::Result<()> {
    let scene = load(Path::new("scenes/cornell-box.glb"), &LoadOptions::default())?;
    let surfaces = surfaces_of(&scene);
    // The first shot is the lamp's.
    let reflected = [1, 2, 24, 100, 1000].map(|shots| shots - 1);
    let plan = Plan { snapshots: &reflected, ..Plan::default() };
    let go_on = |_: &Progress| ControlFlow::Continue(());
    let (_, snapshots) = solve_with(&surfaces, &Settings::draft(), plan, go_on)?;
    let mut steps: Vec<(TriMesh, Solution)> = snapshots
        .into_iter()
        .map(|snapshot| (reconstruct(&surfaces, &snapshot), snapshot))
        .collect();
    let Some((reference, end)) = steps.pop() else {
        return Ok(());
    };
    let page = document(&steps, (&reference, &end), &scene.cameras[0]);
    page::save(&page, Path::new("out/progressive.html"))
}

fn document(
    steps: &[(TriMesh, Solution)],
    (reference, end): (&TriMesh, &Solution),
    camera: &Camera,
) -> page::Markup {
    let exposure = exposure_scale(reference, Exposure::Automatic);
    let picture = |mesh: &TriMesh, view| {
        let options = RenderOptions { view, width: 640, height: 480, ..RenderOptions::default() };
        render::png(&render::render(mesh, camera, &options), &Display::exposed(exposure))
    };
    let step = |(mesh, solution): &(TriMesh, Solution)| Step {
        label: format!("{} shots", 1 + solution.reflected_shots()),
        model: Model::of_solution(mesh, &solution.mesh).with_errors(&errors(mesh, reference)),
    };
    let viewer = |steps: &[Step], alt: &str, still: &[u8]| {
        let (group, caption, still) = ("box", alt, Some(still));
        page::viewer(&Viewer { steps, camera, exposure, group, alt, caption, still })
    };
    let all =
        Step { label: "1000 shots".to_owned(), model: Model::of_solution(reference, &end.mesh) };
    let first = &steps[0].0;
    let last = &steps[steps.len() - 1].0;
    let stills = [first, reference].map(|mesh| picture(mesh, View::Light));
    // A viewer begins with its last step.
    let still = picture(last, View::Light);
    let meshes = [first, reference].map(|mesh| picture(mesh, View::Wireframe));
    let pictures = [("first shot", 0), ("1000 shots", 1)].map(|(label, number)| WipePicture {
        label,
        png: &stills[number],
        alt: "The Cornell box",
        mesh: Some(&meshes[number]),
    });
    let row = |(_, solution): &(TriMesh, Solution)| {
        let unshot = 100.0 * solution.energy.unshot_share();
        vec![Cell::count(1 + solution.reflected_shots()), Cell::number(unshot, 2)]
    };
    let body = html! {
        h1 { "Light on its way" }
        (page::columns(&[
            viewer(&steps.iter().map(step).collect::<Vec<_>>(), "After some shots", &still),
            viewer(&[all], "After 1000 shots", &stills[1]),
        ]))
        (page::wipe(&pictures, "After the lamp alone has shot, and long after."))
        (page::table(&Table {
            caption: "",
            header: &["shots", "light unshot, %"],
            rows: steps.iter().map(row).collect(),
            file: "unshot.csv",
        }))
    };
    page::document("Light on its way", &body)
}

/// Relative error of every vertex's radiosity, summed over the channels.
fn errors(mesh: &TriMesh, reference: &TriMesh) -> Vec<f64> {
    let pairs = mesh.radiosity.iter().zip(&reference.radiosity);
    pairs.map(|(found, right)| found.element_sum() / right.element_sum() - 1.0).collect()
}
