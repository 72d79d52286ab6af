//! The Cornell box: a mesh for viewers, a picture, and the mesh drawn over the light.

use std::ops::ControlFlow;
use std::path::Path;

use radiosity::export::{self, Stamp};
use radiosity::render::{self, Display, RenderOptions, View};
use radiosity::scene::LoadOptions;
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Settings, load, reconstruct, solve, surfaces_of};

fn main() -> radiosity::Result<()> {
    let scene = load(Path::new("scenes/cornell-box.glb"), &LoadOptions::default())?;
    let surfaces = surfaces_of(&scene);
    let solution = solve(&surfaces, &Settings::medium(), |_| ControlFlow::Continue(()))?;
    let mesh = reconstruct(&surfaces, &solution);
    export::save(&mesh, Path::new("out/cornell-box.glb"), &Stamp::default())?;

    let camera = &scene.cameras[0];
    let display = Display::exposed(exposure_scale(&mesh, Exposure::Automatic));
    for (name, view) in [("cornell-box", View::Light), ("cornell-box-mesh", View::Wireframe)] {
        let options = RenderOptions { view, ..RenderOptions::default() };
        let picture = render::render(&mesh, camera, &options);
        render::save(&picture, &Path::new("out").join(name).with_extension("png"), &display)?;
    }
    println!("{} shots, {} triangles", solution.shots, mesh.triangles.len());
    Ok(())
}
