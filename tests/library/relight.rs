//! Lights that are kept apart: their sum is what a fresh solution would be.

use std::ops::ControlFlow;

use crate::common::{self, Block, assert_sane, coarse, furnished_room, mean_radiosity};
use glam::DVec3;
use radiosity::colour::Rgb;
use radiosity::reconstruct::reconstruct_by_light;
use radiosity::scene::{Light, NamedLight};
use radiosity::solver::Checkpoint;
use radiosity::surface::LightGroup;
use radiosity::{ScaledLight, Scene, Settings, Solution, TriMesh, solve_by_light, surfaces_of};

/// A room with a lamp, a glowing block and a spot without a surface.
fn room(lamp: Rgb, spot: Rgb) -> Scene {
    let block = |x: f64| Block {
        base: DVec3::new(x, 0.0, 2.0),
        size: DVec3::new(0.8, 1.2, 0.7),
        turn: 0.3,
    };
    let mut scene = furnished_room(&[block(1.2), block(2.9)]);
    let glowing = scene.materials.iter().position(|m| m.emission != Rgb::ZERO).unwrap();
    scene.materials[glowing].emission = lamp;
    scene.materials[glowing].name = "lamp".to_owned();
    for (number, x) in [0.6, 3.2].into_iter().enumerate() {
        let position = DVec3::new(x, 2.0, 4.0);
        let light = Light::Point { position, intensity: spot };
        scene.lights.push(NamedLight { name: format!("spot {number}"), light });
    }
    scene
}

fn settings() -> Settings {
    Settings { max_level: 2, ..coarse() }
}

/// All lights apart, the spots together.
fn apart(scene: &Scene) -> (Solution, TriMesh) {
    let surfaces = surfaces_of(scene);
    let patterns = ["spot*".to_owned()];
    let groups = surfaces.light_groups(&patterns);
    let names: Vec<&str> = groups.iter().map(|group| group.name.as_str()).collect();
    assert_eq!(names, ["lamp", "spot*"]);
    let scene = |group: &LightGroup| ScaledLight {
        surfaces: surfaces.lit_by(group, &patterns),
        strength: group.strength,
    };
    let scenes: Vec<ScaledLight> = groups.iter().map(scene).collect();
    let go_on = |_: &radiosity::solver::Progress| ControlFlow::Continue(());
    let mut nowhere = Checkpoint::default();
    let (solution, parts) = solve_by_light(&scenes, &settings(), &mut nowhere, go_on).unwrap();
    let parts =
        groups.into_iter().zip(scenes).zip(parts).map(|((g, s), part)| (g, s.surfaces, part));
    let mesh = reconstruct_by_light(&surfaces, &solution, parts);
    assert_sane(&mesh);
    (solution, mesh)
}

fn distance(a: &TriMesh, b: &TriMesh) -> f64 {
    let difference =
        a.radiosity.iter().zip(&b.radiosity).map(|(a, b)| (*a - *b).abs().max_element());
    difference.fold(0.0, f64::max) / mean_radiosity(b)
}

#[test]
fn what_is_relit_is_what_a_fresh_solution_would_be() {
    let (bright, dim) = (Rgb::new(10.0, 8.0, 0.0), Rgb::new(0.5, 3.0, 1.0));
    let (_, mut relit) = apart(&room(bright, dim));
    let [now, then] = [(bright, dim), (Rgb::new(1.0, 2.0, 30.0), Rgb::new(4.0, 0.0, 0.2))];
    let (_, fresh) = apart(&room(then.0, then.1));
    assert_eq!(relit.positions, fresh.positions, "the mesh hangs on no strength");
    assert!(distance(&relit, &fresh) > 0.1);
    relit.relight(0, then.0);
    relit.relight(1, then.1);
    assert!(distance(&relit, &fresh) < 1e-9, "{}", distance(&relit, &fresh));
    relit.relight(0, now.0);
    relit.relight(1, Rgb::ZERO);
    let (_, alone) = apart(&room(now.0, Rgb::splat(1e-12)));
    assert!(distance(&relit, &alone) < 1e-9);
}

#[test]
fn lights_apart_and_lights_together_bring_the_same_light() {
    let scene = room(Rgb::splat(9.0), Rgb::new(2.0, 1.0, 0.5));
    let (sum, apart) = apart(&scene);
    let surfaces = surfaces_of(&scene);
    let together = common::solve(&surfaces, &settings());
    let mesh = radiosity::reconstruct(&surfaces, &together);
    let ratio = mean_radiosity(&apart) / mean_radiosity(&mesh);
    assert!((ratio - 1.0).abs() < 0.005, "{ratio}");
    let (a, b) = (sum.energy, together.energy);
    assert!(((a.emitted - b.emitted) / b.emitted).abs().max_element() < 0.005, "{a:?} {b:?}");
    assert!(a.imbalance().abs() < 0.01, "{a:?}");
}
