//! STL: what it says, and how it lies.

use glam::DVec3;
use radiosity::Scene;

use super::Folder;

const TRIANGLES: [[[f32; 3]; 3]; 2] =
    [[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.]], [[0., 0., 0.], [1., 1., 0.], [0., 1., 0.]]];

fn binary(header: &str, claimed: u32) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend(claimed.to_le_bytes());
    for corners in TRIANGLES {
        let numbers = [0.0; 3].into_iter().chain(corners.into_iter().flatten());
        bytes.extend(numbers.flat_map(f32::to_le_bytes).chain([0, 0]));
    }
    bytes
}

fn text() -> String {
    let facet = |corners: [[f32; 3]; 3]| {
        let vertex = corners.map(|[x, y, z]| format!("   vertex {x} {y} {z}\n")).concat();
        format!(" facet normal 0 0 1\n  outer loop\n{vertex}  endloop\n endfacet\n")
    };
    let [a, b] = TRIANGLES.map(facet);
    format!("solid my wall\n{a}endsolid my wall\nsolid lamp\n{b}endsolid lamp\n")
}

fn load(file: impl AsRef<[u8]>) -> radiosity::Result<Scene> {
    Folder::new().with("a.stl", file).load("a.stl")
}

#[test]
fn binary_and_text_hold_the_same_triangles() {
    let loud = text().to_uppercase().replace('\n', "\r");
    for file in [binary("solid by a program", 2), binary("", 2), text().into(), loud.into()] {
        let scene = load(file).unwrap();
        assert_eq!((scene.faces.len(), scene.positions.len()), (2, 4));
        assert_eq!(scene.faces[1].corners_in(&scene), [[0., 0., 0.], [1., 1., 0.], [0., 1., 0.]]);
        assert_eq!(scene.materials[0].reflectance, DVec3::splat(0.5));
        assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    }
    let scene = load(text()).unwrap();
    assert_eq!(scene.objects, ["my wall", "lamp"]);
    assert_eq!(scene[scene.faces[1].material].name, "lamp");
}

#[test]
fn files_that_lie_are_refused() {
    let error = |file: Vec<u8>| load(file).unwrap_err().to_string();
    let claimed = error(binary("", 4_000_000_000));
    assert!(claimed.contains("4000000000") && claimed.contains("room for 2"), "{claimed}");
    assert!(error(binary("", 2)[..120].to_vec()).contains("room for 0"));
    assert!(error(b"x".to_vec()).contains("too short"));
    assert!(error(text().replace("vertex 1 0 0", "vertex 1 x 0").into()).contains("a.stl:5"));
    assert!(error(text().replacen("   vertex 1 0 0\n", "", 1).into()).contains("of 2 corners"));
    assert!(error(text()[..text().rfind("  endloop").unwrap()].into()).contains("within a facet"));
    assert!(error(b"solid x\nendsolid x\n".to_vec()).contains("no faces"));
}

/// Where a face's corners are.
trait Corners {
    fn corners_in(&self, scene: &Scene) -> Vec<[f64; 3]>;
}

impl Corners for radiosity::scene::Face {
    fn corners_in(&self, scene: &Scene) -> Vec<[f64; 3]> {
        self.vertices.iter().map(|&v| scene.positions[v as usize].to_array()).collect()
    }
}
