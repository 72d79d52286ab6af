//! Reflected light beside what hovers close over a surface: it falls towards the outline as it should, without teeth.

use crate::common::{Stage, corners, mesh_of, radiosities};
use glam::{DVec2, DVec3};
use radiosity::{Scene, Settings, TriMesh};

const HEIGHT: f64 = 2.7;

const REFLECTANCE: f64 = 0.6;

/// Opposite corners of the lamp on its plane, m.
const LAMP: [DVec2; 2] = [DVec2::new(1.7, 2.2), DVec2::new(2.3, 2.8)];

/// A grey room of 4 m × 2.7 m × 5 m with a square lamp, grey above, a `gap` under its ceiling.
fn room(gap: f64) -> Scene {
    let mut stage = Stage::default();
    let (grey, lamp) = (stage.material(REFLECTANCE, 0.0), stage.material(0.0, 10.0));
    stage.room(grey, DVec3::ZERO, DVec3::new(4.0, HEIGHT, 5.0));
    let [low, high] = LAMP;
    let square = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
        .map(|p| DVec3::new(p.x, HEIGHT - gap, p.y));
    stage.polygon(lamp, &square);
    let [a, b, c, d] = square;
    stage.polygon(grey, &[d, c, b, a]);
    stage.scene
}

/// Irradiance at a place on the ceiling, W/m²: all of it is reflected light.
fn on_ceiling(mesh: &TriMesh, at: DVec2) -> f64 {
    let light = |&triangle: &[u32; 3]| {
        let places = corners(mesh, triangle);
        let is_ceiling = places.iter().all(|p| (p.y - HEIGHT).abs() < 1e-9);
        let [a, b, c] = places.map(|p| DVec2::new(p.x, p.z));
        let twice = (b - a).perp_dot(c - a);
        let shares =
            [(b - at).perp_dot(c - at), (c - at).perp_dot(a - at), (a - at).perp_dot(b - at)];
        let shares = shares.map(|share| share / twice);
        let is_inside = is_ceiling && shares.iter().all(|&share| share >= -1e-9);
        let values = radiosities(mesh, triangle);
        is_inside.then(|| (0..3).map(|k| shares[k] * values[k]).sum::<f64>() / REFLECTANCE)
    };
    mesh.triangles.iter().find_map(light).expect("it is on the ceiling")
}

/// Path-traced with three million paths for each value: gap, m; irradiance at 1, 2, 5 and 12 cm from the middle of a
/// side of the outline, W/m². Their standard errors are below 0.05 %.
const TRACED: [(f64, [f64; 4]); 5] = [
    (0.0002, [0.2437, 0.2438, 0.2436, 0.2435]),
    (0.005, [0.2348, 0.2417, 0.2434, 0.2436]),
    (0.02, [0.1930, 0.2178, 0.2386, 0.2432]),
    (0.05, [0.1636, 0.1862, 0.2196, 0.2393]),
    (0.2, [0.1669, 0.1729, 0.1901, 0.2185]),
];

#[test]
fn reflected_light_falls_towards_the_outline_of_a_lamp_under_a_ceiling_as_paths_say() {
    for (gap, traced) in TRACED {
        let mesh = mesh_of(&room(gap), &Settings::draft());
        let [low, high] = LAMP;
        let middle = low.midpoint(high);
        let mut last = 0.0;
        for (aside, expected) in [0.01, 0.02, 0.05, 0.12].into_iter().zip(traced) {
            let found = on_ceiling(&mesh, DVec2::new(high.x + aside, middle.y));
            let error = found / expected - 1.0;
            assert!(
                error.abs() < 0.05,
                "{found} W/m² for {expected}, {aside} m aside, gap {gap} m"
            );
            // Where it is even, the mesh need not show the last half percent.
            assert!(
                found > 0.995 * last,
                "{found} W/m² after {last}, {aside} m aside, gap {gap} m"
            );
            last = found;
        }
    }
}

#[test]
fn reflected_light_beside_an_outline_is_as_even_along_it_as_it_should_be() {
    // No teeth: a centimetre outside, over the middle half of a side, light changes by less than 3 % (traced: 0.3 %).
    for gap in [0.0002, 0.005, 0.02] {
        let mesh = mesh_of(&room(gap), &Settings::draft());
        let [low, high] = LAMP;
        let along = |k: usize| low.y + (high.y - low.y) * (0.25 + 0.5 * k as f64 / 40.0);
        let light: Vec<f64> =
            (0..=40).map(|k| on_ceiling(&mesh, DVec2::new(high.x + 0.01, along(k)))).collect();
        let (least, most) =
            light.iter().fold((f64::MAX, 0.0_f64), |(a, b), &x| (a.min(x), b.max(x)));
        assert!(most / least < 1.03, "{least} to {most} W/m² at a gap of {gap} m");
    }
}
