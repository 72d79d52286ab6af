//! Scenes built in code, and measurements on solved meshes, shared by the tests.
#![allow(dead_code, unreachable_pub, reason = "no test uses all of it")]

use std::ops::ControlFlow;
use std::path::Path;

use glam::DVec3;
use radiosity::scene::{Face, LoadOptions};
use radiosity::{Length, Scene, Settings, Solution, Surfaces, TriMesh};

mod stage;

use stage::between;
pub use stage::{Block, Stage};

/// A closed room of 4 × 3 × 5 m with a lamp hanging in it, and blocks.
pub fn furnished_room(blocks: &[Block]) -> Scene {
    let mut stage = Stage::default();
    let (wall, box_, dark, light) = (
        stage.material(0.6, 0.0),
        stage.material(0.4, 0.0),
        stage.material(0.0, 0.0),
        stage.material(0.0, 10.0),
    );
    stage.room(wall, DVec3::ZERO, DVec3::new(4.0, 3.0, 5.0));
    stage.lamp(light, DVec3::new(1.5, 2.8, 2.0), DVec3::new(2.5, 2.8, 3.0));
    let lid = [0, 4, 5, 1];
    let (low, high) = (DVec3::new(1.5, 2.8, 2.0), DVec3::new(2.5, 2.8, 3.0));
    stage.polygon(dark, &lid.map(|corner| between(low, high, corner)));
    for &block in blocks {
        stage.block(box_, block);
    }
    stage.scene
}

/// One of the scenes that come with the project.
pub fn shipped(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
    radiosity::load(&path, &LoadOptions::default()).unwrap()
}

/// Quick settings: large patches, few levels.
pub fn coarse() -> Settings {
    Settings {
        tolerance: 0.1,
        max_level: 3,
        min_element: Length::OfScene(1.0 / 100.0),
        patch_size: Length::OfScene(1.0 / 6.0),
        hemicube_resolution: 64,
        ..Settings::medium()
    }
}

/// A solution without a watcher.
pub fn solve(surfaces: &Surfaces, settings: &Settings) -> Solution {
    radiosity::solve(surfaces, settings, |_| ControlFlow::Continue(())).unwrap()
}

/// The triangle mesh of a scene.
pub fn mesh_of(scene: &Scene, settings: &Settings) -> TriMesh {
    let surfaces = radiosity::surfaces_of(scene);
    radiosity::reconstruct(&surfaces, &solve(&surfaces, settings))
}

/// Area of a scene's faces, both sides of double-sided ones, m².
pub fn area_of(scene: &Scene) -> f64 {
    let area = |face: &Face| {
        let at = |k: usize| scene.positions[face.vertices[k] as usize];
        let fan = (1..face.vertices.len() - 1).map(|k| (at(k) - at(0)).cross(at(k + 1) - at(0)));
        let sides = if scene[face.material].double_sided { 2.0 } else { 1.0 };
        sides * fan.sum::<DVec3>().length() / 2.0
    };
    scene.faces.iter().map(area).sum()
}

/// Corners of a triangle, m.
pub fn corners(mesh: &TriMesh, triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.map(|vertex| mesh.positions[vertex as usize])
}

/// Area of a triangle, m².
pub fn triangle_area([a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length() / 2.0
}

/// Radiosity of a triangle's corners, the mean of the channels, W/m².
pub fn radiosities(mesh: &TriMesh, triangle: [u32; 3]) -> [f64; 3] {
    triangle.map(|vertex| mesh.radiosity[vertex as usize].element_sum() / 3.0)
}

/// Mean radiosity over a mesh, W/m².
pub fn mean_radiosity(mesh: &TriMesh) -> f64 {
    let (power, area) = mesh.triangles.iter().fold((0.0, 0.0), |(power, area), &triangle| {
        let own = triangle_area(corners(mesh, triangle));
        (power + own * radiosities(mesh, triangle).iter().sum::<f64>() / 3.0, area + own)
    });
    power / area
}

/// Asserts that light is a number and not negative at every vertex.
pub fn assert_sane(mesh: &TriMesh) {
    assert!(!mesh.triangles.is_empty(), "a mesh has triangles");
    for (position, radiosity) in mesh.positions.iter().zip(&mesh.radiosity) {
        assert!(position.is_finite(), "{position}");
        assert!(radiosity.is_finite() && radiosity.min_element() >= 0.0, "{radiosity}");
    }
}
