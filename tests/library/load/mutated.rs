//! Broken files of every kind: an error or a sound scene, never a panic.

use std::sync::LazyLock;

use proptest::prelude::*;
use radiosity::scene::{Light, MAX_REFLECTANCE, Scene};

use super::asset::{Asset, floats};
use super::{Folder, red_png};

const OBJ: &str = "mtllib m.mtl\no box\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nv 0.5 0.5 2\n\
    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0.1 1\ns 1\nusemtl a\nf 1/1/1 2/2/1 3/3/1 4/4/1\n\
    usemtl lamp\nf -1 -2 -3\ns off\ng other\nf 1 2 5\nf 5 4 3 2 1\n";
const MTL: &str = "newmtl a\nKd 0.5 0.25 1\nmap_Kd -s 2 2 1 -o 0.5 red.png\nnewmtl lamp\nKd 0.7\nKe 10 9 8\nillum 1\n";

/// A glTF file with something of everything.
static ASSET: LazyLock<Asset> = LazyLock::new(|| {
    let mut asset = Asset::triangle();
    let uvs = asset.add(&floats(&[0., 0., 1., 0., 0., 1.]), 5126, "VEC2", 3);
    let normals = asset.add(&floats(&[0.1, 0., 1., 0., 0., 1., 0., 0., 1.]), 5126, "VEC3", 3);
    let colours = asset.add(&[200; 12], 5121, "VEC4", 3);
    let indices = asset.add(&[0, 1, 2], 5121, "SCALAR", 3);
    asset.json["accessors"][colours]["normalized"] = true.into();
    asset.json["accessors"][0]["sparse"] = serde_json::json!({"count": 1,
        "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": 0}});
    let primitive = &mut asset.json["meshes"][0]["primitives"][0];
    primitive["attributes"] = serde_json::json!({"POSITION": 0, "NORMAL": normals, "TEXCOORD_0": uvs, "COLOR_0": colours});
    primitive["indices"] = indices.into();
    asset.json["images"] = serde_json::json!([{"uri": "red.png"}]);
    asset.json["textures"] = serde_json::json!([{"source": 0}]);
    asset.json["materials"] = serde_json::json!([{"emissiveFactor": [1, 1, 1],
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.5, 1], "baseColorTexture": {"index": 0,
            "extensions": {"KHR_texture_transform": {"scale": [2, 2], "rotation": 1.5}}}},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}}}]);
    asset.json["cameras"] =
        serde_json::json!([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}]);
    asset.json["extensions"] = serde_json::json!({"KHR_lights_punctual": {"lights": [
        {"type": "spot", "intensity": 100, "range": 5, "spot": {"outerConeAngle": 0.5}}]}});
    asset.json["nodes"] = serde_json::json!([{"mesh": 0, "camera": 0, "scale": [1, 2, -3],
        "children": [1]}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}]);
    asset
});

#[derive(Clone, Debug)]
enum Change {
    Flip(u8),
    Cut(usize),
    Double(usize),
    Word(&'static str),
    Truncate,
}

fn change() -> impl Strategy<Value = Change> {
    let words = [
        "nan",
        "-1",
        "0",
        "1e999",
        "1e38",
        "-1e300",
        "99999999999999999999",
        "4294967295",
        " ",
        "\n",
        "/",
        "\\",
        "\"",
        "[]",
        "{}",
        "null",
        "5126",
        "5125",
        "5123",
        "\"VEC2\"",
        "\"SCALAR\"",
        "\u{fffd}",
    ];
    prop_oneof![
        any::<u8>().prop_map(Change::Flip),
        (1usize..9).prop_map(Change::Cut),
        (1usize..40).prop_map(Change::Double),
        prop::sample::select(words.to_vec()).prop_map(Change::Word),
        prop::sample::select(words.to_vec()).prop_map(Change::Word),
        Just(Change::Truncate),
    ]
}

fn changes() -> impl Strategy<Value = Vec<(prop::sample::Index, Change)>> {
    prop::collection::vec((any::<prop::sample::Index>(), change()), 1..4)
}

fn mutated(original: &[u8], changes: &[(prop::sample::Index, Change)]) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for (place, change) in changes.iter().filter(|_| !original.is_empty()) {
        if bytes.is_empty() {
            break;
        }
        let at = place.index(bytes.len());
        let upto = |length: usize| (at + length).min(bytes.len());
        match change {
            Change::Flip(mask) => bytes[at] ^= mask,
            Change::Cut(length) => drop(bytes.drain(at..upto(*length))),
            Change::Double(length) => {
                let copy = bytes[at..upto(*length)].to_vec();
                bytes.splice(at..at, copy);
            }
            Change::Word(word) => {
                // The number or name at this place gives way to the word.
                let inside = |byte: &&u8| byte.is_ascii_alphanumeric() || b".-".contains(byte);
                let length = bytes[at..].iter().take_while(inside).count();
                drop(bytes.splice(at..at + length, word.bytes()));
            }
            Change::Truncate => bytes.truncate(at),
        }
    }
    bytes
}

/// What every loaded scene promises.
fn assert_sound(scene: &Scene) {
    assert!(!scene.faces.is_empty());
    assert!(scene.positions.iter().all(|p| p.is_finite()));
    for face in &scene.faces {
        let count = face.vertices.len();
        assert!(count >= 3);
        assert!(face.vertices.iter().all(|&vertex| (vertex as usize) < scene.positions.len()));
        assert!([0, count].contains(&face.normals.len()) && [0, count].contains(&face.uvs.len()));
        assert!(face.normals.iter().all(|normal| normal.is_normalized()));
        assert!(face.uvs.iter().all(|uv| uv.is_finite()));
        let is_share = |tint: &glam::Vec3| tint.min_element() >= 0.0 && tint.max_element() <= 1.0;
        assert!(face.tints.iter().all(is_share));
        assert!((face.material.index()) < scene.materials.len());
        assert!((face.object as usize) < scene.objects.len());
    }
    for material in &scene.materials {
        let (low, high) = (material.reflectance.min_element(), material.reflectance.max_element());
        assert!(low >= 0.0 && high <= MAX_REFLECTANCE, "{material:?}");
        assert!(material.emission.is_finite() && material.emission.min_element() >= 0.0);
        for texture in material.texture.iter().chain(&material.emission_texture) {
            assert!((*texture as usize) < scene.textures.len());
        }
    }
    for texture in &scene.textures {
        assert_eq!(texture.texels.len(), texture.width as usize * texture.height as usize);
        assert!(texture.texels.iter().flatten().all(|x| x.is_finite() && x >= 0.0));
    }
    scene.lights.iter().for_each(|named| assert_sound_light(&named.light));
    for camera in &scene.cameras {
        assert!(camera.eye.is_finite() && camera.target.is_finite() && camera.up.is_finite());
        assert!((camera.target - camera.eye).cross(camera.up).length() > 0.0);
    }
}

fn assert_sound_light(light: &Light) {
    let (place, direction, strength) = match *light {
        Light::Point { position, intensity, .. } => (position, glam::DVec3::X, intensity),
        Light::Spot { position, direction, intensity, inner_angle, outer_angle, .. } => {
            assert!(0.0 <= inner_angle && inner_angle < outer_angle && outer_angle < 1.6);
            (position, direction, intensity)
        }
        Light::Directional { direction, irradiance } => (glam::DVec3::ZERO, direction, irradiance),
        Light::Luminaire { .. } | Light::Sun { .. } | Light::Sky { .. } => {
            panic!("no such light is in glTF files")
        }
    };
    assert!(place.is_finite() && direction.is_normalized(), "{light:?}");
    assert!(strength.is_finite() && strength.min_element() >= 0.0, "{light:?}");
}

fn check(folder: &Folder, name: &str) {
    match folder.load(name) {
        Ok(scene) => assert_sound(&scene),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

#[test]
fn unbroken_originals_are_read() {
    let folder = Folder::new()
        .with("s.obj", OBJ)
        .with("m.mtl", MTL)
        .with("red.png", red_png())
        .with("a.gltf", ASSET.text())
        .with("a.glb", ASSET.glb());
    for name in ["s.obj", "a.gltf", "a.glb"] {
        let scene = folder.load(name).unwrap();
        assert_sound(&scene);
        assert!(!scene.textures.is_empty() && scene.is_lit(), "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, ..ProptestConfig::default() })]

    #[test]
    fn broken_obj_files_never_panic(obj in changes(), mtl in changes(), which in 0..3) {
        let untouched = Vec::new();
        let (obj, mtl) = match which {
            0 => (obj, mtl),
            1 => (obj, untouched),
            _ => (untouched, mtl),
        };
        let folder = Folder::new()
            .with("s.obj", mutated(OBJ.as_bytes(), &obj))
            .with("m.mtl", mutated(MTL.as_bytes(), &mtl))
            .with("red.png", red_png());
        check(&folder, "s.obj");
    }

    #[test]
    fn broken_gltf_files_never_panic(changes in changes()) {
        let text = mutated(ASSET.text().as_bytes(), &changes);
        check(&Folder::new().with("a.gltf", text).with("red.png", red_png()), "a.gltf");
    }

    #[test]
    fn broken_glb_files_never_panic(changes in changes()) {
        let bytes = mutated(&ASSET.glb(), &changes);
        check(&Folder::new().with("a.glb", bytes).with("red.png", red_png()), "a.glb");
    }

    #[test]
    fn broken_pictures_never_panic(changes in changes()) {
        let folder = Folder::new()
            .with("s.obj", OBJ)
            .with("m.mtl", MTL)
            .with("red.png", mutated(&red_png(), &changes));
        check(&folder, "s.obj");
    }
}
