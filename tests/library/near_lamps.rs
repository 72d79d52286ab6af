//! Emitters next to surfaces: all that they send arrives, and no more, however near they are.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crate::common::{Stage, solve};
use glam::DVec3;
use radiosity::colour::{LUMENS_PER_WATT, Rgb};
use radiosity::scene::{Amount, AreaLight, Light};
use radiosity::solver::{Evenness, PowerBalance, WorkPlane, read};
use radiosity::{Scene, Settings, surfaces_of};

/// Flux of every lamp here, lm.
const FLUX: f64 = 1000.0;

const POWER: f64 = FLUX / LUMENS_PER_WATT;

/// A room of 4 m × 3 m × 4 m.
fn room(reflectance: f64) -> Scene {
    let mut stage = Stage::default();
    let walls = stage.material(reflectance, 0.0);
    stage.room(walls, DVec3::ZERO, DVec3::new(4.0, 3.0, 4.0));
    stage.scene
}

/// The room with a black square lamp a `gap` under the middle of its ceiling.
fn with_square(reflectance: f64, side: f64, (gap, direction): (f64, DVec3)) -> Scene {
    let mut scene = room(reflectance);
    let lamp = AreaLight {
        centre: DVec3::new(2.0, 3.0 - gap, 2.0),
        size: [side, side],
        direction,
        amount: Amount::Flux(FLUX),
    };
    scene.add_area_light(&lamp).expect("it is a lamp");
    scene
}

fn with_light(reflectance: f64, light: Light) -> Scene {
    let mut scene = room(reflectance);
    scene.lights.push(light.into());
    scene
}

fn point(position: DVec3) -> Light {
    Light::Point { position, intensity: Rgb::splat(POWER / (4.0 * PI)) }
}

fn spot(position: DVec3, direction: DVec3) -> Light {
    let (inner_angle, outer_angle): (f64, f64) = (0.3, 0.5);
    let share = 1.0 - inner_angle.cos() + (inner_angle.cos() - outer_angle.cos()) / 3.0;
    let intensity = Rgb::splat(POWER / (2.0 * PI * share));
    Light::Spot { position, direction, intensity, inner_angle, outer_angle }
}

/// Mean illuminance 0.75 m over the floor, lx, and where the power went.
fn lit(scene: &Scene) -> (f64, PowerBalance) {
    let surfaces = surfaces_of(scene);
    let places = WorkPlane { height: 0.75, spacing: 0.5 }.places(&surfaces).expect("it is inside");
    let settings = Settings::draft();
    let solution = solve(&surfaces, &settings);
    let readings = read(&surfaces, &settings, &solution, &places, |_| ControlFlow::Continue(()));
    (Evenness::of(&readings).mean, solution.energy)
}

/// Holds the mean illuminance to within 3 %, and the flux and the balance to within 1 %.
fn hold(scene: &Scene, expected: f64, what: &str) {
    let (lux, energy) = lit(scene);
    assert!((energy.emitted.x / POWER - 1.0).abs() < 1e-6, "{what}: {} W", energy.emitted.x);
    assert!(energy.imbalance().abs() < 0.01, "{what}: {}", energy.imbalance());
    assert!((lux - expected).abs() <= 0.03 * expected, "{what}: {lux} lx for {expected}");
}

#[test]
fn points_under_a_ceiling_light_the_room_alike_however_near_they_are() {
    for gap in [0.1, 0.01, 1e-3, 1e-4] {
        // Off the lines between patches, and on one.
        for x in [1.83, 2.0] {
            // By a path tracer 44.3 ± 0.03 in the middle, wherever it is below the ceiling.
            let scene = with_light(0.7, point(DVec3::new(x, 3.0 - gap, 2.0)));
            hold(&scene, 44.3, &format!("point, {gap} m"));
        }
    }
}

#[test]
fn spots_at_a_ceiling_light_the_room_alike_however_near_they_are() {
    for gap in [0.1, 0.01, 1e-3] {
        // By a path tracer 58.75 lx by a small lamp on the ceiling, of which this one's spot has 70 %.
        let scene = with_light(0.7, spot(DVec3::new(2.0, 3.0 - gap, 2.0), DVec3::Y));
        hold(&scene, 0.7 * 58.75, &format!("spot, {gap} m"));
    }
}

#[test]
fn what_squares_send_at_a_ceiling_leaves_the_gap_as_it_must() {
    // By a path tracer of 2e7 to 1e8 paths; side and gap in m.
    for (side, gap, expected) in [
        (0.6, 0.1, 13.63),
        (0.6, 0.05, 7.65),
        (0.6, 0.01, 1.708),
        (0.1, 0.05, 28.8),
        (0.1, 0.02, 16.32),
    ] {
        let scene = with_square(0.7, side, (gap, DVec3::Y));
        hold(&scene, expected, &format!("{side} m, {gap} m from the ceiling"));
    }
}

#[test]
fn what_squares_send_down_hardly_depends_on_the_ceiling_behind_them() {
    // By a path tracer: the lamp is black, so the more it hides of the room the darker that is.
    for (gap, expected) in [(0.05, 58.63), (1e-3, 58.12)] {
        let scene = with_square(0.7, 0.6, (gap, DVec3::NEG_Y));
        hold(&scene, expected, &format!("{gap} m from the ceiling"));
    }
}

#[test]
fn between_black_walls_all_that_is_sent_arrives_once() {
    let up = |gap: f64| (gap, DVec3::Y);
    let middle = |gap: f64| DVec3::new(1.9, 3.0 - gap, 2.1);
    for gap in [1.4, 0.05, 0.003] {
        let scenes = [
            with_light(0.0, point(middle(gap))),
            with_light(0.0, spot(middle(gap), DVec3::new(0.6, 0.8, 0.0))),
            with_square(0.0, 0.6, up(gap)),
        ];
        for (k, scene) in scenes.iter().enumerate() {
            let (_, energy) = lit(scene);
            assert!((energy.emitted.x / POWER - 1.0).abs() < 1e-6, "{k}, {gap} m: {energy:?}");
            assert!(energy.imbalance().abs() < 0.01, "{k}, {gap} m: {}", energy.imbalance());
        }
    }
}
