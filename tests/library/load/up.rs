//! Files in which Z is up.

use glam::{DVec3, Vec3};
use radiosity::Scene;
use radiosity::scene::{Camera, Light, LoadOptions, NamedLight, Up, load};
use serde_json::json;

use super::Folder;
use super::asset::Asset;

fn read(text: &str, up: Up) -> Scene {
    let folder = Folder::new().with("s.obj", text);
    load(&folder.path("s.obj"), &LoadOptions { up, ..LoadOptions::default() }).expect("a scene")
}

#[test]
fn what_is_up_in_the_file_is_up_in_the_scene_and_its_north_is_north() {
    // Seen from above; normals that lean east, of a floor that faces up.
    let text = "v 0 0 3\nv 1 0 3\nv 0 2 3\nvn 0.6 0 0.8\nf 1//1 2//1 3//1\n";
    let scene = read(text, Up::Z);
    assert_eq!(scene.positions, [[0., 3., 0.], [1., 3., 0.], [0., 3., -2.]].map(DVec3::from));
    let [a, b, c] = [0, 1, 2].map(|k| scene.positions[k]);
    assert_eq!((b - a).cross(c - a).normalize(), DVec3::Y);
    assert_eq!(scene.faces[0].normals[0], Vec3::new(0.6, 0.8, 0.0));
    assert_eq!(read(text, Up::Y).positions[2], DVec3::new(0.0, 2.0, 3.0));
}

#[test]
fn units_and_axes_are_those_of_every_format() {
    let stl = "solid a\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let light = json!({"KHR_lights_punctual": {"lights": [{"type": "spot"}]}});
    let here = json!({"translation": [0, 3, 4], "camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}});
    let gltf = Asset::triangle()
        .set("/extensions", light)
        .set("/cameras", json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}]))
        .set("/nodes", json!([{"mesh": 0}, here]));
    let folder = Folder::new()
        .with("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        .with("a.stl", stl)
        .with("a.ply", ply)
        .with("a.gltf", gltf.text());
    let options = LoadOptions { up: Up::Z, metres_per_unit: 0.5, ..LoadOptions::default() };
    for name in ["a.obj", "a.stl", "a.ply", "a.gltf"] {
        let scene = load(&folder.path(name), &options).unwrap();
        let expected = [[0., 0., 0.], [0.5, 0., 0.], [0., 0., -0.5]].map(DVec3::from);
        assert_eq!(scene.positions, expected, "{name}");
    }
    let scene = load(&folder.path("a.gltf"), &options).unwrap();
    let [NamedLight { light: Light::Spot { position, direction, .. }, .. }] = scene.lights[..]
    else {
        panic!("{:?}", scene.lights)
    };
    assert_eq!((position, direction), (DVec3::new(0.0, 2.0, -1.5), DVec3::NEG_Y));
    let [Camera { eye, target, up, .. }] = scene.cameras[..] else { panic!("{:?}", scene.cameras) };
    assert_eq!((eye, up), (position, DVec3::NEG_Z));
    assert_eq!((target - eye).normalize(), DVec3::NEG_Y);
}

#[test]
fn floors_that_stand_upright_tell_that_another_axis_is_up() {
    let room = "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2\nv 4 0 2\nusemtl Wall\nf 1 2 6 5\n";
    let told = |text: &str, up| {
        let notes = read(text, up).notes;
        notes.into_iter().find(|note| note.contains("stand upright"))
    };
    for named in ["g Floor 1\n", "usemtl my_floor\n"] {
        let text = format!("{room}{named}f 1 2 3 4\n");
        let note = told(&text, Up::Y).expect("the floor stands upright");
        assert!(note.contains("--up z") && note.to_lowercase().contains("floor"), "{note}");
        assert_eq!(told(&text, Up::Z), None);
    }
    // The floor of this one has its normal along Y, so Z is wrong; and names that say nothing tell nothing.
    let other = format!("{room}usemtl floor\nf 1 5 6 2\n");
    assert_eq!(told(&other, Up::Y), None);
    assert!(told(&other, Up::Z).expect("it stands upright").contains("--up y"));
    assert_eq!(told(&format!("{room}usemtl a\nf 1 2 3 4\n"), Up::Y), None);
}
