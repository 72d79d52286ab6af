//! A shadow on a floor: a uniform and an adaptive mesh of about as many elements, and how far each
//! is from the truth.

mod common;

use std::path::Path;

use glam::DVec3;
use radiosity::render::{self, Display, RenderOptions, View};
use radiosity::scene::{Camera, LoadOptions};
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Length, Settings, load, surfaces_of};

fn main() -> radiosity::Result<()> {
    let scene = load(Path::new("scenes/blocker.obj"), &LoadOptions::default())?;
    let surfaces = surfaces_of(&scene);
    let camera = Camera {
        name: String::new(),
        eye: DVec3::new(0.0, 2.3, 3.2),
        target: DVec3::new(0.0, 0.2, 0.2),
        up: DVec3::Y,
        vertical_fov: 0.8,
    };
    let fine = Settings {
        tolerance: 0.001,
        max_level: 10,
        min_element: Length::Metres(0.002),
        ..Settings::high()
    };
    let (_, truth) = common::lit(&surfaces, &fine)?;
    let display = Display::exposed(exposure_scale(&truth, Exposure::Automatic));

    let uniform = Settings { uniform: Some(0.1), ..Settings::medium() };
    let adaptive = Settings { tolerance: 0.023, ..Settings::medium() };
    for (name, settings) in [("uniform", uniform), ("adaptive", adaptive)] {
        let (solution, mesh) = common::lit(&surfaces, &settings)?;
        let elements = solution.mesh.leaves().count();
        let error = 100.0 * common::error(&mesh, &truth, &camera);
        println!("{name:<9} {elements:>5} elements, {error:.2} % error");
        let options = RenderOptions { view: View::Wireframe, ..RenderOptions::default() };
        let picture = render::render(&mesh, &camera, &options);
        render::save(&picture, Path::new(&format!("out/shadow-{name}.png")), &display)?;
    }
    Ok(())
}
