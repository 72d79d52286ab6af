//! Finer settings give smaller errors, and adaptive meshes smaller ones than uniform meshes of their size.

mod common;

use common::{Block, coarse, corners, furnished_room, mesh_of, radiosities, shipped};
use glam::{DVec2, DVec3};
use radiosity::direct::Lamps;
use radiosity::mesh::Mesh;
use radiosity::visibility::Occluders;
use radiosity::{Length, Scene, Settings, TriMesh, surfaces_of};

/// A floor as seen from above: its triangles' corners and radiosities, W/m².
struct Floor(Vec<([DVec2; 3], [f64; 3])>);

impl Floor {
    fn of(mesh: &TriMesh) -> Self {
        let flat = |triangle: [u32; 3]| {
            let at = corners(mesh, triangle);
            let up = (at[1] - at[0]).cross(at[2] - at[0]).y > 0.0;
            let low = at.iter().all(|p| p.y.abs() < 1e-6);
            (up && low).then(|| (at.map(|p| DVec2::new(p.x, p.z)), radiosities(mesh, triangle)))
        };
        Self(mesh.triangles.iter().copied().filter_map(flat).collect())
    }

    /// Radiosity at a place, interpolated, W/m².
    fn at(&self, place: DVec2) -> Option<f64> {
        self.0.iter().find_map(|&([a, b, c], values)| {
            let area = (b - a).perp_dot(c - a);
            let weights = [(b, c), (c, a), (a, b)]
                .map(|(p, q)| (p - place).perp_dot(q - place) / area);
            let inside = weights.iter().all(|&w| w >= -1e-9);
            inside.then(|| weights.iter().zip(values).map(|(w, b)| w * b).sum())
        })
    }

    /// Root mean square difference from `truth`, W/m².
    fn error(&self, truth: &[(DVec2, f64)]) -> f64 {
        let squares = truth.iter().map(|&(place, b)| (self.at(place).unwrap() - b).powi(2));
        (squares.sum::<f64>() / truth.len() as f64).sqrt()
    }
}

/// Places spread evenly over a rectangle.
fn places(low: DVec2, high: DVec2, count: u32) -> impl Iterator<Item = DVec2> {
    (1..=count).map(move |k| {
        let share = DVec2::new(0.754_877_666, 0.569_840_291) * f64::from(k);
        low + (high - low) * share.fract()
    })
}

/// The exact radiosity of the blocker scene's floor, which sees direct light only.
fn blocker_truth(scene: &Scene) -> Vec<(DVec2, f64)> {
    let surfaces = surfaces_of(scene);
    let lamps = Lamps::new(&surfaces, &Mesh::new(&surfaces, &coarse()));
    let occluders = Occluders::new(&surfaces);
    let radiosity = |place: DVec2| {
        let site = DVec3::new(place.x, 0.0, place.y);
        (place, 0.6 * lamps.shine(&occluders, site, DVec3::Y).irradiance.x)
    };
    places(DVec2::splat(-1.499), DVec2::splat(1.499), 1500).map(radiosity).collect()
}

/// Settings that leave it to the tolerance where to stop.
fn adaptive(tolerance: f64) -> Settings {
    Settings { tolerance, max_level: 10, min_element: Length::OfScene(1e-4), ..coarse() }
}

fn uniform(size: f64) -> Settings {
    Settings { uniform: Some(size), ..coarse() }
}

#[test]
fn error_falls_with_the_tolerance() {
    let scene = shipped("blocker.obj");
    let truth = blocker_truth(&scene);
    let error = |tolerance| Floor::of(&mesh_of(&scene, &adaptive(tolerance))).error(&truth);
    let errors = [0.2, 0.05, 0.0125].map(error);
    assert!(errors[1] < 0.6 * errors[0] && errors[2] < 0.6 * errors[1], "{errors:?} W/m²");
}

#[test]
fn error_falls_with_the_size_of_uniform_elements() {
    let scene = shipped("blocker.obj");
    let truth = blocker_truth(&scene);
    let error = |size| Floor::of(&mesh_of(&scene, &uniform(size))).error(&truth);
    let errors = [0.4, 0.2, 0.1, 0.05].map(error);
    assert!(errors.windows(2).all(|pair| pair[1] < 0.6 * pair[0]), "{errors:?} W/m²");
}

#[test]
fn an_adaptive_mesh_needs_less_than_half_the_elements_of_a_uniform_one() {
    let scene = shipped("blocker.obj");
    let truth = blocker_truth(&scene);
    let adaptive = Floor::of(&mesh_of(&scene, &adaptive(0.03)));
    let uniform = Floor::of(&mesh_of(&scene, &uniform(0.05)));
    let (few, many) = (adaptive.0.len(), uniform.0.len());
    let (small, large) = (adaptive.error(&truth), uniform.error(&truth));
    assert!(2 * few <= many, "{few} triangles against {many}");
    assert!(small <= large, "{small} W/m² with {few} triangles, {large} with {many}");
}

#[test]
fn error_of_reflected_light_falls_with_tolerance_and_patches() {
    let size = DVec3::new(0.9, 1.2, 0.7);
    let scene = furnished_room(&[Block { base: DVec3::new(1.4, 0.0, 1.6), size, turn: 0.4 }]);
    let settings = |tolerance: f64, patches: f64| Settings {
        tolerance,
        max_level: 6,
        min_element: Length::OfScene(1.0 / 400.0),
        patch_size: Length::OfScene(1.0 / patches),
        hemicube_resolution: 128,
        ..coarse()
    };
    let floor = |settings: &Settings| Floor::of(&mesh_of(&scene, settings));
    let fine = floor(&settings(0.02, 14.0));
    let truth = |place| (place, fine.at(place).unwrap());
    let truth: Vec<(DVec2, f64)> =
        places(DVec2::splat(0.01), DVec2::new(3.99, 4.99), 1000).map(truth).collect();
    let errors = [settings(0.4, 4.0), settings(0.1, 8.0)].map(|s| floor(&s).error(&truth));
    assert!(errors[1] < 0.6 * errors[0], "{errors:?} W/m²");
}
