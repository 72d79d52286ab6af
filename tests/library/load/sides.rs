//! Rooms modelled from inside and from outside, and lamps that hang in them either way.

use glam::DVec3;
use radiosity::scene::{Light, LoadOptions, Scene, Sides, Sky, load, settle_sides};

use super::Folder;

/// A closed room of 4 × 3 × 5 m seen from inside, and in it a lamp that shines down.
const CORNERS: &str = "v 0 0 0\nv 4 0 0\nv 4 0 5\nv 0 0 5\nv 0 3 0\nv 4 3 0\nv 4 3 5\nv 0 3 5\n\
    v 1 2.9 1\nv 3 2.9 1\nv 3 2.9 4\nv 1 2.9 4\n";
const WALLS: [&str; 6] = ["4 3 2 1", "5 6 7 8", "1 2 6 5", "3 4 8 7", "2 3 7 6", "4 1 5 8"];
const LAMP: &str = "9 10 11 12";

fn face(corners: &str, turned: bool) -> String {
    let mut corners: Vec<&str> = corners.split(' ').collect();
    if turned {
        corners.reverse();
    }
    format!("f {}\n", corners.join(" "))
}

fn room(walls_turned: bool, lamp_turned: bool, sides: Sides) -> Scene {
    let walls: String = WALLS.iter().map(|wall| face(wall, walls_turned)).collect();
    let lamp = face(LAMP, lamp_turned);
    let text = format!("mtllib m.mtl\n{CORNERS}usemtl wall\n{walls}usemtl lamp\n{lamp}");
    let folder = Folder::new()
        .with("s.obj", text)
        .with("m.mtl", "newmtl wall\nKd 0.5\nnewmtl lamp\nKd 0\nKe 10\n");
    let options = LoadOptions { two_sided: sides, ..LoadOptions::default() };
    load(&folder.path("s.obj"), &options).unwrap()
}

fn normal(scene: &Scene, face: usize) -> DVec3 {
    let [a, b, c] = [0, 1, 2].map(|i| scene.positions[scene.faces[face].vertices[i] as usize]);
    (b - a).cross(c - a).normalize()
}

/// True if the floor faces up, the lamp down, and all have one side.
fn is_as_meant(scene: &Scene) -> bool {
    normal(scene, 0) == DVec3::Y
        && normal(scene, 6) == DVec3::NEG_Y
        && scene.materials.iter().all(|material| !material.double_sided)
}

#[test]
fn a_room_seen_from_inside_is_left_alone() {
    let scene = room(false, false, Sides::Auto);
    assert!(is_as_meant(&scene) && scene.notes.is_empty(), "{:?}", scene.notes);
}

#[test]
fn a_room_modelled_inside_out_is_turned_over() {
    let scene = room(true, true, Sides::Auto);
    assert!(is_as_meant(&scene));
    assert!(scene.notes[0].starts_with("all faces turned over"), "{:?}", scene.notes);
}

#[test]
fn walls_alone_inside_out_get_two_sides_and_the_lamp_does_not() {
    let scene = room(true, false, Sides::Auto);
    assert_eq!(normal(&scene, 6), DVec3::NEG_Y);
    assert!(scene.materials[0].double_sided && !scene.materials[1].double_sided);
    assert!(scene.notes[0].starts_with("both sides"), "{:?}", scene.notes);
}

#[test]
fn the_user_has_the_last_word() {
    let kept = room(true, true, Sides::AsWritten);
    assert!(normal(&kept, 0) == DVec3::NEG_Y && kept.notes.is_empty());
    assert!(is_as_meant(&room(true, true, Sides::Flipped)));
    let both = room(false, false, Sides::Both);
    assert!(both.materials.iter().all(|material| material.double_sided));
}

#[test]
fn light_from_a_point_inside_a_solid_room_opens_backs() {
    let node = serde_json::json!({"mesh": 0});
    let light = serde_json::json!({"translation": [0.2, 0.2, -1],
        "extensions": {"KHR_lights_punctual": {"light": 0}}});
    let lights = serde_json::json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    let behind = super::asset::Asset::triangle()
        .set("/extensions", lights.clone())
        .set("/nodes", serde_json::json!([node, light]));
    assert!(behind.load().materials[0].double_sided);
    let before = behind.set("/nodes/1/translation", serde_json::json!([0.2, 0.2, 1]));
    assert!(!before.load().materials[0].double_sided);
}

/// A room of 4 × 3 × 5 m with a window of 2 × 1.5 m in the wall at x = 0, its faces inward or turned over.
const WITH_WINDOW: &str = "v 0 0 0\nv 4 0 0\nv 4 0 5\nv 0 0 5\nv 0 3 0\nv 4 3 0\nv 4 3 5\nv 0 3 5\n\
    v 0 1 1.5\nv 0 1 3.5\nv 0 2.5 3.5\nv 0 2.5 1.5\n";
const AROUND_WINDOW: [&str; 4] = ["4 1 9 10", "1 5 12 9", "5 8 11 12", "8 4 10 11"];

fn by_day(faces: &[String], light: Light) -> Scene {
    let text = format!("{WITH_WINDOW}{}", faces.concat());
    let folder = Folder::new().with("s.obj", text);
    let mut scene = folder.load("s.obj").unwrap();
    scene.lights.push(light.into());
    settle_sides(&mut scene, Sides::Auto);
    scene
}

#[test]
fn daylight_in_a_room_modelled_inside_out_opens_backs() {
    let sun = Light::sun(270.0, 40.0, 50_000.0);
    for light in [Light::sky(Sky::Overcast, 10_000.0), sun] {
        for turned in [false, true] {
            let faces = WALLS[..5].iter().chain(&AROUND_WINDOW).map(|wall| face(wall, turned));
            let scene = by_day(&faces.collect::<Vec<_>>(), light.clone());
            assert_eq!(scene.materials[0].double_sided, turned, "{light:?} {:?}", scene.notes);
            let told = scene.notes.iter().any(|note| note.contains("enters rooms from outside"));
            assert_eq!(told, turned, "{:?}", scene.notes);
        }
    }
}

#[test]
fn a_solid_on_a_plain_keeps_its_one_side_by_day() {
    let mut faces: Vec<String> = WALLS.iter().map(|wall| face(wall, true)).collect();
    faces.push("v -90 0 -90\nv -90 0 90\nv 90 0 90\nv 90 0 -90\nf -4 -3 -2 -1\n".to_owned());
    for light in [Light::sky(Sky::Uniform, 10_000.0), Light::sun(200.0, 30.0, 50_000.0)] {
        let scene = by_day(&faces, light);
        assert!(scene.materials.iter().all(|material| !material.double_sided), "{:?}", scene.notes);
    }
}
