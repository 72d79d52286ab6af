//! What extensions compress is what it was before, as finely as it was kept. The files are one bowl of 72 triangles,
//! with normals, texture coordinates and colours, written by glTF-Transform with the official encoders.

use glam::{DVec3, Vec3};
use radiosity::scene::Scene;

use super::Folder;

const PLAIN: &[u8] = include_bytes!("packed/plain.glb");
const PACKED: [(&str, &[u8]); 5] = [
    ("Draco, Edgebreaker", include_bytes!("packed/draco.glb")),
    ("Draco, Edgebreaker by valence", include_bytes!("packed/draco-valence.glb")),
    ("Draco, sequential", include_bytes!("packed/draco-sequential.glb")),
    ("meshopt", include_bytes!("packed/meshopt.glb")),
    ("meshopt, filtered", include_bytes!("packed/meshopt-filtered.glb")),
];

/// A triangle's middle and the means of its normals, coordinates and tints.
#[derive(Debug)]
struct Triangle {
    middle: DVec3,
    front: DVec3,
    normal: Vec3,
    uv: glam::DVec2,
    tint: Vec3,
}

fn triangles(scene: &Scene) -> Vec<Triangle> {
    let triangle = |face: &radiosity::scene::Face| {
        let [a, b, c] = [0, 1, 2].map(|k| scene.positions[face.vertices[k] as usize]);
        Triangle {
            middle: (a + b + c) / 3.0,
            front: (b - a).cross(c - a).normalize(),
            normal: face.normals.iter().sum::<Vec3>() / 3.0,
            uv: face.uvs.iter().sum::<glam::DVec2>() / 3.0,
            tint: face.tints.iter().sum::<Vec3>() / 3.0,
        }
    };
    scene.faces.iter().map(triangle).collect()
}

fn load(bytes: &[u8]) -> radiosity::Result<Scene> {
    Folder::new().with("a.glb", bytes).load("a.glb")
}

#[test]
fn compressed_triangles_are_those_that_were_compressed() {
    let plain = load(PLAIN).unwrap();
    let notes = plain.notes.clone();
    let plain = triangles(&plain);
    assert_eq!(plain.len(), 72);
    for (name, bytes) in PACKED {
        let scene = load(bytes).unwrap();
        assert_eq!(scene.notes, notes, "{name}");
        let packed = triangles(&scene);
        assert_eq!(packed.len(), plain.len(), "{name}");
        for own in &plain {
            let distance = |other: &&Triangle| other.middle.distance(own.middle);
            let found = packed.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
            assert!(found.middle.distance(own.middle) < 5e-4, "{name}: {found:?} for {own:?}");
            assert!(found.front.distance(own.front) < 5e-3, "{name}: {found:?} for {own:?}");
            assert!(found.normal.distance(own.normal) < 1e-2, "{name}: {found:?} for {own:?}");
            assert!(found.uv.distance(own.uv) < 1e-3, "{name}: {found:?} for {own:?}");
            assert!(found.tint.distance(own.tint) < 1e-2, "{name}: {found:?} for {own:?}");
        }
    }
}

#[test]
fn streams_that_are_cut_off_or_promise_too_much_are_refused_by_name() {
    let changed = |bytes: &[u8], from: &str, to: &str| {
        let at = bytes.windows(from.len()).position(|part| part == from.as_bytes());
        let mut changed = bytes.to_vec();
        let at = at.expect("it is in the file");
        changed[at..at + from.len()].copy_from_slice(to.as_bytes());
        load(&changed).unwrap_err().to_string()
    };
    let draco = changed(PACKED[0].1, "DRACO", "DRACU");
    assert!(draco.contains("KHR_draco_mesh_compression"), "{draco}");
    let more = changed(PACKED[3].1, "4,\"count\":49", "4,\"count\":99");
    assert!(more.contains("EXT_meshopt_compression"), "{more}");
}
