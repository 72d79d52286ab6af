//! A scene built in code: a lamp over a table in front of a red wall, solved and written.

use std::ops::ControlFlow;
use std::path::Path;

use radiosity::colour::Rgb;
use radiosity::export::{self, Stamp};
use radiosity::glam::DVec3;
use radiosity::render::{self, Display, RenderOptions};
use radiosity::scene::{Face, Material, MaterialId, Scene};
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Settings, reconstruct, solve, surfaces_of};

fn main() -> radiosity::Result<()> {
    let mut scene = Scene { objects: vec!["room".to_owned()], ..Scene::default() };
    let floor = material(&mut scene, "floor", Rgb::splat(0.6), Rgb::ZERO);
    let wall = material(&mut scene, "wall", Rgb::new(0.7, 0.15, 0.1), Rgb::ZERO);
    let table = material(&mut scene, "table", Rgb::new(0.5, 0.4, 0.25), Rgb::ZERO);
    let lamp = material(&mut scene, "lamp", Rgb::splat(0.5), Rgb::new(20.0, 18.0, 15.0));
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
    parallelogram(&mut scene, floor, DVec3::ZERO, [4.0 * z, 4.0 * x]);
    parallelogram(&mut scene, wall, DVec3::ZERO, [4.0 * x, 2.5 * y]);
    parallelogram(&mut scene, table, DVec3::new(1.0, 0.7, 0.8), [0.9 * z, 2.0 * x]);
    parallelogram(&mut scene, lamp, DVec3::new(1.6, 2.2, 1.0), [0.8 * x, 0.4 * z]);

    let surfaces = surfaces_of(&scene.build()?);
    let solution = solve(&surfaces, &Settings::draft(), |_| ControlFlow::Continue(()))?;
    let mesh = reconstruct(&surfaces, &solution);
    export::save(&mesh, Path::new("out/custom-scene.glb"), &Stamp::default())?;

    let options = RenderOptions::default();
    let camera = render::automatic_camera(&mesh, 4.0 / 3.0);
    let picture = render::render(&mesh, &camera, &options);
    let display = Display::exposed(exposure_scale(&mesh, Exposure::Automatic));
    render::save(&picture, Path::new("out/custom-scene.png"), &display)
}

/// Adds a material that reflects `reflectance` and emits the radiance `emission`, W/(m² sr).
fn material(scene: &mut Scene, name: &str, reflectance: Rgb, emission: Rgb) -> MaterialId {
    let name = name.to_owned();
    scene.add_material(Material { name, reflectance, emission, ..Material::default() })
}

/// Adds a parallelogram that faces the side from which `sides` turn counter-clockwise.
fn parallelogram(scene: &mut Scene, material: MaterialId, corner: DVec3, sides: [DVec3; 2]) {
    let first = scene.positions.len() as u32;
    let [a, b] = sides;
    scene.positions.extend([corner, corner + a, corner + a + b, corner + b]);
    let vertices = (first..first + 4).collect();
    scene.faces.push(Face { vertices, material, ..Face::default() });
}
