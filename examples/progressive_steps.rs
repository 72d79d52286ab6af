//! Light on its way: pictures after 1, 2, 24 and 100 shots, the lamp's being the first, with and without the
//! ambient estimate of the light still unshot ([Cohen, Chen, Wallace and Greenberg
//! 1988](https://doi.org/10.1145/54852.378487)).

use std::ops::ControlFlow;
use std::path::Path;

use image::RgbImage;
use image::imageops::replace;
use radiosity::mesh::VertexId;
use radiosity::render::{self, Display, RenderOptions};
use radiosity::scene::LoadOptions;
use radiosity::solver::Progress;
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Plan, Settings, Solution, load, reconstruct, solve_with, surfaces_of};

/// Shots, the lamp's included.
const SHOTS: [usize; 4] = [1, 2, 24, 100];

/// Pixels along the edges of each picture.
const SIZE: u32 = 320;

fn main() -> radiosity::Result<()> {
    let load = |name| load(Path::new(name), &LoadOptions::default());
    let surfaces = surfaces_of(&load("scenes/cornell-box.obj")?);
    let camera = &load("scenes/cornell-box.glb")?.cameras[0];
    // About 7 000 elements; the last stage is not the end.
    let settings = Settings { tolerance: 0.0135, max_shots: Some(200), ..Settings::medium() };
    let plan = Plan { snapshots: &SHOTS.map(|shots| shots - 1), ..Plan::default() };
    let go_on = |_: &Progress| ControlFlow::Continue(());
    let (end, stages) = solve_with(&surfaces, &settings, plan, go_on)?;

    // One exposure, so that all can be compared.
    let exposure = exposure_scale(&reconstruct(&surfaces, &end), Exposure::Automatic);
    let options = RenderOptions { width: SIZE, height: SIZE, ..RenderOptions::default() };
    let picture = |solution: &Solution| {
        let picture = render::render(&reconstruct(&surfaces, solution), camera, &options);
        render::displayed(&picture, &Display::exposed(exposure))
    };
    let mut sheet = RgbImage::new(SIZE * SHOTS.len() as u32, 2 * SIZE);
    for (column, (shots, solution)) in (0..).zip(SHOTS.iter().zip(&stages)) {
        let left = i64::from(column * SIZE);
        replace(&mut sheet, &picture(&without_ambient(solution)), left, 0);
        replace(&mut sheet, &picture(solution), left, i64::from(SIZE));
        println!(
            "{shots:>3} shots from {} patches to {} elements: {:.2} % of the light unshot, \
             ambient light {:.3} W/m²",
            solution.mesh.patches.len(),
            solution.mesh.leaves().count(),
            100.0 * solution.energy.unshot_share(),
            solution.ambient.element_sum() / 3.0,
        );
    }
    std::fs::create_dir_all("out").expect("a place for pictures");
    sheet.save("out/shots.png").expect("a picture that can be written");
    Ok(())
}

/// The same solution with nothing but the light that has been shot.
fn without_ambient(solution: &Solution) -> Solution {
    let mut shot = solution.clone();
    for vertex in (0..shot.mesh.vertices.len() as u32).map(VertexId) {
        if let Some(indirect) = shot.vertex_light.indirect(vertex) {
            shot.vertex_light.set_indirect(vertex, indirect - shot.ambient);
        }
    }
    shot
}
