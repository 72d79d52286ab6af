//! Light on its way: pictures after 1, 2, 24 and 100 shots, the lamp's being the first, with the
//! ambient estimate of the light still unshot ([Cohen, Chen, Wallace and Greenberg
//! 1988](https://doi.org/10.1145/54852.378487)).

use std::ops::ControlFlow;
use std::path::Path;

use radiosity::render::{self, Display, RenderOptions};
use radiosity::scene::LoadOptions;
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Settings, load, reconstruct, solve, surfaces_of};

fn main() -> radiosity::Result<()> {
    let load = |name| load(Path::new(name), &LoadOptions::default());
    let scene = load("scenes/cornell-box.obj")?;
    let camera = &load("scenes/cornell-box.glb")?.cameras[0];
    let surfaces = surfaces_of(&scene);
    let after = |max_shots| {
        let max_shots = Some(max_shots);
        let settings = Settings { max_shots, tolerance: 0.0058, ..Settings::medium() };
        solve(&surfaces, &settings, |_| ControlFlow::Continue(()))
    };
    // The lamp shoots patch by patch, but always whole.
    let lamp_patches = after(0)?.shots;
    let mut display = None;
    for shots in [100, 24, 2, 1] {
        let solution = after(lamp_patches + shots - 1)?;
        let mesh = reconstruct(&surfaces, &solution);
        // The exposure of the last step, so that all can be compared.
        let display = display
            .get_or_insert_with(|| Display::exposed(exposure_scale(&mesh, Exposure::Automatic)));
        let picture = render::render(&mesh, camera, &RenderOptions::default());
        render::save(&picture, Path::new(&format!("out/shots-{shots:03}.png")), display)?;
        println!(
            "{shots:>3} shots from {} patches to {} elements: {:.2} % of the light unshot",
            solution.mesh.patches.len(),
            solution.mesh.leaves().count(),
            100.0 * solution.energy.unshot_share(),
        );
    }
    Ok(())
}
