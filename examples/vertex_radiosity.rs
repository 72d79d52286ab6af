//! Radiosity at vertices, for Gouraud shading: extrapolated from the patches around, and evaluated there; and how far
//! both are from the truth.
//!
//! A vertex amid four patches has their mean. Halfway from it to a vertex on the border of a surface is the mean of two
//! patches, and halfway to a corner is the patch there; so values on borders lie as far beyond those of the patches as
//! the inner ones fall short of them.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use image::RgbImage;
use image::imageops::replace;
use radiosity::colour::Rgb;
use radiosity::glam::DVec3;
use radiosity::light::Direct;
use radiosity::mesh::{Mesh, VertexId};
use radiosity::render::{self, Display, RenderOptions};
use radiosity::scene::{Camera, Face, Material, MaterialId, Scene};
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Length, Settings, Solution, Surfaces, reconstruct, solve, surfaces_of};

/// Longest side of a patch, m: so large that it shows.
const PATCH: f64 = 0.5;

/// Width, height and depth of the room, m.
const ROOM: DVec3 = DVec3::new(4.0, 2.5, 3.0);

/// Pixels of each picture.
const SIZE: [u32; 2] = [420, 330];

fn main() -> radiosity::Result<()> {
    let surfaces = surfaces_of(&room().build()?);
    let patches = Settings { patch_size: Length::Metres(PATCH), ..Settings::high() };
    let undivided = Settings { max_level: 0, discontinuity_lines: false, ..patches.clone() };
    let go_on = |_: &_| ControlFlow::Continue(());
    let (evaluated, truth) =
        (solve(&surfaces, &undivided, go_on)?, solve(&surfaces, &patches, go_on)?);
    let extrapolated = with_irradiance(&evaluated, &extrapolated(&evaluated));

    println!("error, % of the radiosity there: {:>12} {:>12}", "extrapolated", "evaluated");
    let kinds = kinds(&evaluated.mesh);
    for (name, count) in [("amid four patches", 4), ("on borders", 2), ("in corners", 1)] {
        let vertices = || kinds.iter().filter(|(_, patches)| patches.len() == count);
        let mean_error = |solution: &Solution| {
            let errors = vertices().map(|(&vertex, _)| error(solution, &truth, vertex));
            100.0
                * (errors.map(|error| error * error).sum::<f64>() / vertices().count() as f64)
                    .sqrt()
        };
        let [first, second] = [&extrapolated, &evaluated].map(mean_error);
        println!("{:>4} {name:<27} {first:>12.2} {second:>12.2}", vertices().count());
    }
    picture(&surfaces, &[&extrapolated, &evaluated, &truth]);
    Ok(())
}

/// By vertex of the patches: those around it, each with the number of its corner there.
fn kinds(mesh: &Mesh) -> BTreeMap<VertexId, Vec<(usize, usize)>> {
    let mut around: BTreeMap<VertexId, Vec<(usize, usize)>> = BTreeMap::new();
    for (patch, root) in mesh.patches.iter().map(|patch| patch.root).enumerate() {
        for (corner, &vertex) in mesh[root].corners.iter().enumerate() {
            around.entry(vertex).or_default().push((patch, corner));
        }
    }
    around
}

/// Irradiance of the vertices of a grid of patches, W/m², from those of the patches.
fn extrapolated(solution: &Solution) -> BTreeMap<VertexId, Rgb> {
    let Solution { mesh, light, .. } = solution;
    let corners = |patch: usize| &mesh[mesh.patches[patch].root].corners;
    let patch = |patch: usize| {
        let root = mesh.patches[patch].root.index();
        light.direct[root] + light.indirect[root]
    };
    let kinds = kinds(mesh);
    let mut found: BTreeMap<VertexId, Rgb> = BTreeMap::new();
    for (&vertex, around) in kinds.iter().filter(|(_, around)| around.len() == 4) {
        found.insert(vertex, around.iter().map(|&(k, _)| patch(k)).sum::<Rgb>() / 4.0);
    }
    for (&vertex, around) in &kinds {
        let inner = match around[..] {
            // Of the edge between two patches, the other end.
            [(first, _), (second, _)] => {
                let shared = corners(first).iter().filter(|v| corners(second).contains(v));
                shared.copied().find(|&end| end != vertex)
            }
            [(only, corner)] => Some(corners(only)[(corner + 2) % 4]),
            _ => None,
        };
        if let Some(inner) = inner.and_then(|inner| found.get(&inner).copied()) {
            let mean = around.iter().map(|&(k, _)| patch(k)).sum::<Rgb>() / around.len() as f64;
            found.insert(vertex, 2.0 * mean - inner);
        }
    }
    found
}

/// The same solution with this light at its vertices.
fn with_irradiance(solution: &Solution, light: &BTreeMap<VertexId, Rgb>) -> Solution {
    let mut changed = solution.clone();
    for (&vertex, &irradiance) in light {
        changed.vertex_light.set_direct(vertex, Direct { irradiance, unoccluded: irradiance });
        changed.vertex_light.set_indirect(vertex, Rgb::ZERO);
    }
    changed
}

/// Difference of the light at a vertex of patches, which have the same corners in both, as a share of it.
fn error(solution: &Solution, truth: &Solution, vertex: VertexId) -> f64 {
    let at = |solution: &Solution| solution.vertex_light.irradiance(vertex);
    (at(solution) - at(truth)).length() / at(truth).length()
}

/// The pictures side by side, of one exposure.
fn picture(surfaces: &Surfaces, solutions: &[&Solution; 3]) {
    let meshes = solutions.map(|solution| reconstruct(surfaces, solution));
    let camera = Camera {
        name: String::new(),
        eye: ROOM * DVec3::new(0.5, 0.5, 0.0) + DVec3::new(0.0, 0.0, 7.2),
        target: ROOM * DVec3::new(0.5, 0.5, 0.0),
        up: DVec3::Y,
        vertical_fov: 0.6,
    };
    let display = Display::exposed(exposure_scale(&meshes[2], Exposure::Automatic));
    let [width, height] = SIZE;
    let options = RenderOptions { width, height, ..RenderOptions::default() };
    let mut sheet = RgbImage::new(3 * width, height);
    for (k, mesh) in (0..).zip(&meshes) {
        let picture = render::displayed(&render::render(mesh, &camera, &options), &display);
        replace(&mut sheet, &picture, k * i64::from(width), 0);
    }
    std::fs::create_dir_all("out").expect("a place for pictures");
    sheet.save("out/vertices.png").expect("a picture that can be written");
}

/// A closed room with a glowing ceiling and one wall of another colour.
fn room() -> Scene {
    let mut scene = Scene { objects: vec!["room".to_owned()], ..Scene::default() };
    let material = |name: &str, reflectance, emission| Material {
        name: name.to_owned(),
        reflectance,
        emission,
        ..Material::default()
    };
    scene.materials = vec![
        material("grey", Rgb::splat(0.7), Rgb::ZERO),
        material("red", Rgb::new(0.65, 0.1, 0.08), Rgb::ZERO),
        material("lamp", Rgb::splat(0.5), Rgb::ONE),
    ];
    let [x, y, z] = [DVec3::X * ROOM.x, DVec3::Y * ROOM.y, DVec3::Z * ROOM.z];
    let walls = [
        (0, DVec3::ZERO, [z, x]),
        (0, DVec3::ZERO, [x, y]),
        (1, DVec3::ZERO, [y, z]),
        (0, x, [z, y]),
        (0, z, [y, x]),
        (2, y, [x, z]),
    ];
    for (material, corner, [a, b]) in walls {
        let first = scene.positions.len() as u32;
        scene.positions.extend([corner, corner + a, corner + a + b, corner + b]);
        let vertices = (first..first + 4).collect();
        let material = MaterialId(material);
        scene.faces.push(Face { vertices, material, ..Face::default() });
    }
    scene
}
