//! A shadow on a floor: a uniform and an adaptive mesh of about as many elements, and how far each is from the truth.

mod common;

use std::ops::ControlFlow;
use std::path::Path;

use glam::DVec3;
use radiosity::render::{self, Display, RenderOptions};
use radiosity::scene::{Camera, LoadOptions};
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Length, Settings, Surfaces, TriMesh, load, reconstruct, solve, surfaces_of};

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
    let (truth, _) = lit(&surfaces, &fine)?;
    let display = Display::Exposed { scale: exposure_scale(&truth, Exposure::Automatic) };

    for t in [0.05, 0.03, 0.02, 0.015, 0.009] {
        let (m, n) = lit(&surfaces, &Settings { tolerance: t, ..Settings::medium() })?;
        println!("a {t} {n} {}", 100.0 * common::error(&m, &truth, &camera));
    }
    for t in [0.4, 0.3, 0.25, 0.2, 0.15, 0.1] {
        let (m, n) = lit(
            &surfaces,
            &Settings { patch_size: Length::Metres(t), uniform: Some(t), ..Settings::medium() },
        )?;
        println!("u {t} {n} {}", 100.0 * common::error(&m, &truth, &camera));
    }
    let uniform = Settings { uniform: Some(0.1), ..Settings::medium() };
    let adaptive = Settings { tolerance: 0.009, ..Settings::medium() };
    for (name, settings) in [("uniform", uniform), ("adaptive", adaptive)] {
        let (mesh, elements) = lit(&surfaces, &settings)?;
        let error = 100.0 * common::error(&mesh, &truth, &camera);
        println!("{name:<9} {elements:>5} elements, {error:.2} % error");
        let options = RenderOptions { wireframe: true, ..RenderOptions::default() };
        let picture = render::render(&mesh, &camera, &options);
        render::save(&picture, Path::new(&format!("out/shadow-{name}.png")), &display)?;
    }
    Ok(())
}

fn lit(surfaces: &Surfaces, settings: &Settings) -> radiosity::Result<(TriMesh, usize)> {
    let solution = solve(surfaces, settings, |_| ControlFlow::Continue(()))?;
    Ok((reconstruct(surfaces, &solution), solution.mesh.leaves().count()))
}
