//! glTF and GLB: what they say.

use std::f32::consts::FRAC_1_SQRT_2;
use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3, Vec3};
use radiosity::scene::{EmissionUnit, Light, LoadOptions, Sampler, Scene, Wrap, load};
use serde_json::{Value, json};

use super::asset::{Asset, FLOAT, floats};
use super::{Folder, red_png};

fn normal(scene: &Scene, face: usize) -> DVec3 {
    let [a, b, c] = [0, 1, 2].map(|i| scene.positions[scene.faces[face].vertices[i] as usize]);
    (b - a).cross(c - a).normalize()
}

#[test]
fn nodes_place_meshes_and_mirrors_keep_fronts() {
    let parent = json!({"translation": [0, 0, 5], "children": [1, 2]});
    let turned =
        json!({"mesh": 0, "name": "turned", "rotation": [FRAC_1_SQRT_2, 0, 0, FRAC_1_SQRT_2]});
    let mirrored = json!({"mesh": 0, "scale": [-2, 1, 1]});
    let scene = Asset::triangle().set("/nodes", json!([parent, turned, mirrored])).load();
    assert_eq!(scene.faces.len(), 2);
    assert_eq!(scene.objects, ["turned", "node 2"]);
    assert!((normal(&scene, 0) - DVec3::NEG_Y).length() < 1e-12);
    assert_eq!(normal(&scene, 1), DVec3::Z);
    assert_eq!(scene.bounds().unwrap().0.x, -2.0);
}

#[test]
fn the_default_scene_is_taken_else_the_first_else_all_roots() {
    let nodes = json!([{"mesh": 0}, {"mesh": 0, "translation": [9, 0, 0]}]);
    let asset = || Asset::triangle().set("/nodes", nodes.clone());
    let scenes = json!([{"nodes": [1]}, {"nodes": [0]}]);
    assert_eq!(asset().load().faces.len(), 2);
    assert_eq!(asset().set("/scenes", scenes.clone()).load().bounds().unwrap().0.x, 9.0);
    let chosen = asset().set("/scenes", scenes).set("/scene", json!(1)).load();
    assert_eq!(chosen.bounds().unwrap().0.x, 0.0);
}

#[test]
fn indices_of_every_width_mean_the_same() {
    let widths = [
        (5121, vec![0u8, 1, 2]),
        (5123, vec![0u8, 0, 1, 0, 2, 0]),
        (5125, vec![0u8, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]),
    ];
    let without = Asset::triangle().load();
    for (component, data) in widths {
        let mut asset = Asset::triangle();
        let index = asset.add(&data, component, "SCALAR", 3);
        let scene = asset.set("/meshes/0/primitives/0/indices", json!(index)).load();
        assert_eq!(scene.faces[0].vertices, without.faces[0].vertices);
    }
}

#[test]
fn glb_and_external_buffers_hold_the_same_scene() {
    let mut asset = Asset::triangle();
    let glb = Folder::new().with("a.glb", asset.glb()).load("a.glb").unwrap();
    assert_eq!(glb.positions, asset.load().positions);
    let size = asset.bytes.len();
    asset.json["buffers"] = json!([{"byteLength": size, "uri": "my%20data.bin"}]);
    let folder =
        Folder::new().with("my data.bin", &asset.bytes).with("a.gltf", asset.json.to_string());
    assert_eq!(folder.load("a.gltf").unwrap().positions, glb.positions);
}

#[test]
fn sparse_values_replace_their_base() {
    let mut asset = Asset::triangle();
    let places = asset.add(&[1], 5121, "SCALAR", 1);
    let values = asset.add(&floats(&[3., 0., 0.]), FLOAT, "VEC3", 1);
    let sparse = json!({"count": 1, "indices": {"bufferView": places, "componentType": 5121},
        "values": {"bufferView": values}});
    let scene = asset.set("/accessors/0/sparse", sparse).load();
    assert_eq!(scene.positions[1], DVec3::new(3.0, 0.0, 0.0));
}

#[test]
fn vertex_colours_of_every_encoding_tint_corners() {
    let full = f32::from(51u8) / 255.0;
    let encodings = [
        (FLOAT, "VEC3", false, floats(&[full; 9])),
        (FLOAT, "VEC4", false, floats(&[full; 12])),
        (5121, "VEC3", true, vec![51; 9]),
        (5121, "VEC4", true, vec![51; 12]),
        (5123, "VEC4", true, [51, 51].repeat(12)),
    ];
    for (component, type_, normalized, data) in encodings {
        let asset = Asset::triangle().attribute("COLOR_0", &data, component, type_);
        let scene = asset.set("/accessors/1/normalized", json!(normalized)).load();
        let tints = &scene.faces[0].tints;
        let right = |tint: &Vec3| (tint - Vec3::splat(0.2)).length() < 1e-6;
        assert!(tints.len() == 3 && tints.iter().all(right), "{component} {type_}: {tints:?}");
        assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    }
}

#[test]
fn transparent_vertex_colours_are_told_where_they_count() {
    let clear = floats(&[1., 1., 1., 0.5, 1., 1., 1., 1., 1., 1., 1., 1.]);
    let asset = || Asset::triangle().attribute("COLOR_0", &clear, FLOAT, "VEC4");
    let told = |scene: Scene| scene.notes.iter().any(|note| note.contains("vertex colours"));
    assert!(!told(asset().load()));
    assert!(told(asset().set("/materials/0/alphaMode", json!("BLEND")).load()));
}

#[test]
fn quantized_positions_are_read_only_where_declared() {
    let corners = [0u8, 0, 0, 255, 0, 0, 0, 255, 0];
    let asset = Asset::triangle()
        .attribute("POSITION", &corners, 5121, "VEC3")
        .set("/accessors/1/normalized", json!(true));
    assert!(asset.error().contains("accessor 1 (POSITION)"));
    let declared = asset
        .set("/extensionsUsed", json!(["KHR_mesh_quantization"]))
        .set("/extensionsRequired", json!(["KHR_mesh_quantization"]));
    assert_eq!(declared.load().positions[1], DVec3::X);
}

#[test]
fn materials_say_what_they_reflect_and_emit() {
    let material = json!({"name": "glow", "doubleSided": true,
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1], "metallicFactor": 1},
        "emissiveFactor": [1, 0.5, 0],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8},
            "KHR_materials_unlit": {}}});
    let scene = Asset::triangle().set("/materials/0", material).load();
    assert_eq!(scene.materials[0].reflectance, DVec3::new(0.5, 0.25, 0.99));
    assert_eq!(scene.materials[0].emission, DVec3::new(8.0, 4.0, 0.0));
    assert!(scene.materials[0].double_sided && scene.is_lit());
    assert_eq!(scene.notes.len(), 2, "one on metal, one on clamping: {:?}", scene.notes);
}

#[test]
fn faces_without_material_are_grey_with_a_note() {
    let mut asset = Asset::triangle();
    asset.json["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("material");
    let scene = asset.load();
    assert_eq!(scene[scene.faces[0].material].reflectance, DVec3::splat(0.5));
    assert_eq!(scene.notes.len(), 1, "{:?}", scene.notes);
}

fn textured(info: Value) -> Asset {
    Asset::triangle()
        .attribute("TEXCOORD_0", &floats(&[0.; 6]), FLOAT, "VEC2")
        .attribute("TEXCOORD_1", &floats(&[0., 0., 1., 0., 0., 1.]), FLOAT, "VEC2")
        .set("/images", json!([{"uri": "red.png"}]))
        .set("/samplers", json!([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}]))
        .set("/textures", json!([{"source": 0, "sampler": 0}]))
        .set("/materials/0", json!({"pbrMetallicRoughness": {"baseColorTexture": info}}))
}

#[test]
fn pictures_are_laid_on_by_the_chosen_coordinates_and_their_transform() {
    let info = json!({"index": 0, "extensions": {"KHR_texture_transform":
        {"texCoord": 1, "offset": [0.5, 0.25], "rotation": FRAC_PI_2, "scale": [2, 3]}}});
    let folder = Folder::new().with("red.png", red_png()).with("a.gltf", textured(info).text());
    let scene = folder.load("a.gltf").unwrap();
    let expected = [[0.5, 0.25], [0.5, -1.75], [3.5, 0.25]].map(DVec2::from);
    for (uv, wanted) in scene.faces[0].uvs.iter().zip(expected) {
        assert!((uv - wanted).length() < 1e-6, "{uv} {wanted}");
    }
    assert_eq!(scene.textures[0].texels.iter().collect::<Vec<_>>(), [[1.0, 0.0, 0.0]]);
    let sampler = Sampler { wrap: [Wrap::Clamp, Wrap::Mirror], nearest: true };
    assert_eq!(scene.textures[0].sampler, sampler);
    assert_eq!(*scene.textures[0].encoded, red_png());
}

#[test]
fn cut_outs_keep_their_holes_and_opaque_pictures_have_none() {
    let leaf =
        image::RgbaImage::from_fn(2, 1, |x, _| image::Rgba([9, 200, 9, 100 + 100 * x as u8]));
    let mut png = std::io::Cursor::new(Vec::new());
    leaf.write_to(&mut png, image::ImageFormat::Png).unwrap();
    let read = |picture: Vec<u8>, mode: &str| {
        let base = json!({"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 0.8]});
        let material = json!({"pbrMetallicRoughness": base, "alphaMode": mode, "alphaCutoff": 0.4});
        let asset = textured(json!({"index": 0})).set("/materials/0", material);
        Folder::new().with("red.png", picture).with("a.gltf", asset.text()).load("a.gltf").unwrap()
    };
    let scene = read(png.get_ref().clone(), "MASK");
    assert_eq!(scene.textures[0].alpha, [100, 200]);
    assert!((scene.materials[0].cutoff.unwrap() - 0.5).abs() < 1e-6);
    assert!(!scene.notes.iter().any(|note| note.contains("opaque")), "{:?}", scene.notes);
    assert_eq!(read(red_png().to_vec(), "MASK").materials[0].cutoff, None);
    assert_eq!(read(png.into_inner(), "BLEND").materials[0].cutoff, None);
}

#[test]
fn a_missing_picture_costs_a_note() {
    let scene = textured(json!({"index": 0})).load();
    assert_eq!(scene.materials[0].texture, None);
    assert!(scene.faces[0].uvs.is_empty());
    assert!(scene.notes[0].contains("red.png"), "{:?}", scene.notes);
}

#[test]
fn a_factor_that_says_nothing_under_a_missing_picture_is_taken_as_grey() {
    for (factor, expected) in [(0.0, 0.5), (1.0, 0.5), (0.25, 0.25)] {
        let scene = textured(json!({"index": 0}))
            .set(
                "/materials/0/pbrMetallicRoughness/baseColorFactor",
                json!([factor, factor, factor, 1]),
            )
            .load();
        assert_eq!(scene.materials[0].reflectance.x, expected, "{factor}");
        let told = scene.notes.iter().any(|note| note.starts_with("picture missing in"));
        assert_eq!(told, expected == 0.5, "{:?}", scene.notes);
    }
}

#[test]
fn vertex_normals_are_kept_where_they_bend() {
    let bent = floats(&[0.1, 0., 1., 0., 0., 1., 0., 0., 1.]);
    let scene = Asset::triangle().attribute("NORMAL", &bent, FLOAT, "VEC3").load();
    assert!(scene.faces[0].normals[1].abs_diff_eq(Vec3::Z, 1e-6));
    let flat = floats(&[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    let scene = Asset::triangle().attribute("NORMAL", &flat, FLOAT, "VEC3").load();
    assert!(scene.faces[0].normals.is_empty());
}

#[test]
fn lights_come_in_watts_and_follow_their_nodes() {
    let lights = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "intensity": 683, "color": [1, 0.5, 0], "range": 4},
        {"type": "spot", "intensity": 1366, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}},
        {"type": "directional", "intensity": 68300}]}});
    let node = |light: u32| {
        json!({"translation": [1, 2, 3], "rotation": [FRAC_1_SQRT_2, 0, 0, -FRAC_1_SQRT_2],
        "extensions": {"KHR_lights_punctual": {"light": light}}})
    };
    let scene = Asset::triangle()
        .set("/extensions", lights)
        .set("/nodes", json!([{"mesh": 0}, node(0), node(1), node(2)]))
        .load();
    let at = DVec3::new(1.0, 2.0, 3.0);
    let point = Light::Point { position: at, intensity: DVec3::new(1.0, 0.5, 0.0) };
    assert_eq!(scene.lights[0].light, point);
    let Light::Spot { direction, intensity, inner_angle, outer_angle, .. } = scene.lights[1].light
    else {
        panic!("{:?}", scene.lights[1]);
    };
    assert!((direction - DVec3::NEG_Y).length() < 1e-12, "{direction}");
    assert_eq!(intensity, DVec3::splat(2.0));
    assert!((inner_angle - 0.1).abs() < 1e-6 && (outer_angle - 0.2).abs() < 1e-6);
    let Light::Directional { irradiance, .. } = scene.lights[2].light else { panic!() };
    assert_eq!(irradiance, DVec3::splat(100.0));
    assert!(scene.is_lit());
}

#[test]
fn ranges_and_units_of_lights_are_told_where_they_matter() {
    let lit = |range: f64, emission: f64| {
        let lights = json!([{"type": "point", "intensity": 683, "name": "bulb", "range": range}]);
        let node = json!({"extensions": {"KHR_lights_punctual": {"light": 0}}});
        Asset::triangle()
            .set("/extensions", json!({"KHR_lights_punctual": {"lights": lights}}))
            .set("/nodes", json!([{"mesh": 0}, node]))
            .set("/materials/0/emissiveFactor", json!([emission, emission, emission]))
    };
    let told = |scene: Scene, words: &str| scene.notes.iter().any(|note| note.contains(words));
    assert!(told(lit(1.2, 0.0).load(), "range of \"bulb\""));
    assert!(!told(lit(1.5, 0.0).load(), "range"));
    assert!(told(lit(9.0, 0.5).load(), "--emission nits"));
    assert!(!told(lit(9.0, 0.0).load(), "--emission nits"));
    let options = LoadOptions { emission: EmissionUnit::Nits, ..LoadOptions::default() };
    let folder = Folder::new().with("a.gltf", lit(9.0, 0.683).text());
    let scene = load(&folder.path("a.gltf"), &options).unwrap();
    assert!((scene.materials[0].emission.x - 1e-3).abs() < 1e-9, "{:?}", scene.materials[0]);
    assert!(!told(scene, "--emission nits"));
}

#[test]
fn perspective_cameras_look_along_their_nodes_minus_z() {
    let scene = Asset::triangle()
        .set("/cameras", json!([
            {"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}},
            {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}}]))
        .set("/nodes", json!([{"mesh": 0}, {"camera": 0, "translation": [0, 0, 4], "scale": [2, 2, 2]},
            {"camera": 1}]))
        .load();
    let [camera] = &scene.cameras[..] else { panic!("{:?}", scene.cameras) };
    assert_eq!(camera.eye, DVec3::new(0.0, 0.0, 4.0));
    assert_eq!(camera.target - camera.eye, DVec3::NEG_Z);
    assert_eq!((camera.up, camera.vertical_fov), (DVec3::Y, 0.5));
    assert!(scene.notes[0].contains("1 camera ignored"), "{:?}", scene.notes);
}

#[test]
fn points_and_lines_are_ignored_with_a_note() {
    let mut asset = Asset::triangle();
    let lines = json!({"attributes": {"POSITION": 0}, "mode": 1});
    asset.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(lines);
    assert_eq!(asset.load().notes, ["1 primitive of points or lines ignored"]);
}

#[test]
fn the_hierarchy_of_nodes_is_kept_with_what_stands_in_it() {
    let scene = Asset::triangle()
        .set(
            "/nodes",
            json!([{"name": "house", "children": [1, 2]}, {"name": "rug", "mesh": 0},
            {"name": "view", "camera": 0, "translation": [0, 1, 2]}]),
        )
        .set("/scenes", json!([{"nodes": [0]}]))
        .set("/scene", json!(0))
        .set(
            "/cameras",
            json!([{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}]),
        )
        .load();
    let found: Vec<_> = scene
        .nodes
        .iter()
        .map(|node| (node.name.as_str(), node.parent, node.object, node.camera))
        .collect();
    let expected = [
        ("house", None, None, None),
        ("rug", Some(0), Some(0), None),
        ("view", Some(0), None, Some(0)),
    ];
    assert_eq!(found, expected);
}

#[test]
fn a_scene_far_from_the_origin_is_told() {
    let triangle = Asset::triangle();
    assert!(triangle.load().notes.is_empty(), "near");
    let far = triangle.set("/nodes/0", json!({"mesh": 0, "translation": [448262, 35, -5411932]}));
    assert!(far.load().notes.iter().any(|note| note.contains("from the origin")));
}
