//! Laws of form factors and visibility, each against an independent measure.

mod cases;
mod matrix;

use std::f64::consts::PI;

use crate::common::{Block, Stage, coarse, furnished_room, solve};
use glam::DVec3;
use proptest::prelude::*;
use radiosity::direct::Emitters;
use radiosity::form_factor::contour::point_to_polygon;
use radiosity::form_factor::hemicube::{DeltaFactors, Hemicube, HemicubeScene, VisiblePatch};
use radiosity::geometry::HalfSpace;
use radiosity::mesh::Mesh;
use radiosity::visibility::{Occluders, SurfacePoint};
use radiosity::{Scene, surfaces_of};

fn point(range: f64) -> impl Strategy<Value = DVec3> {
    (-range..range, -range..range, -range..range).prop_map(DVec3::from)
}

/// A triangle well above the plane z = 0 and not too slender.
fn triangle() -> impl Strategy<Value = [DVec3; 3]> {
    (point(1.0), point(1.0), point(1.0))
        .prop_map(|(a, b, c)| [a, b, c].map(|p| p + DVec3::Z * 0.6))
        .prop_filter("slender", |[a, b, c]| (b - a).cross(c - a).length() > 0.2)
        .prop_filter("edge-on", |[a, b, c]| (b - a).cross(c - a).normalize().dot(*a).abs() > 0.05)
}

/// Nusselt's analogue: the share of the unit disc under the triangle's projection on the hemisphere.
fn by_nusselt([a, b, c]: [DVec3; 3]) -> f64 {
    const CELLS: i32 = 600;
    let at = |k: i32| (f64::from(k) + 0.5) / f64::from(CELLS) * 2.0 - 1.0;
    let normals = [a.cross(b), b.cross(c), c.cross(a)];
    let sign = (b - a).cross(c - a).dot(a).signum();
    let covers = |x: f64, y: f64| {
        let height = 1.0 - x * x - y * y;
        height > 0.0 && normals.iter().all(|n| n.dot(DVec3::new(x, y, height.sqrt())) * sign >= 0.0)
    };
    let count = (0..CELLS)
        .flat_map(|row| (0..CELLS).map(move |column| (at(column), at(row))))
        .filter(|&(x, y)| covers(x, y))
        .count();
    count as f64 * 4.0 / f64::from(CELLS).powi(2) / PI
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn contour_integral_is_the_area_of_the_projection_on_the_disc(corners in triangle()) {
        let exact = point_to_polygon(DVec3::ZERO, DVec3::Z, &corners);
        let measured = by_nusselt(corners);
        prop_assert!((exact - measured).abs() < 1e-3, "{exact} for {measured}");
    }

    #[test]
    fn parts_of_a_polygon_add_up(corners in triangle(), through in point(0.5), normal in point(1.0)) {
        let side = HalfSpace::new(through + DVec3::Z * 0.6, normal.normalize_or(DVec3::X));
        let whole = point_to_polygon(DVec3::ZERO, DVec3::Z, &corners);
        let parts = [side.clip(&corners), side.complement().clip(&corners)];
        let sum: f64 = parts.iter().map(|p| point_to_polygon(DVec3::ZERO, DVec3::Z, p)).sum();
        prop_assert!((whole - sum).abs() < 1e-9, "{whole} in one, {sum} in parts");
    }
}

#[test]
fn form_factors_between_polygons_are_reciprocal() {
    let square = |low: DVec3, a: DVec3, b: DVec3| [low, low + a, low + a + b, low + b];
    let first = square(DVec3::ZERO, DVec3::X, DVec3::Y * 0.7);
    let second =
        square(DVec3::new(0.4, -0.3, 1.0), DVec3::new(0.0, 1.4, 0.2), DVec3::new(0.9, 0.0, 0.5));
    let exchange = |[a, b, _, d]: [DVec3; 4], other: [DVec3; 4], inward: DVec3| {
        const CELLS: i32 = 60;
        let normal = (b - a).cross(d - a);
        let area = normal.length();
        let normal = normal.normalize() * normal.dot(inward - a).signum();
        let at = |k: i32| (f64::from(k) + 0.5) / f64::from(CELLS);
        let places =
            (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| a + (b - a) * at(i) + (d - a) * at(j)));
        let sum: f64 = places.map(|p| point_to_polygon(p, normal, &other)).sum();
        area * sum / f64::from(CELLS).powi(2)
    };
    let there = exchange(first, second, second[0]);
    let back = exchange(second, first, first[0]);
    assert!((there / back - 1.0).abs() < 1e-3, "{there} and {back} m²");
}

fn blocks() -> [Block; 2] {
    [
        Block { base: DVec3::new(1.2, 0.0, 1.3), size: DVec3::new(0.8, 1.2, 0.7), turn: 0.5 },
        Block { base: DVec3::new(2.9, 0.9, 3.3), size: DVec3::new(0.9, 0.6, 1.1), turn: -0.2 },
    ]
}

#[test]
fn what_a_point_sees_of_a_closed_room_adds_up_to_one() {
    let surfaces = surfaces_of(&furnished_room(&blocks()));
    let mesh = Mesh::new(&surfaces, &coarse());
    let occluders = Occluders::new(&surfaces);
    let delta = DeltaFactors::new(128);
    let targets = HemicubeScene::new(&mesh.patches);
    let mut hemicube = Hemicube::new(&delta, &targets, &occluders);
    for k in 0..40 {
        let share = |step: f64| 0.05 + 0.9 * (f64::from(k) * step).fract();
        let eye = DVec3::new(4.0 * share(0.618_034), 0.0, 5.0 * share(0.754_878));
        if blocks()[0].covers(eye, -0.05) {
            continue;
        }
        let hemicube = hemicube.look(SurfacePoint::new(eye, DVec3::Y), f64::from(k));
        let sights: Vec<VisiblePatch> = hemicube.visible_patches().collect();
        let factor =
            |patch: radiosity::mesh::PatchId| point_to_polygon(eye, DVec3::Y, &mesh[patch].corners);
        let exact: f64 = sights.iter().map(|s| s.visible * factor(s.patch)).sum();
        let cells: f64 = sights.iter().map(|s| s.delta).sum();
        assert!((exact - 1.0).abs() < 0.01, "{exact} seen from {eye}");
        assert!((cells - 1.0).abs() < 1e-4, "{cells} of the cells are filled at {eye}");
        assert!(sights.iter().all(|s| s.front), "a closed room shows no backs at {eye}");
        assert_eq!(hemicube.escaping(), 0.0, "nothing escapes at {eye}");
    }
}

/// Height of the source above the eyes, m.
const HEIGHT: f64 = 2.0;

fn source() -> [DVec3; 4] {
    [(-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.5, -0.5)].map(|(x, y)| DVec3::new(x, y, HEIGHT))
}

fn scene_of(triangles: &[[DVec3; 3]]) -> Scene {
    let mut stage = Stage::default();
    let black = stage.material(0.0, 0.0);
    for triangle in triangles {
        stage.polygon(black, triangle);
    }
    stage.scene
}

/// Whether a point of a plane z = const is inside a polygon, and `None` within `margin`, m, of its border.
fn is_inside(polygon: &[DVec3], point: DVec3, margin: f64) -> Option<bool> {
    let edge = |k: usize| {
        let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        (b - a).cross(point - a).z / (b - a).length().max(1e-300)
    };
    let area: f64 = (1..polygon.len() - 1)
        .map(|k| (polygon[k] - polygon[0]).cross(polygon[k + 1] - polygon[0]).z)
        .sum();
    let edges = (0..polygon.len()).filter(|&k| polygon[k] != polygon[(k + 1) % polygon.len()]);
    let inmost = edges.map(|k| edge(k) * area.signum()).fold(f64::INFINITY, f64::min);
    (inmost.abs() > margin).then_some(inmost > 0.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_ray_to_a_visible_piece_is_free_and_any_other_is_blocked(
        triangles in prop::collection::vec([point(1.0), point(1.0), point(1.0)], 1..8),
        x in -1.0..1.0, y in -1.0..1.0,
    ) {
        let triangles: Vec<[DVec3; 3]> = triangles
            .into_iter()
            .map(|corners| corners.map(|p| p + DVec3::Z * 1.2))
            .filter(|[a, b, c]| (b - a).cross(c - a).length() > 0.05)
            .collect();
        let occluders = Occluders::new(&surfaces_of(&scene_of(&triangles)));
        let eye = DVec3::new(x, y, 0.0);
        let pieces = occluders.visible_part(eye, &source(), DVec3::NEG_Z);
        let pieces = pieces.expect("few triangles do not crowd a shaft");
        const CELLS: i32 = 40;
        for cell in 0..CELLS * CELLS {
            let at = |k: i32| (f64::from(k) + 0.5) / f64::from(CELLS) - 0.5;
            let place = DVec3::new(at(cell % CELLS), at(cell / CELLS), HEIGHT);
            let inside: Option<Vec<bool>> =
                pieces.iter().map(|piece| is_inside(piece, place, 1e-4)).collect();
            let Some(inside) = inside else { continue };
            let count = inside.iter().filter(|&&inside| inside).count();
            prop_assert!(count <= 1, "{count} pieces overlap at {place}");
            // Nothing blocks on the source itself.
            let end = place - DVec3::Z * 1e-5;
            prop_assert_eq!(count == 1, !occluders.blocks(eye, end), "at {}", place);
        }
        if !occluders.may_be_hidden(eye, &source(), DVec3::NEG_Z) {
            prop_assert_eq!(pieces.len(), 1);
        }
    }
}

/// Seen from the floor, a wall whose foot is below it by rounding is hidden by what stands before it as any other.
#[test]
fn a_foot_below_the_horizon_by_rounding_hides_nothing_less() {
    let eye = SurfacePoint::new(DVec3::new(0.36, 0.0, 0.14), DVec3::Y);
    let screen = [(0.0, 0.25), (0.33, 0.25), (0.33, 0.42), (0.0, 0.42)];
    let screen = screen.map(|(y, z)| DVec3::new(0.423 + 0.3 * (z - 0.25), y, z));
    let occluders = Occluders::from_polygons(&[&screen], 1e-7);
    let visible = |foot: f64| -> f64 {
        let wall = [(foot, foot), (0.5488, 0.5592), (0.5488, 0.0)];
        let wall = wall.map(|(y, z)| DVec3::new(0.5528 + 0.0058 * y, y, z));
        let normal = (wall[1] - wall[0]).cross(wall[2] - wall[0]).normalize();
        let pieces = occluders.visible_pieces(eye.position, &eye.above().clip(&wall), normal);
        pieces.iter().map(|piece| point_to_polygon(eye.position, eye.normal, piece)).sum()
    };
    let exact = visible(0.0);
    for foot in [-4e-17, 3e-17, -1e-16] {
        assert!((visible(foot) - exact).abs() < 1e-9, "{} for {exact}", visible(foot));
    }
}

#[test]
fn direct_light_under_a_blocker_is_the_integral_over_the_lamp() {
    let mut stage = Stage::default();
    let (black, light) = (stage.material(0.0, 0.0), stage.material(0.0, 1.0 / PI));
    let floor = [(-2.0, -2.0), (-2.0, 2.0), (2.0, 2.0), (2.0, -2.0)];
    stage.polygon(black, &floor.map(|(x, z)| DVec3::new(x, 0.0, z)));
    stage.lamp(light, DVec3::new(-0.5, 2.0, -0.4), DVec3::new(0.5, 2.0, 0.4));
    stage.lamp(black, DVec3::new(-0.3, 1.0, -0.2), DVec3::new(0.4, 1.0, 0.3));
    let surfaces = surfaces_of(&stage.scene);
    let mesh = Mesh::new(&surfaces, &coarse());
    let (lamps, occluders) = (Emitters::new(&surfaces, &mesh), Occluders::new(&surfaces));
    let mut shadowed = 0;
    for k in 0..50 {
        let share = |step: f64| 2.0 * (f64::from(k) * step).fract() - 1.0;
        let place = DVec3::new(share(0.618_034), 0.0, share(0.754_878));
        let light = lamps.shine(&occluders, place, DVec3::Y);
        let (expected, all) = integral(place);
        assert!(
            (light.irradiance.x - expected).abs() < 2e-3 * all,
            "{light:?} for {expected} at {place}"
        );
        assert!((light.unoccluded.x - all).abs() < 1e-4 * all, "{light:?} for {all} at {place}");
        shadowed += usize::from(expected < 0.99 * all);
    }
    assert!(shadowed > 5, "{shadowed} places in shadow");
}

/// Irradiance from the lamp of exitance 1 W/m², with and without the blocker, by the midpoint rule.
fn integral(place: DVec3) -> (f64, f64) {
    const CELLS: i32 = 300;
    let at = |k: i32| (f64::from(k) + 0.5) / f64::from(CELLS) - 0.5;
    let (mut free, mut all) = (0.0, 0.0);
    for cell in 0..CELLS * CELLS {
        let to = DVec3::new(at(cell % CELLS), 2.0, 0.8 * at(cell / CELLS)) - place;
        let share =
            to.y * to.y / (PI * to.length_squared().powi(2)) * 0.8 / f64::from(CELLS * CELLS);
        let half = place + to * 0.5;
        let blocked = half.x > -0.3 && half.x < 0.4 && half.z > -0.2 && half.z < 0.3;
        all += share;
        free += if blocked { 0.0 } else { share };
    }
    (free, all)
}

#[test]
fn shooting_loses_and_makes_no_light_in_a_closed_room() {
    let mut stage = Stage::default();
    let (grey, light) = (stage.material(0.8, 0.0), stage.material(0.8, 1.0));
    let (low, high) = (DVec3::ZERO, DVec3::new(2.0, 1.0, 1.5));
    for side in 0..6 {
        stage.wall(if side == 3 { light } else { grey }, (low, high), side);
    }
    let energy = solve(&surfaces_of(&stage.scene), &coarse()).energy;
    assert!(energy.imbalance().abs() < 0.005, "{energy:?}");
    assert_eq!(energy.on_backs.max_element(), 0.0, "no backs are seen");
    assert!(energy.escaped.max_element() < 1e-4 * energy.emitted.max_element(), "{energy:?}");
    assert!(energy.unshot_share() <= 0.001, "{energy:?}");
}

#[test]
fn cells_of_a_hemicube_add_up_to_form_factors_however_it_is_turned() {
    let surfaces = surfaces_of(&furnished_room(&[]));
    let mesh = Mesh::new(&surfaces, &coarse());
    let occluders = Occluders::new(&surfaces);
    let delta = DeltaFactors::new(64);
    let targets = HemicubeScene::new(&mesh.patches);
    let mut hemicube = Hemicube::new(&delta, &targets, &occluders);
    let eye = DVec3::new(1.3, 0.0, 2.2);
    for turn in [0.0, 0.3, 0.9, 1.5] {
        for sight in hemicube.look(SurfacePoint::new(eye, DVec3::Y), turn).visible_patches() {
            let patch = &mesh[sight.patch];
            let exact = sight.visible * point_to_polygon(eye, DVec3::Y, &patch.corners);
            assert!((exact - sight.delta).abs() < 0.01, "{exact} for {sight:?}");
        }
    }
}
