//! Light on its way, to turn and look at: a page with the Cornell box after 1, 2, 24 and 100 shots,
//! each with its error against the light after all shots, which stands beside it.

use std::ops::ControlFlow;
use std::path::Path;

use radiosity::page::{self, Cell, Model, Step, Table, Viewer, WipePicture, html};
use radiosity::render::{self, Display, RenderOptions, View};
use radiosity::scene::{Camera, LoadOptions};
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Settings, Solution, TriMesh, load, reconstruct, solve, surfaces_of};

fn main() -> radiosity::Result<()> {
    let scene = load(Path::new("scenes/cornell-box.glb"), &LoadOptions::default())?;
    let surfaces = surfaces_of(&scene);
    let after = |max_shots| {
        let settings = Settings { max_shots: Some(max_shots), ..Settings::draft() };
        solve(&surfaces, &settings, |_| ControlFlow::Continue(()))
    };
    let lamp_patches = after(0)?.shots;
    // One shot less than all: the mesh is not refined to reflected light and so is the same in all.
    let all = after(usize::MAX)?.shots - 1;
    let shots = [1, 2, 24, 100].map(|shots| lamp_patches + shots - 1);
    let lit = |shots| after(shots).map(|solution| (reconstruct(&surfaces, &solution), solution));
    let steps: radiosity::Result<Vec<(TriMesh, Solution)>> = shots.into_iter().map(lit).collect();
    let (reference, end) = lit(all)?;
    let page = document(&steps?, (&reference, &end), &scene.cameras[0]);
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
        label: format!("{} shots", solution.shots),
        model: Model::of_solution(mesh, &solution.mesh).with_errors(&errors(mesh, reference)),
    };
    let viewer = |steps: &[Step], alt: &str, still: &[u8]| {
        let (group, caption, still) = ("box", alt, Some(still));
        page::viewer(&Viewer { steps, camera, exposure, group, alt, caption, still })
    };
    let all = Step { label: "all".to_owned(), model: Model::of_solution(reference, &end.mesh) };
    let first = &steps[0].0;
    let stills = [first, reference].map(|mesh| picture(mesh, View::Light));
    let meshes = [first, reference].map(|mesh| picture(mesh, View::Wireframe));
    let pictures = [("first", 0), ("all", 1)].map(|(label, number)| WipePicture {
        label,
        png: &stills[number],
        alt: "The Cornell box",
        mesh: Some(&meshes[number]),
    });
    let row = |(_, solution): &(TriMesh, Solution)| {
        let unshot = 100.0 * solution.energy.unshot_share();
        vec![Cell::count(solution.shots), Cell::number(unshot, 2)]
    };
    let body = html! {
        h1 { "Light on its way" }
        (page::columns(&[
            viewer(&steps.iter().map(step).collect::<Vec<_>>(), "After some shots", &stills[0]),
            viewer(&[all], "After all shots", &stills[1]),
        ]))
        (page::wipe(&pictures, "After the lamp has shot, and after all have."))
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
