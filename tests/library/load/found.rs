//! Files as exporters leave them: old, compressed, named in their own ways, of odd sizes.

use glam::DVec3;
use serde_json::json;

use super::asset::Asset;
use super::{Folder, red_png};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn the_first_version_of_gltf_is_refused_by_name() {
    let old = r#"{"asset": {"version": "1.0"}, "nodes": {"a": {}}, "buffers": {}}"#;
    let mut glb = Asset::triangle().glb();
    glb[4] = 1;
    let folder = Folder::new().with("a.gltf", old).with("a.glb", glb);
    for name in ["a.gltf", "a.glb"] {
        let message = folder.load(name).unwrap_err().to_string();
        assert!(message.contains("only version 2 is read"), "{message}");
    }
}

#[test]
fn colours_beside_gloss_are_read() {
    let glossy = json!({"diffuseFactor": [0.25, 0.5, 0.75, 1], "diffuseTexture": {"index": 0}});
    let material = json!({"extensions": {"KHR_materials_pbrSpecularGlossiness": glossy}});
    let asset = Asset::triangle()
        .set("/materials/0", material)
        .set("/images", json!([{"uri": "red.png"}]))
        .set("/textures", json!([{"source": 0}]))
        .set("/extensionsRequired", json!(["KHR_materials_pbrSpecularGlossiness"]));
    let folder = Folder::new().with("red.png", red_png()).with("a.gltf", asset.text());
    let scene = folder.load("a.gltf").unwrap();
    assert_eq!(scene.materials[0].reflectance, DVec3::new(0.25, 0.5, 0.75));
    assert_eq!(scene.materials[0].texture, Some(0));
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
}

#[test]
fn compression_that_is_broken_or_not_read_is_refused_by_name() {
    let draco = Asset::triangle();
    let packed = json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}});
    let draco = draco.set("/meshes/0/primitives/0/extensions", packed);
    assert!(draco.error().contains("KHR_draco_mesh_compression"), "{}", draco.error());
    let packed = json!({"EXT_meshopt_compression": {"buffer": 0, "count": 3}});
    let meshopt = Asset::triangle()
        .set("/bufferViews/0/extensions", packed)
        .set("/bufferViews/0/buffer", json!(1));
    assert!(meshopt.error().contains("EXT_meshopt_compression"), "{}", meshopt.error());
    for name in ["KHR_meshopt_compression", "KHR_texture_basisu", "EXT_mesh_gpu_instancing"] {
        let asset = Asset::triangle().set("/extensionsRequired", json!([name]));
        assert!(asset.error().contains(name), "{}", asset.error());
    }
}

#[test]
fn pictures_and_extensions_that_are_not_read_are_named() {
    let source = json!([{"extensions": {"KHR_texture_basisu": {"source": 0}}}]);
    let texture = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}});
    let scene = Asset::triangle()
        .set("/textures", source)
        .set("/materials/0", texture)
        .set("/extensionsUsed", json!(["KHR_materials_ior", "EXT_mesh_gpu_instancing"]))
        .load();
    assert!(scene.notes[0].contains("KHR_texture_basisu"), "{:?}", scene.notes);
    let named = "extensions not read: \"EXT_mesh_gpu_instancing\"".to_owned();
    assert!(scene.notes.contains(&named), "{:?}", scene.notes);
}

#[test]
fn files_are_found_under_escaped_plain_and_foreign_names() {
    let asset = Asset::triangle();
    for (uri, name) in [
        ("r%C3%A4um%20%231.bin", "r\u{e4}um #1.bin"),
        ("r\u{e4}um 2.bin", "r\u{e4}um 2.bin"),
        ("50%25.bin", "50%25.bin"),
        ("parts\\a.bin", "parts/a.bin"),
    ] {
        let folder = Folder::new();
        std::fs::create_dir(folder.path("parts")).unwrap();
        let mut json = asset.json.clone();
        json["buffers"] = json!([{"byteLength": asset.bytes.len(), "uri": uri}]);
        let folder = folder.with(name, &asset.bytes).with("a.gltf", json.to_string());
        assert!(folder.load("a.gltf").is_ok(), "{uri}");
    }
    let obj = format!("mtllib m.mtl\n{SQUARE}vt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    let folder = Folder::new()
        .with("s.obj", obj)
        .with("m.mtl", "newmtl a\nmap_Kd C:\\My Scenes\\red.png\n")
        .with("red.png", red_png());
    assert_eq!(folder.load("s.obj").unwrap().textures.len(), 1);
}

#[test]
fn two_bytes_a_letter_are_read() {
    let text = format!("\u{feff}{SQUARE}f 1 2 3 4\n");
    let bytes: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    assert_eq!(Folder::new().with("s.obj", bytes).load("s.obj").unwrap().faces.len(), 1);
}

#[test]
fn sizes_that_hint_at_another_unit_are_told() {
    let notes = |size: f64| {
        let text = format!("v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nf 1 2 3\nusemtl\n");
        Folder::new().with("s.obj", text).load("s.obj").unwrap().notes.join("\n")
    };
    assert!(notes(5560.0).contains("is its unit the metre?"));
    assert!(notes(0.001).contains("is its unit the metre?"));
    assert!(!notes(5.0).contains("unit"));
}

#[test]
fn a_thousand_complaints_are_cut_short() {
    let wrong = "Kd x\n".repeat(1000);
    let folder = Folder::new()
        .with("s.obj", format!("mtllib m.mtl\n{SQUARE}usemtl a\nf 1 2 3 4\n"))
        .with("m.mtl", format!("newmtl a\n{wrong}"));
    let notes = folder.load("s.obj").unwrap().notes;
    assert!(notes.len() < 100 && notes.last().unwrap().ends_with("more notes"), "{}", notes.len());
}

#[test]
fn corners_apart_by_rounding_are_one() {
    let text =
        "v 1 0 0\nv 2 0 0\nv 1 1 0\nv 2.0000002 0 0\nv 2 1 0\nv 1 1.0000001 0\nf 1 2 3\nf 4 5 6\n";
    let scene = Folder::new().with("s.obj", text).load("s.obj").unwrap();
    assert_eq!(scene.positions.len(), 4);
    assert!(scene.notes[0].starts_with("2 corners moved"), "{:?}", scene.notes);
}

#[test]
fn glass_is_left_out_and_what_is_half_clear_is_told() {
    let with = |glass: serde_json::Value| {
        let mut asset = Asset::triangle();
        let mut second = asset.json["meshes"][0]["primitives"][0].clone();
        asset.json["meshes"][0]["primitives"][0]["material"] = json!(0);
        second["material"] = json!(1);
        asset.json["meshes"][0]["primitives"] =
            json!([asset.json["meshes"][0]["primitives"][0], second]);
        asset.json["materials"] = json!([{"name": "wall"}, glass]);
        // The second triangle lies in the first one's place: what is left out is gone before that matters.
        asset.load()
    };
    let colour =
        |alpha: f64| json!({"baseColorFactor": [0.5, 0.5, 0.5, alpha], "metallicFactor": 0});
    let transmission =
        |factor: f64| json!({"KHR_materials_transmission": {"transmissionFactor": factor}});
    for (glass, words) in [
        (json!({"alphaMode": "BLEND", "pbrMetallicRoughness": colour(0.0)}), "left out"),
        (json!({"alphaMode": "BLEND", "pbrMetallicRoughness": colour(0.3)}), "left out"),
        (json!({"alphaMode": "MASK", "pbrMetallicRoughness": colour(0.3)}), "left out"),
        (json!({"extensions": transmission(0.9)}), "left out"),
        (json!({"alphaMode": "BLEND", "pbrMetallicRoughness": colour(0.8)}), "opaque"),
        (json!({"extensions": transmission(0.4)}), "opaque"),
        (json!({"extensions": transmission(0.9), "emissiveFactor": [1, 1, 1]}), "opaque"),
    ] {
        let mut glass = glass;
        glass["name"] = json!("pane");
        let notes = with(glass.clone()).notes;
        let told = |note: &String| note.contains("\"pane\"") && note.contains(words);
        assert!(notes.iter().any(told), "{glass}: {notes:?}");
    }
    let plain = with(json!({"name": "pane", "pbrMetallicRoughness": colour(0.0)}));
    assert!(!plain.notes.iter().any(|note| note.contains("\"pane\"")));
}

#[test]
fn transparent_materials_of_an_mtl_file_are_told_and_stay() {
    let notes = |line: &str| {
        let obj = format!("mtllib m.mtl\n{SQUARE}usemtl a b\nf 1 2 3 4\n");
        let mtl = format!("newmtl a b\nKd 0.5\n{line}\n");
        let scene = Folder::new().with("s.obj", obj).with("m.mtl", mtl).load("s.obj").unwrap();
        assert_eq!(scene.faces.len(), 1);
        scene.notes.join("\n")
    };
    for line in ["d 0.3", "Tr 0.7", "d -halo 0.5", "d 0"] {
        assert!(notes(line).contains("taken as opaque: \"a b\""), "{line}: {}", notes(line));
    }
    for line in ["d 1", "Tr 0", "Tr 1", "Tr 0.5\nd 1", "d 1\nTr 0.5", "d x"] {
        assert_eq!(notes(line), "", "{line}");
    }
}
