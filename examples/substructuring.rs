//! Substructuring: few patches, many patches, and few patches with as many elements where light
//! asks for them ([Cohen, Greenberg, Immel and Brock
//! 1986](https://doi.org/10.1109/MCG.1986.276629)).

mod common;

use std::path::Path;
use std::time::Instant;

use radiosity::render::{self, Display, RenderOptions, View};
use radiosity::scene::LoadOptions;
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Length, Settings, load, surfaces_of};

fn main() -> radiosity::Result<()> {
    let load = |name| load(Path::new(name), &LoadOptions::default());
    let surfaces = surfaces_of(&load("scenes/cornell-box.obj")?);
    let camera = &load("scenes/cornell-box.glb")?.cameras[0];
    let (_, truth) = common::lit(&surfaces, &Settings::high())?;
    let display = Display::exposed(exposure_scale(&truth, Exposure::Automatic));

    let patches = |metres, settings| Settings { patch_size: Length::Metres(metres), ..settings };
    let undivided = Settings { max_level: 0, ..Settings::medium() };
    let divided = Settings { tolerance: 0.35, ..Settings::medium() };
    for (name, settings) in [
        ("few", patches(0.135, undivided.clone())),
        ("many", patches(0.047, undivided)),
        ("few-divided", patches(0.135, divided)),
    ] {
        let start = Instant::now();
        let (solution, mesh) = common::lit(&surfaces, &settings)?;
        let seconds = start.elapsed().as_secs_f64();
        println!(
            "{name:<11} {:>4} patches, {:>4} elements: {seconds:.2} s, {:.2} % error",
            solution.mesh.patches.len(),
            solution.mesh.leaves().count(),
            100.0 * common::error(&mesh, &truth, camera),
        );
        let options = RenderOptions { view: View::Wireframe, ..RenderOptions::default() };
        let picture = render::render(&mesh, camera, &options);
        render::save(&picture, Path::new(&format!("out/patches-{name}.png")), &display)?;
    }
    Ok(())
}
