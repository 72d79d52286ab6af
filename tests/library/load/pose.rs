//! Where skins and morph targets put what hangs on them: where a viewer shows it.

use glam::{DVec3, Vec3};
use serde_json::{Value, json};

use super::asset::{Asset, FLOAT, floats};

/// The triangle on the joint `nodes[1]`, all of each vertex's weight on that.
fn skinned(nodes: Value) -> Asset {
    Asset::triangle()
        .attribute("JOINTS_0", &[0; 12], 5121, "VEC4")
        .attribute("WEIGHTS_0", &floats(&[1., 0., 0., 0.].repeat(3)), FLOAT, "VEC4")
        .set("/skins", json!([{"joints": [1]}]))
        .set("/nodes", nodes)
}

fn close(found: DVec3, expected: [f64; 3]) {
    assert!((found - DVec3::from(expected)).length() < 1e-6, "{found} for {expected:?}");
}

#[test]
fn joints_place_a_skinned_mesh_and_its_node_does_not() {
    let body = json!({"mesh": 0, "skin": 0, "translation": [0, 2, 0], "scale": [100, 100, 100]});
    let joint = json!({"translation": [1, 0.5, 0], "scale": [2, 2, 2]});
    let scene = skinned(json!([body, joint])).load();
    close(scene.positions[0], [1.0, 0.5, 0.0]);
    close(scene.positions[1], [3.0, 0.5, 0.0]);
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    // Without joints of its own, a mesh stays at its node.
    let mut bare = skinned(json!([{"mesh": 0, "skin": 0, "translation": [0, 2, 0]}, joint]));
    bare.json["meshes"][0]["primitives"][0]["attributes"]
        .as_object_mut()
        .unwrap()
        .remove("WEIGHTS_0");
    close(bare.load().positions[0], [0.0, 2.0, 0.0]);
}

#[test]
fn weights_share_vertices_among_joints_from_where_they_were_bound() {
    let mut asset = Asset::triangle()
        .attribute("JOINTS_0", &[0, 1, 0, 0].repeat(3), 5121, "VEC4")
        .attribute("WEIGHTS_0", &[64, 64, 0, 0].repeat(3), 5121, "VEC4")
        .attribute("NORMAL", &floats(&[0.6, 0., 0.8].repeat(3)), FLOAT, "VEC3")
        .set("/accessors/2/normalized", json!(true));
    let shift = |x: f32| [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., x, 0., 0., 1.];
    let inverses = floats(&[shift(-5.0), shift(0.0)].concat());
    let inverses = asset.add(&inverses, FLOAT, "MAT4", 2);
    let (still, raised) = (json!({"translation": [5, 0, 0]}), json!({"translation": [0, 4, 0]}));
    let scene = asset
        .set("/skins", json!([{"joints": [1, 2], "inverseBindMatrices": inverses}]))
        .set("/nodes", json!([{"mesh": 0, "skin": 0}, still, raised]))
        .load();
    close(scene.positions[1], [1.0, 2.0, 0.0]);
    assert!(scene.faces[0].normals[0].abs_diff_eq(Vec3::new(0.6, 0.0, 0.8), 1e-6));
}

#[test]
fn morph_targets_count_by_the_weights_of_their_node_or_else_of_their_mesh() {
    let morphed = |mesh: Value, node: Value| {
        let mut asset = Asset::triangle();
        let moves = asset.add(&floats(&[0., 1., 0.].repeat(3)), FLOAT, "VEC3", 3);
        let mut asset = asset
            .set("/meshes/0/primitives/0/targets", json!([{"POSITION": moves}]))
            .set("/nodes/0/weights", node)
            .set("/meshes/0/weights", mesh);
        if asset.json["nodes"][0]["weights"].is_null() {
            asset.json["nodes"][0].as_object_mut().unwrap().remove("weights");
        }
        asset
    };
    for (mesh, node, height) in [
        (json!([1.0]), Value::Null, 1.0),
        (json!([0.25]), json!([0.5]), 0.5),
        (json!([0.0]), Value::Null, 0.0),
    ] {
        let scene = morphed(mesh, node).load();
        close(scene.positions[0], [0.0, height, 0.0]);
        assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    }
    let wrong = morphed(json!([1.0]), Value::Null);
    assert!(wrong.set("/accessors/1/count", json!(2)).error().contains("2 elements for 3"));
}

#[test]
fn joints_that_are_none_are_refused() {
    let nodes = json!([{"mesh": 0, "skin": 0}, {}]);
    let error = |pointer: &str, value: Value| skinned(nodes.clone()).set(pointer, value).error();
    assert!(error("/nodes/0/skin", json!(3)).contains("skin 3"));
    assert!(error("/skins/0/joints", json!([7])).contains("node 7, is not in the scene"));
    assert!(error("/skins/0/joints", json!([])).contains("joint 0 of a skin of 0"));
    assert!(error("/skins/0/inverseBindMatrices", json!(0)).contains("inverseBindMatrices"));
    assert!(error("/accessors/1/componentType", json!(FLOAT)).contains("accessor 1 (JOINTS)"));
    let mut weightless = skinned(nodes.clone());
    let end = weightless.bytes.len();
    weightless.bytes[end - 48..].fill(0);
    assert!(weightless.error().contains("its weights are 0"));
    let few = skinned(nodes).set("/accessors/2/count", json!(2)).error();
    assert!(few.contains("2 elements for 3"), "{few}");
}
