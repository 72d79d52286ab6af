//! Shadows that are hard for meshes: each scene as its mesh, as its solution, and with direct light
//! gathered again at every pixel, side by side.

use std::ops::ControlFlow;
use std::path::Path;

use glam::DVec3;
use image::RgbImage;
use image::imageops::replace;
use radiosity::render::{self, Display, RenderOptions, Solved, Subject, View};
use radiosity::scene::{Camera, LoadOptions};
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Settings, load, reconstruct, solve, surfaces_of};

/// A scene, and where it is seen from and where to, m.
const SCENES: [(&str, DVec3, DVec3); 5] = [
    ("blocker", DVec3::new(0.0, 2.3, 3.2), DVec3::new(0.0, 0.2, 0.2)),
    ("pole", DVec3::new(2.0, 1.5, 2.6), DVec3::new(-0.1, 0.5, -0.6)),
    ("blind", DVec3::new(2.4, 1.5, 2.2), DVec3::new(0.9, 0.4, 0.8)),
    ("table", DVec3::new(1.9, 1.7, 2.7), DVec3::new(0.0, 0.4, 0.0)),
    ("coloured", DVec3::new(0.0, 1.7, 2.9), DVec3::new(0.0, 0.5, -0.4)),
];

/// Size of each picture in pixels, without the strip below that of the mesh.
const SIZE: [u32; 2] = [480, 360];

fn main() -> radiosity::Result<()> {
    for (name, eye, target) in SCENES {
        let path = format!("scenes/{name}.obj");
        let surfaces = surfaces_of(&load(Path::new(&path), &LoadOptions::default())?);
        let settings = Settings::medium();
        let solution = solve(&surfaces, &settings, |_| ControlFlow::Continue(()))?;
        let mesh = reconstruct(&surfaces, &solution);
        let solved = Solved { surfaces: &surfaces, settings: &settings, solution: &solution };
        let subject = Subject { mesh: &mesh, solved: Some(solved) };
        let camera = Camera { name: String::new(), eye, target, up: DVec3::Y, vertical_fov: 0.8 };
        let display = Display::exposed(exposure_scale(&mesh, Exposure::Automatic));
        let picture = |view, final_gather| {
            let [width, height] = SIZE;
            let options = RenderOptions { view, width, height, final_gather, ..Default::default() };
            let go_on = |_| ControlFlow::Continue(());
            render::displayed(&render::render_solved(subject, &camera, &options, go_on), &display)
        };
        let shown = [(View::Wireframe, false), (View::Light, false), (View::Light, true)];
        let file = format!("out/gallery-{name}.png");
        side_by_side(&shown.map(|(view, final_gather)| picture(view, final_gather)))
            .save(&file)
            .unwrap_or_else(|error| panic!("{file}: {error}"));
        println!("{file}: {} triangles", mesh.triangles.len());
    }
    Ok(())
}

/// Pictures next to each other, at their tops.
fn side_by_side(pictures: &[RgbImage]) -> RgbImage {
    let height = pictures.iter().map(RgbImage::height).max().unwrap_or(0);
    let mut all = RgbImage::new(pictures.iter().map(RgbImage::width).sum(), height);
    let mut left = 0;
    for picture in pictures {
        replace(&mut all, picture, left, 0);
        left += i64::from(picture.width());
    }
    all
}
