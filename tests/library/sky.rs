//! Light of the sky, the sun and luminaires against closed forms.

use std::f64::consts::PI;

use crate::common::{Stage, coarse, solve};
use glam::DVec3;
use radiosity::colour::LUMENS_PER_WATT;
use radiosity::direct::Emitters;
use radiosity::mesh::Mesh;
use radiosity::scene::{Light, Sky, clear_sun};
use radiosity::visibility::{Occluders, SurfacePoint};
use radiosity::{Scene, surfaces_of};

const SKIES: [Sky; 2] = [Sky::Uniform, Sky::Overcast];

/// Illuminance straight from the lights of a scene, lx, with and without what hides them.
fn lux(scene: &Scene, place: DVec3, normal: DVec3) -> [f64; 2] {
    let surfaces = surfaces_of(scene);
    let emitters = Emitters::new(&surfaces, &Mesh::new(&surfaces, &coarse()));
    let direct = emitters.shine(&Occluders::new(&surfaces), place, normal);
    [direct.irradiance.x, direct.unoccluded.x].map(|watts| watts * LUMENS_PER_WATT)
}

/// A floor of 4 m × 4 m under a sky of 1000 lx.
fn floor(sky: Sky) -> Stage {
    let mut stage = Stage::default();
    let grey = stage.material(0.3, 0.0);
    let corners = [(0.0, 0.0), (0.0, 4.0), (4.0, 4.0), (4.0, 0.0)];
    stage.polygon(grey, &corners.map(|(x, z)| DVec3::new(x, 0.0, z)));
    stage.scene.lights.push(Light::sky(sky, 1000.0).into());
    stage
}

#[test]
fn open_places_get_what_was_asked_for_whatever_they_face() {
    for sky in SKIES {
        let scene = floor(sky).scene;
        for tilt in [0.0_f64, 0.3, 1.0, PI / 2.0, 2.0] {
            let normal = DVec3::new(tilt.sin() * 0.6, tilt.cos(), tilt.sin() * 0.8);
            // Of a plane tilted by β, a uniform sky fills (1 + cos β)/2; of an overcast one by quadrature.
            let expected = match sky {
                Sky::Uniform => 500.0 * (1.0 + tilt.cos()),
                Sky::Overcast => by_quadrature(normal),
            };
            let [found, _] = lux(&scene, DVec3::new(2.0, 0.0, 2.0), normal);
            assert!((found - expected).abs() < 1e-3 * 1000.0, "{sky:?} {tilt}: {found} {expected}");
        }
    }
}

/// Illuminance by an overcast sky of 1000 lx on a plane with this normal.
fn by_quadrature(normal: DVec3) -> f64 {
    let steps = 1000;
    let mut sum = 0.0;
    for i in 0..steps {
        let y = (f64::from(i) + 0.5) / f64::from(steps);
        for j in 0..steps {
            let (sin, cos) = ((f64::from(j) + 0.5) / f64::from(steps) * 2.0 * PI).sin_cos();
            let flat = (1.0 - y * y).sqrt();
            let cosine = DVec3::new(flat * cos, y, flat * sin).dot(normal).max(0.0);
            sum += (1.0 + 2.0 * y) / 3.0 * cosine;
        }
    }
    let zenith = 1000.0 * 9.0 / (7.0 * PI);
    zenith * sum * 2.0 * PI / f64::from(steps * steps)
}

/// A closed room of 4 × 3 × 5 m with a window from corner to corner of a rectangle in the wall at low z.
fn room_with_window(sky: Sky, low: [f64; 2], high: [f64; 2]) -> Scene {
    let mut stage = Stage::default();
    let wall = stage.material(0.5, 0.0);
    let (near, far) = (DVec3::ZERO, DVec3::new(4.0, 3.0, 5.0));
    for side in [0, 1, 2, 3, 5] {
        stage.wall(wall, (near, far), side);
    }
    let mut part = |[x0, y0]: [f64; 2], [x1, y1]: [f64; 2]| {
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)];
        stage.polygon(wall, &corners.map(|(x, y)| DVec3::new(x, y, 0.0)));
    };
    part([0.0, 0.0], [4.0, low[1]]);
    part([0.0, high[1]], [4.0, 3.0]);
    part([0.0, low[1]], [low[0], high[1]]);
    part([high[0], low[1]], [4.0, high[1]]);
    stage.scene.lights.push(Light::sky(sky, 1000.0).into());
    stage.scene
}

/// ∫ L cos θ dω over a window, by squares of a millimetre or so.
fn through_window(sky: Sky, place: DVec3, (low, high): ([f64; 2], [f64; 2])) -> f64 {
    let steps = 400;
    let size = [0, 1].map(|k| (high[k] - low[k]) / f64::from(steps));
    let mut sum = 0.0;
    for i in 0..steps {
        for j in 0..steps {
            let x = low[0] + size[0] * (f64::from(i) + 0.5);
            let y = low[1] + size[1] * (f64::from(j) + 0.5);
            let way = DVec3::new(x, y, 0.0) - place;
            let square = way.length_squared();
            let (up, out) = (way.y / square.sqrt(), -way.z / square.sqrt());
            let radiance = match sky {
                Sky::Uniform => 1000.0 / PI,
                Sky::Overcast => 1000.0 * 9.0 / (7.0 * PI) * (1.0 + 2.0 * up) / 3.0,
            };
            // From the floor all of the window is above the horizon.
            sum += radiance * up * out / square;
        }
    }
    sum * size[0] * size[1]
}

#[test]
fn a_window_lets_in_what_it_shows_of_the_sky() {
    let window = ([1.0, 0.9], [3.2, 2.4]);
    for sky in SKIES {
        let scene = room_with_window(sky, window.0, window.1);
        for place in [DVec3::new(2.0, 0.0, 1.0), DVec3::new(0.5, 0.0, 4.0)] {
            let (expected, [found, _]) =
                (through_window(sky, place, window), lux(&scene, place, DVec3::Y));
            assert!((found / expected - 1.0).abs() < 1e-3, "{sky:?} {place}: {found} {expected}");
        }
        // Under a window's head, the ceiling sees no sky.
        assert_eq!(lux(&scene, DVec3::new(2.0, 3.0, 1.0), DVec3::NEG_Y)[0], 0.0);
    }
}

#[test]
fn a_sky_seen_by_rays_is_the_same_on_the_mean() {
    let point = SurfacePoint::new(DVec3::new(1.3, 0.0, 1.5), DVec3::Y);
    for sky in SKIES {
        let surfaces = surfaces_of(&room_with_window(sky, [1.0, 0.9], [3.2, 2.4]));
        let occluders = Occluders::new(&surfaces);
        let emitters = Emitters::new(&surfaces, &Mesh::new(&surfaces, &coarse()));
        let exact = emitters.shine(&occluders, point.position, point.normal).irradiance.x;
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let count = 20_000;
        let sum: f64 =
            (0..count).map(|_| emitters.sample_unbiased(&occluders, point, &mut random).x).sum();
        let mean = sum / f64::from(count);
        assert!((mean / exact - 1.0).abs() < 0.05, "{sky:?}: {mean} by single rays, {exact}");
        let sampled = emitters
            .seen_by(Some(1024))
            .shine(&occluders, point.position, point.normal)
            .irradiance
            .x;
        assert!((sampled / exact - 1.0).abs() < 0.05, "{sky:?}: {sampled} by rays, {exact}");
    }
}

#[test]
fn power_of_a_sky_is_what_arrives_of_it() {
    let scene = room_with_window(Sky::Overcast, [1.0, 0.9], [3.2, 2.4]);
    let energy = solve(&surfaces_of(&scene), &coarse()).energy;
    assert!(energy.imbalance().abs() < 0.005 && energy.emitted.x > 0.0, "{energy:?}");
    assert!(energy.escaped.x > 0.0, "some of it leaves by the window: {energy:?}");
}

#[test]
fn the_sun_stands_where_its_angles_say() {
    let direction = |azimuth, elevation| match Light::sun(azimuth, elevation, 1.0) {
        Light::Sun { direction, .. } => direction,
        light => panic!("{light:?}"),
    };
    assert!((direction(0.0, 0.0) - DVec3::Z).length() < 1e-12, "from the north");
    assert!((direction(90.0, 0.0) - DVec3::NEG_X).length() < 1e-12, "from the east");
    assert!((direction(180.0, 90.0) - DVec3::NEG_Y).length() < 1e-12, "from above");
    assert!((clear_sun(90.0) - 127_500.0 * (-0.21_f64).exp()).abs() < 1e-6);
    assert_eq!(clear_sun(-5.0), 0.0);
    let mut scene = floor(Sky::Uniform).scene;
    scene.lights = vec![Light::sun(120.0, 30.0, 50_000.0).into()];
    let [found, _] = lux(&scene, DVec3::new(2.0, 0.0, 2.0), DVec3::Y);
    assert!((found / 25_000.0 - 1.0).abs() < 1e-4, "{found}");
}

#[test]
fn luminaires_hang_aimed_down_and_turn_counter_clockwise() {
    let directory = tempfile::tempdir().expect("temporary directories can be made");
    let path = directory.path().join("lamp.ies");
    // Straight down 200 cd; at 45° from it 100 cd along its horizontal angle 0, none elsewhere.
    let text = "TILT=NONE\n1 -1 1 3 5 1 2 0 0 0\n1 1 9\n0 45 90\n0 90 180 270 360\n\
                200 100 0\n200 0 0\n200 0 0\n200 0 0\n200 100 0\n";
    std::fs::write(&path, text).expect("temporary files can be written");
    let east = DVec3::new(3.5, 0.0, 2.0);
    let north = DVec3::new(2.0, 0.0, 0.5);
    for (rotation, lit, dark) in [(0.0, east, north), (90.0, north, east)] {
        let mut scene = floor(Sky::Uniform).scene;
        scene.lights.clear();
        scene.add_luminaire(&path, DVec3::new(2.0, 1.5, 2.0), rotation).expect("the file is right");
        let found = |place| lux(&scene, place, DVec3::Y)[0];
        assert!((found(DVec3::new(2.0, 0.0, 2.0)) - 200.0 / 2.25).abs() < 1e-9);
        // I cos θ / d² at √2 times the height.
        let expected = 100.0 * 0.5_f64.sqrt() / 4.5;
        assert!((found(lit) - expected).abs() < 1e-6, "{rotation}: {} {expected}", found(lit));
        assert!(found(dark) < 1e-6, "{rotation}: {}", found(dark));
    }
}
