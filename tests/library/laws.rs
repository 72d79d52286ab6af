//! Laws of light that hold in every scene, whatever the mesh.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crate::common::{
    Block, Stage, assert_sane, coarse, corners, furnished_room, mean_radiosity, mesh_of,
    radiosities, shipped, solve,
};
use glam::{DMat3, DVec3};
use radiosity::scene::MaterialId;
use radiosity::{Length, Scene, Settings, TriMesh, surfaces_of};

const ROOM: (DVec3, DVec3) = (DVec3::ZERO, DVec3::new(1.0, 1.5, 2.0));

/// A closed room in which everything reflects `reflectance` and emits 1 W/m².
fn furnace(reflectance: f64, block: Option<Block>) -> Scene {
    let mut stage = Stage::default();
    let glowing = stage.material(reflectance, 1.0 / PI);
    stage.room(glowing, ROOM.0, ROOM.1);
    if let Some(block) = block {
        stage.block(glowing, block);
    }
    stage.scene
}

/// Asserts that every vertex that `shows` says is in the light has the furnace's radiosity.
fn assert_glows(scene: &Scene, reflectance: f64, shows: impl Fn(DVec3) -> bool) {
    let (error, place) = worst_glow(scene, reflectance, shows);
    assert!(error <= 0.005, "off by {error} at {place}");
}

/// The largest share by which a vertex misses the furnace's radiosity, and where.
fn worst_glow(scene: &Scene, reflectance: f64, shows: impl Fn(DVec3) -> bool) -> (f64, DVec3) {
    let mesh = mesh_of(scene, &coarse());
    let expected = 1.0 / (1.0 - reflectance);
    let vertices = mesh.positions.iter().zip(&mesh.radiosity).filter(|(p, _)| shows(**p));
    let error = |(&place, &radiosity): (&DVec3, &DVec3)| {
        ((radiosity / expected - DVec3::ONE).abs().max_element(), place)
    };
    vertices.map(error).max_by(|a, b| a.0.total_cmp(&b.0)).expect("something shows")
}

#[test]
fn furnace_glows_at_e_over_one_minus_rho() {
    for reflectance in [0.0, 0.3, 0.7, 0.9] {
        assert_glows(&furnace(reflectance, None), reflectance, |_| true);
    }
}

#[test]
fn furnace_glows_alike_on_a_box_that_floats_in_it() {
    let block = Block { base: DVec3::new(0.5, 0.5, 1.1), size: DVec3::splat(0.4), turn: 0.4 };
    assert_glows(&furnace(0.6, Some(block)), 0.6, |_| true);
}

#[test]
fn furnace_glows_alike_around_a_box_that_stands_in_it() {
    let size = DVec3::new(0.4, 0.7, 0.5);
    let block = Block { base: DVec3::new(0.45, 0.0, 1.2), size, turn: 0.3 };
    let is_under = |p: DVec3| p.y == 0.0 && block.covers(p, -1e-6);
    assert_glows(&furnace(0.6, Some(block)), 0.6, |p| !is_under(p));
}

/// Facets of curved surfaces send and receive in groups.
#[test]
fn furnace_glows_alike_around_a_ball_of_many_facets() {
    let mut stage = Stage { scene: furnace(0.6, None) };
    stage.ball(MaterialId(0), DVec3::new(0.5, 0.6, 1.1), 0.3);
    let (error, place) = worst_glow(&stage.scene, 0.6, |_| true);
    assert!(error <= 0.015, "off by {error} at {place}");
}

#[test]
fn what_is_emitted_is_absorbed_or_escapes() {
    let mut ball = Stage { scene: furnished_room(&some_blocks()) };
    let white = ball.material(0.7, 0.0);
    ball.ball(white, DVec3::new(1.2, 1.6, 3.6), 0.4);
    let scenes = [
        ("ball", ball.scene),
        ("cornell-box", shipped("cornell-box.obj")),
        ("two-rooms", shipped("two-rooms.obj")),
        ("blocker", shipped("blocker.obj")),
        ("furnished", furnished_room(&some_blocks())),
    ];
    for (name, scene) in scenes {
        let settings = Settings { patch_size: Length::OfScene(1.0 / 14.0), ..coarse() };
        let solution = solve(&surfaces_of(&scene), &settings);
        let imbalance = solution.energy.imbalance();
        assert!(imbalance.abs() <= 0.005, "{name}: {imbalance}, {:?}", solution.energy);
    }
}

fn some_blocks() -> [Block; 3] {
    [
        Block { base: DVec3::new(1.2, 0.0, 1.3), size: DVec3::new(0.8, 1.2, 0.7), turn: 0.5 },
        Block { base: DVec3::new(2.9, 0.0, 3.3), size: DVec3::new(0.9, 0.6, 1.1), turn: -0.2 },
        Block { base: DVec3::new(3.2, 1.5, 1.0), size: DVec3::new(0.5, 0.4, 0.3), turn: 1.0 },
    ]
}

#[test]
fn twice_the_emission_is_exactly_twice_the_light() {
    let scene = furnished_room(&some_blocks());
    let mut brighter = scene.clone();
    for material in &mut brighter.materials {
        material.emission *= 2.0;
    }
    let [once, twice] = [scene, brighter].map(|scene| mesh_of(&scene, &coarse()));
    assert_eq!(once.triangles, twice.triangles);
    let doubled: Vec<DVec3> = once.radiosity.iter().map(|&b| b * 2.0).collect();
    assert_eq!(doubled, twice.radiosity);
}

fn moved(scene: &Scene, change: impl Fn(DVec3) -> DVec3) -> Scene {
    let positions = scene.positions.iter().map(|&p| change(p)).collect();
    Scene { positions, ..scene.clone() }
}

#[test]
fn light_is_exactly_the_same_in_units_that_are_powers_of_two() {
    let scene = furnished_room(&some_blocks());
    let here = mesh_of(&scene, &coarse());
    for scale in [1024.0, 1.0 / 1024.0] {
        let there = mesh_of(&moved(&scene, |p| p * scale), &coarse());
        assert_eq!(here.triangles, there.triangles, "triangles at scale {scale}");
        assert_eq!(here.radiosity, there.radiosity, "radiosities at scale {scale}");
    }
}

/// Asserts that two meshes of about as many triangles, within a share `slack` of them, carry the
/// same light.
fn assert_alike(here: &TriMesh, there: &TriMesh, slack: f64) {
    let count = there.triangles.len() as f64 / here.triangles.len() as f64;
    assert!((count - 1.0).abs() <= slack, "{count} times the triangles");
    let share = mean_radiosity(there) / mean_radiosity(here);
    // Another mesh of the same coarseness is as far from the truth, in another way.
    assert!((share - 1.0).abs() < 2e-3, "{share} times the light");
    let brightest = |mesh: &TriMesh| mesh.radiosity.iter().map(|b| b.x).fold(0.0, f64::max);
    let share = brightest(there) / brightest(here);
    assert!((share - 1.0).abs() < 0.01, "{share} times as bright");
}

#[test]
fn light_does_not_depend_on_the_unit_of_length() {
    let scene = furnished_room(&some_blocks());
    let here = mesh_of(&scene, &coarse());
    for scale in [1000.0, 0.001] {
        assert_alike(&here, &mesh_of(&moved(&scene, |p| p * scale), &coarse()), 0.01);
    }
}

#[test]
fn light_does_not_depend_on_where_the_scene_is() {
    let scene = furnished_room(&some_blocks());
    let away = moved(&scene, |p| p + DVec3::new(100.0, -70.0, 30.0));
    assert_alike(&mesh_of(&scene, &coarse()), &mesh_of(&away, &coarse()), 0.01);
}

#[test]
fn light_does_not_depend_on_which_way_the_scene_is_turned() {
    let scene = furnished_room(&some_blocks());
    let rotation = DMat3::from_axis_angle(DVec3::new(0.3, 0.5, -0.8).normalize(), 0.7);
    // Lengths as shares of the scene would follow its bounding box.
    let (patch_size, min_element) = (Length::Metres(1.2), Length::Metres(0.07));
    let settings = Settings { patch_size, min_element, ..coarse() };
    let here = mesh_of(&scene, &settings);
    let there = mesh_of(&moved(&scene, |p| rotation * p), &settings);
    // Errors count by size as a share of the scene's extent, which turns with its bounding box.
    assert_alike(&here, &there, 0.2);
}

#[test]
fn light_is_a_number_and_not_negative() {
    for name in ["cornell-box.obj", "office.obj", "two-rooms.obj", "blocker.obj"] {
        assert_sane(&mesh_of(&shipped(name), &Settings { max_level: 1, ..coarse() }));
    }
}

/// Asserts that triangles whose middle is `hidden` are dark, and that there are such, and lit ones.
fn assert_dark(mesh: &TriMesh, hidden: impl Fn(DVec3) -> bool) {
    let limit = 1e-9 * mean_radiosity(mesh);
    let (mut dark, mut lit) = (0, 0);
    for &triangle in &mesh.triangles {
        let middle = corners(mesh, triangle).iter().sum::<DVec3>() / 3.0;
        let brightest = radiosities(mesh, triangle).into_iter().fold(0.0, f64::max);
        if hidden(middle) {
            assert!(brightest <= limit, "{brightest} W/m² at {middle}");
            dark += 1;
        } else {
            lit += usize::from(brightest > limit);
        }
    }
    assert!(dark > 0 && lit > 0, "{dark} dark and {lit} lit triangles");
}

#[test]
fn no_light_under_a_box_on_the_floor() {
    let blocks = some_blocks();
    let mesh = mesh_of(&furnished_room(&blocks), &coarse());
    let is_under = |p: DVec3| p.y.abs() < 1e-6 && blocks[..2].iter().any(|b| b.covers(p, 0.0));
    assert_dark(&mesh, is_under);
}

#[test]
fn no_light_inside_a_closed_solid() {
    let mut stage = Stage { scene: furnished_room(&[]) };
    let both = stage.double_sided(0.8, 0.0);
    let size = DVec3::new(0.8, 1.2, 0.7);
    stage.block(both, Block { base: DVec3::new(1.2, 0.4, 1.3), size, turn: 0.5 });
    let mesh = mesh_of(&stage.scene, &coarse());
    let middle = DVec3::new(1.2, 1.0, 1.3);
    let limit = 1e-9 * mean_radiosity(&mesh);
    let mut inward = 0;
    for &triangle in &mesh.triangles {
        let [a, b, c] = corners(&mesh, triangle);
        if a.distance(middle) < 0.9 && (b - a).cross(c - a).dot(middle - a) > 0.0 {
            inward += 1;
            assert!(radiosities(&mesh, triangle).iter().all(|&b| b <= limit), "light at {a}");
        }
    }
    assert!(inward >= 12, "{inward} triangles face inward");
}

/// Two rooms of 2 × 2 × 2 m under one ceiling, on one floor; a lamp in the first, and no wall between yet.
fn rooms() -> (Stage, MaterialId) {
    let mut stage = Stage::default();
    let (white, light) = (stage.material(0.7, 0.0), stage.material(0.0, 10.0));
    stage.room(white, DVec3::ZERO, DVec3::new(4.1, 2.0, 2.0));
    stage.lamp(light, DVec3::new(0.6, 1.9, 0.6), DVec3::new(1.4, 1.9, 1.4));
    (stage, white)
}

#[test]
fn no_light_behind_a_thick_wall() {
    let (mut stage, white) = rooms();
    stage.block(white, Block::spanning(DVec3::new(2.0, 0.0, 0.0), DVec3::new(2.1, 2.0, 2.0)));
    assert_dark(&mesh_of(&stage.scene, &coarse()), |p| p.x > 2.05);
}

#[test]
fn no_light_behind_a_wall_without_thickness() {
    let (mut stage, _) = rooms();
    let both = stage.double_sided(0.7, 0.0);
    let panel = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
    stage.polygon(both, &panel.map(|(y, z)| DVec3::new(2.0, y, z)));
    assert_dark(&mesh_of(&stage.scene, &coarse()), |p| p.x > 2.0 + 1e-9);
}

#[test]
fn a_panel_of_two_faces_back_to_back_is_a_double_sided_panel() {
    let corners = [(0.0, 0.4), (2.0, 0.4), (2.0, 1.6), (0.0, 1.6)];
    let mut corners = corners.map(|(y, z)| DVec3::new(2.0, y, z));
    let ((mut one, _), (mut two, white)) = (rooms(), rooms());
    let both = one.double_sided(0.7, 0.0);
    one.polygon(both, &corners);
    two.polygon(white, &corners);
    corners.reverse();
    two.polygon(white, &corners);
    let [one, two] = [one, two].map(|stage| mean_radiosity(&mesh_of(&stage.scene, &coarse())));
    assert!((one / two - 1.0).abs() < 0.005, "{one} and {two} W/m²");
}

#[test]
fn stages_are_what_a_limit_of_shots_leaves_and_lead_to_the_same_end() {
    let surfaces = surfaces_of(&furnished_room(&[]));
    let go_on = |_: &radiosity::solver::Progress| ControlFlow::Continue(());
    let plan = radiosity::Plan { snapshots: &[0, 3, 20, 1_000_000], ..Default::default() };
    let (end, stages) = radiosity::solve_with(&surfaces, &coarse(), plan, go_on).unwrap();
    let found: Vec<usize> = stages.iter().map(radiosity::Solution::reflected_shots).collect();
    assert_eq!(found, [0, 3, 20], "what is never reached is left out");
    let light =
        |solution: &radiosity::Solution| radiosity::reconstruct(&surfaces, solution).radiosity;
    for stage in &stages {
        let limited = Settings { max_shots: Some(stage.shots), ..coarse() };
        let alone = solve(&surfaces, &limited);
        assert_eq!(light(stage), light(&alone));
        assert!(stage.energy.imbalance().abs() < 0.005 && stage.ambient.min_element() > 0.0);
    }
    let unshot: Vec<f64> =
        stages.iter().chain([&end]).map(|stage| stage.energy.unshot_share()).collect();
    assert!(unshot.is_sorted_by(|more, less| more > less), "{unshot:?}");
    assert_eq!(light(&end), light(&solve(&surfaces, &coarse())));
}

#[test]
fn a_scene_in_coordinates_of_a_national_grid_is_lit_as_at_the_origin() {
    let here = shipped("cornell-box.obj");
    let mut far = here.clone();
    let away = DVec3::new(448_262.0, 35.0, -5_411_932.0);
    far.positions.iter_mut().for_each(|place| *place += away);
    let [here, far] = [here, far].map(|scene| mesh_of(&scene, &coarse()));
    let share = far.triangles.len() as f64 / here.triangles.len() as f64;
    assert!((share - 1.0).abs() < 0.01, "{share} times as many triangles");
    let share = mean_radiosity(&far) / mean_radiosity(&here);
    assert!((share - 1.0).abs() < 1e-3, "{share} times as bright");
}

/// What is out of the balance after no shot of reflected light and after many, as a share of the emitted power.
fn imbalances(scene: &Scene, settings: &Settings) -> [f64; 2] {
    let surfaces = surfaces_of(scene);
    let after = |shots: usize| {
        let settings = Settings { max_shots: Some(shots), ..settings.clone() };
        solve(&surfaces, &settings).energy.imbalance()
    };
    [after(0), after(1_500)]
}

/// Between the slats of a blind little arrives and much escapes, which links and hemicubes know differently well.
#[test]
fn shots_of_reflected_light_neither_lose_nor_make_any() {
    let settings = Settings { max_level: 1, hemicube_resolution: 32, ..Settings::draft() };
    let [before, after] = imbalances(&shipped("blind.obj"), &settings);
    assert!((after - before).abs() < 1e-10, "{before} before, {after} after");
}
