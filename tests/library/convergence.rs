//! Finer settings give smaller errors, and adaptive meshes smaller ones than uniform meshes of their size.

use crate::common::{
    Block, Stage, coarse, corners, furnished_room, mesh_of, radiosities, shipped, solve,
};
use glam::{DVec2, DVec3};
use radiosity::direct::Emitters;
use radiosity::geometry::polygon::edges;
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
            let weights =
                [(b, c), (c, a), (a, b)].map(|(p, q)| (p - place).perp_dot(q - place) / area);
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

/// The exact radiosity of a floor of 3 × 3 m and reflectance 0.6 that sees direct light only.
fn floor_truth(scene: &Scene) -> Vec<(DVec2, f64)> {
    let surfaces = surfaces_of(scene);
    let emitters = Emitters::new(&surfaces, &Mesh::new(&surfaces, &coarse()));
    let occluders = Occluders::new(&surfaces);
    let radiosity = |place: DVec2| {
        let site = DVec3::new(place.x, 0.0, place.y);
        (place, 0.6 * emitters.shine(&occluders, site, DVec3::Y).irradiance.x)
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
    let truth = floor_truth(&scene);
    let error = |tolerance| Floor::of(&mesh_of(&scene, &adaptive(tolerance))).error(&truth);
    let errors = [0.4, 0.05, 0.00625].map(error);
    assert!(errors[1] < 0.6 * errors[0] && errors[2] < 0.6 * errors[1], "{errors:?} W/m²");
}

#[test]
fn error_falls_with_the_size_of_uniform_elements() {
    let scene = shipped("blocker.obj");
    let truth = floor_truth(&scene);
    let error = |size| Floor::of(&mesh_of(&scene, &uniform(size))).error(&truth);
    let errors = [0.4, 0.2, 0.1, 0.05].map(error);
    assert!(errors.windows(2).all(|pair| pair[1] < 0.6 * pair[0]), "{errors:?} W/m²");
}

/// The blocker scene with a smaller lamp and a lower blocker: a sharper shadow.
fn sharp_shadow() -> Scene {
    let mut stage = Stage::default();
    let (floor, black, light) =
        (stage.material(0.6, 0.0), stage.material(0.0, 0.0), stage.material(0.0, 200.0));
    let corners = [(-1.5, -1.5), (-1.5, 1.5), (1.5, 1.5), (1.5, -1.5)];
    stage.polygon(floor, &corners.map(|(x, z)| DVec3::new(x, 0.0, z)));
    stage.lamp(light, DVec3::new(-0.1, 2.4, -0.1), DVec3::new(0.1, 2.4, 0.1));
    let size = DVec3::new(0.7, 0.01, 0.6);
    stage.block(black, Block { base: DVec3::new(0.1, 0.5, 0.2), size, turn: 0.5 });
    stage.scene
}

/// Errors of an adaptive and a uniform mesh over the floor, W/m², and their numbers of triangles there.
fn contest(scene: &Scene, tolerance: f64, size: f64) -> [(f64, usize); 2] {
    let truth = floor_truth(scene);
    [adaptive(tolerance), uniform(size)].map(|settings| {
        let floor = Floor::of(&mesh_of(scene, &settings));
        (floor.error(&truth), floor.0.len())
    })
}

#[test]
fn an_adaptive_mesh_costs_little_where_light_is_smooth() {
    let [adaptive, uniform] = contest(&shipped("blocker.obj"), 0.05, 0.1);
    // Both errors fall as one over the number of triangles, so the products compare meshes of any
    // two sizes. A penumbra as wide as a third of the floor leaves nothing to adapt to.
    let cost = |(error, triangles): (f64, usize)| error * triangles as f64;
    assert!(cost(adaptive) < 1.15 * cost(uniform), "{adaptive:?} against {uniform:?}");
}

#[test]
fn an_adaptive_mesh_needs_less_than_half_the_triangles_where_shadows_are_sharp() {
    let [adaptive, uniform] = contest(&sharp_shadow(), 0.05, 0.05);
    assert!(2 * adaptive.1 <= uniform.1, "{adaptive:?} against {uniform:?}");
    assert!(adaptive.0 <= uniform.0, "{adaptive:?} against {uniform:?}");
}

/// Whether all elements of the blocker's floor are rectangles along its borders.
fn is_quadtree(settings: &Settings) -> bool {
    let surfaces = surfaces_of(&shipped("blocker.obj"));
    let mesh = solve(&surfaces, settings).mesh;
    let outlines = mesh.leaves().map(|leaf| (mesh.surface_of(leaf), mesh.outline(leaf)));
    let along = |[a, b]: [DVec2; 2]| (b - a).abs().min_element() < 1e-9;
    let mut floor = outlines.filter(|&(surface, _)| surfaces[surface].plane.origin.y == 0.0);
    floor.all(|(_, outline)| outline.len() == 4 && edges(&outline).all(along))
}

#[test]
fn elements_are_cut_askew_along_discontinuity_lines_only() {
    let without = Settings { discontinuity_lines: false, ..adaptive(0.1) };
    assert!(is_quadtree(&without) && !is_quadtree(&adaptive(0.1)));
}

#[test]
fn more_rays_to_a_lamp_come_closer_to_its_exact_light() {
    let surfaces = surfaces_of(&shipped("blocker.obj"));
    let exact = Emitters::new(&surfaces, &Mesh::new(&surfaces, &coarse()));
    let occluders = Occluders::new(&surfaces);
    let shine = |emitters: &Emitters, place: DVec2| {
        emitters.shine(&occluders, DVec3::new(place.x, 0.0, place.y), DVec3::Y).irradiance.x
    };
    let error = |rays: u32| {
        let sampled = exact.clone().seen_by(Some(rays));
        let difference = |place| (shine(&sampled, place) - shine(&exact, place)).powi(2);
        let places = places(DVec2::splat(-1.2), DVec2::splat(1.2), 500);
        (places.map(difference).sum::<f64>() / 500.0).sqrt()
    };
    let errors = [4, 64, 1024].map(error);
    assert!(errors[2] > 0.0, "rays see no exact light");
    assert!(errors.windows(2).all(|pair| pair[1] < 0.5 * pair[0]), "{errors:?} W/m²");
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
