//! glTF and GLB files that lie about themselves.

use serde_json::{Value, json};

use super::Folder;
use super::asset::{Asset, FLOAT, floats};

#[test]
fn accessors_that_lie_are_refused() {
    let accessor = |key: &str, value: Value| {
        Asset::triangle().set(&format!("/accessors/0/{key}"), value).error()
    };
    let beyond = "accessor 0 (POSITION)";
    assert!(accessor("type", json!("VEC2")).contains(beyond));
    assert!(accessor("componentType", json!(5121)).contains(beyond));
    assert!(accessor("count", json!(4)).contains(beyond));
    assert!(accessor("count", json!(u64::MAX)).contains(beyond));
    assert!(accessor("byteOffset", json!(4)).contains(beyond));
    assert!(accessor("byteOffset", json!(u64::MAX)).contains(beyond));
    assert!(accessor("bufferView", json!(7)).contains("buffer view 7"));
    let view = |key: &str, value: Value| {
        Asset::triangle().set(&format!("/bufferViews/0/{key}"), value).error()
    };
    assert!(view("byteStride", json!(4)).contains("stride of 4"));
    assert!(view("byteStride", json!(16)).contains("beyond"));
    assert!(view("byteLength", json!(999)).contains("buffer view 0"));
    assert!(view("byteOffset", json!(u64::MAX)).contains("buffer view 0"));
}

#[test]
fn indices_that_lie_are_refused() {
    let mut asset = Asset::triangle();
    let index = asset.add(&floats(&[0., 1., 2.]), FLOAT, "SCALAR", 3);
    let asset = asset.set("/meshes/0/primitives/0/indices", json!(index));
    assert!(asset.error().contains("unsigned"));
    let mut asset = Asset::triangle();
    let index = asset.add(&[0, 1, 3], 5121, "SCALAR", 3);
    let asset = asset.set("/meshes/0/primitives/0/indices", json!(index));
    assert!(asset.error().contains("vertex 3"));
    assert!(asset.set("/meshes/0/primitives/0/indices", json!(99)).error().contains("accessor 99"));
}

#[test]
fn numbers_that_are_none_are_refused() {
    let mut asset = Asset::triangle();
    asset.bytes[..4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(asset.error().contains("not finite"));
    let huge = Asset::triangle().set("/nodes/0/scale", json!([1e39, 1, 1]));
    assert!(huge.error().contains("node 0"));
}

#[test]
fn node_cycles_and_shared_children_are_refused() {
    let own = Asset::triangle().set("/nodes", json!([{"mesh": 0, "children": [0]}]));
    assert!(own.set("/scenes", json!([{"nodes": [0]}])).error().contains("node 0"));
    let shared = json!([{"children": [2]}, {"children": [2]}, {"mesh": 0}]);
    assert!(Asset::triangle().set("/nodes", shared).error().contains("node 2"));
}

#[test]
fn deep_trees_do_not_overflow_the_stack() {
    let mut nodes: Vec<Value> = (1..20_000).map(|child| json!({"children": [child]})).collect();
    nodes.push(json!({"mesh": 0}));
    assert_eq!(Asset::triangle().set("/nodes", json!(nodes)).load().faces.len(), 1);
}

#[test]
fn unreadable_requirements_and_uris_are_named() {
    let basis = json!(["KHR_texture_basisu"]);
    let asset = Asset::triangle().set("/extensionsRequired", basis);
    assert!(asset.error().contains("KHR_texture_basisu"));
    for (uri, word) in [
        ("a%ff.bin", "UTF-8"),
        ("gone.bin", "gone.bin"),
        ("http://example.org/a.bin", "example.org"),
        ("data:;base64,@@", "data: URI"),
    ] {
        let mut json = Asset::triangle().json;
        json["buffers"] = json!([{"byteLength": 36, "uri": uri}]);
        let folder = Folder::new().with("a.gltf", json.to_string());
        let message = folder.load("a.gltf").unwrap_err().to_string();
        assert!(message.contains(word), "{uri}: {message}");
    }
}

#[test]
fn cut_glb_headers_are_refused() {
    let glb = Asset::triangle().glb();
    for length in [4, 8, 12, 20, glb.len() - 1] {
        assert!(Folder::new().with("a.glb", &glb[..length]).load("a.glb").is_err(), "{length}");
    }
    let mut short = glb.clone();
    short[8..12].copy_from_slice(&5u32.to_le_bytes());
    assert!(Folder::new().with("a.glb", short).load("a.glb").is_err());
}
