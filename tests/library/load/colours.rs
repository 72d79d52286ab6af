//! Colours of vertices: linear over surfaces, exact in means.

use std::ops::ControlFlow;

use glam::DVec3;
use radiosity::light::Optics;
use radiosity::lightmap::Atlas;
use radiosity::mesh::Mesh;
use radiosity::scene::{Light, NamedLight, Scene};
use radiosity::{Settings, reconstruct, solve, surfaces_of};
use serde_json::json;

use super::Folder;
use super::asset::{Asset, FLOAT, floats};

/// A square of 1 m in the plane z = 0 of two triangles, one grey at each corner, counter-clockwise.
fn square(greys: [f32; 4]) -> Asset {
    let mut asset = Asset::triangle();
    let places = floats(&[0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]);
    let colours: Vec<f32> = greys.iter().flat_map(|&grey| [grey; 3]).collect();
    let uvs = floats(&[0., 1., 1., 1., 1., 0., 0., 0.]);
    let [place, colour, uv] = [(&places, "VEC3"), (&floats(&colours), "VEC3"), (&uvs, "VEC2")]
        .map(|(data, type_)| asset.add(data, FLOAT, type_, 4));
    let indices = asset.add(&[0, 1, 2, 0, 2, 3], 5121, "SCALAR", 6);
    let attributes = json!({"POSITION": place, "COLOR_0": colour, "TEXCOORD_0": uv});
    asset
        .set("/meshes/0/primitives/0/attributes", attributes)
        .set("/meshes/0/primitives/0/indices", json!(indices))
        .set("/materials/0/pbrMetallicRoughness/baseColorFactor", json!([0.8, 0.8, 0.8, 1]))
}

/// The scene under a sun that brings 100 W/m² everywhere.
fn lit(mut scene: Scene) -> Scene {
    let light = Light::Directional { direction: DVec3::NEG_Z, irradiance: DVec3::splat(100.0) };
    scene.lights.push(NamedLight { name: "sun".to_owned(), light });
    scene
}

#[test]
fn colours_that_agree_make_one_surface_and_others_part_at_their_edge() {
    for (greys, surfaces) in [([0.0, 0.5, 1.0, 0.5], 1), ([0.3; 4], 1), ([0.0, 1.0, 0.0, 1.0], 2)] {
        assert_eq!(surfaces_of(&square(greys).load()).list.len(), surfaces, "{greys:?}");
    }
}

#[test]
fn light_is_reflected_by_the_colour_at_each_place() {
    for greys in [[0.0, 1.0, 1.0, 0.0], [0.1, 0.3, 0.6, 0.4], [0.0, 1.0, 0.0, 1.0]] {
        let surfaces = surfaces_of(&lit(square(greys).load()));
        let settings = Settings { uniform: Some(0.25), ..Settings::draft() };
        let solution = solve(&surfaces, &settings, |_| ControlFlow::Continue(())).unwrap();
        let mesh = reconstruct(&surfaces, &solution);
        // Barycentric in the two triangles below and above the diagonal.
        let [a, b, c, d] = greys.map(f64::from);
        let grey = |p: DVec3| match p.x > p.y {
            true => a * (1.0 - p.x) + b * (p.x - p.y) + c * p.y,
            false => a * (1.0 - p.y) + d * (p.y - p.x) + c * p.x,
        };
        for (&p, radiosity) in mesh.positions.iter().zip(&mesh.radiosity) {
            let expected = 80.0 * grey(p);
            assert!((radiosity.x - expected).abs() < 1e-4, "{radiosity} for {expected} at {p}");
        }
        let patches = solution.mesh.patches.iter().zip(&solution.optics.reflectance);
        let power: f64 = patches.map(|(patch, reflectance)| reflectance.x * patch.area).sum();
        let expected = 0.8 * (a + c) / 3.0 + 0.8 * (b + d) / 6.0;
        assert!((power - expected).abs() < 1e-6, "{power} for {expected} with {greys:?}");
    }
}

#[test]
fn colours_of_vertices_and_of_pictures_multiply() {
    let picture = image::RgbImage::from_fn(2, 1, |x, _| image::Rgb([255 * x as u8; 3]));
    let mut half = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut half, image::ImageFormat::Png).unwrap();
    let textured = |greys| {
        square(greys)
            .set("/images", json!([{"uri": "a.png"}]))
            .set("/textures", json!([{"source": 0}]))
            .set("/materials/0/pbrMetallicRoughness/baseColorTexture", json!({"index": 0}))
            .text()
    };
    // The right half of the picture is white, and the tint there 3/4 on average.
    let mean = |greys| {
        let folder = Folder::new().with("a.png", half.get_ref()).with("a.gltf", textured(greys));
        let surfaces = surfaces_of(&folder.load("a.gltf").unwrap());
        let mesh = Mesh::new(&surfaces, &Settings::draft());
        let reflectance = Optics::new(&surfaces, &mesh).reflectance;
        mesh.patches.iter().zip(reflectance).map(|(p, r)| r.x * p.area).sum::<f64>()
    };
    assert!((mean([0.0, 1.0, 1.0, 0.0]) - 0.8 * 0.375).abs() < 1e-6, "{}", mean([0., 1., 1., 0.]));
    assert!((mean([0.5; 4]) - 0.8 * 0.25).abs() < 1e-6);
}

#[test]
fn the_mesh_of_a_lightmap_keeps_the_colours_of_its_vertices() {
    let surfaces = surfaces_of(&square([0.0, 1.0, 1.0, 0.0]).load());
    let mesh = Atlas::new(&surfaces, 64).unwrap().mesh;
    assert_eq!((mesh.parts.len(), mesh.positions.len()), (1, 4));
    for (place, tint) in mesh.positions.iter().zip(&mesh.tints) {
        assert!((f64::from(tint.x) - place.x).abs() < 1e-6, "{tint} at {place}");
    }
}
