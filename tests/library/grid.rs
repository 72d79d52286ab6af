//! Illuminance on work planes against closed forms.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crate::common::{Block, Stage, coarse, solve};
use glam::DVec3;
use radiosity::colour::LUMENS_PER_WATT;
use radiosity::solver::{Evenness, Reading, WorkPlane, read};
use radiosity::visibility::SurfacePoint;
use radiosity::{Scene, Settings, surfaces_of};

const ROOM: (DVec3, DVec3) = (DVec3::ZERO, DVec3::new(4.0, 3.0, 5.0));

fn readings(scene: &Scene, settings: &Settings, plane: WorkPlane) -> Vec<Reading> {
    let surfaces = surfaces_of(scene);
    let places = plane.places(&surfaces).expect("the plane is within the room");
    let solution = solve(&surfaces, settings);
    read(&surfaces, settings, &solution, &places, |_| ControlFlow::Continue(()))
}

#[test]
fn in_a_furnace_every_place_in_mid_air_gets_the_same() {
    let mut stage = Stage::default();
    let glowing = stage.material(0.6, 1.0 / PI);
    stage.room(glowing, ROOM.0, ROOM.1);
    let plane = WorkPlane { height: 0.8, spacing: 1.0 };
    let readings = readings(&stage.scene, &coarse(), plane);
    assert_eq!(readings.len(), 20);
    for reading in &readings {
        // E/(1 - ρ), of which E comes straight from the walls.
        assert!((reading.direct.x - 1.0).abs() < 1e-6, "{reading:?}");
        assert!((reading.indirect.x / 1.5 - 1.0).abs() < 0.01, "{reading:?}");
    }
    let evenness = Evenness::of(&readings);
    assert!((evenness.mean / (2.5 * LUMENS_PER_WATT) - 1.0).abs() < 0.01, "{evenness:?}");
    assert!(evenness.uniformity() > Some(0.98), "{evenness:?}");
}

#[test]
fn a_grid_leaves_out_what_is_inside_of_solids_and_keeps_clear_of_walls() {
    let mut stage = Stage::default();
    let (wall, light) = (stage.material(0.5, 0.0), stage.material(0.0, 1.0));
    stage.room(wall, ROOM.0, ROOM.1);
    stage.lamp(light, DVec3::new(1.0, 2.9, 1.0), DVec3::new(2.0, 2.9, 2.0));
    let block = Block::spanning(DVec3::new(2.1, 0.0, 2.1), DVec3::new(3.9, 1.5, 3.9));
    stage.block(wall, block);
    let surfaces = surfaces_of(&stage.scene);
    let places = |height| {
        let plane = WorkPlane { height, spacing: 0.5 };
        plane.places(&surfaces).expect("the plane is within the room")
    };
    assert_eq!(places(2.0).len(), 8 * 10);
    let low = places(1.0);
    assert_eq!(low.len(), 8 * 10 - 16);
    for SurfacePoint { position: place, normal } in low {
        assert_eq!((place.y, normal), (1.0, DVec3::Y));
        assert!(!block.covers(place, 0.0), "{place}");
        let depth = (place - ROOM.0).min(ROOM.1 - place).min_element();
        assert!(depth > 0.2, "{place}");
    }
}

#[test]
fn planes_outside_of_the_scene_are_refused() {
    let mut stage = Stage::default();
    let wall = stage.material(0.5, 1.0);
    stage.room(wall, ROOM.0, ROOM.1);
    let surfaces = surfaces_of(&stage.scene);
    for (height, spacing) in [
        (0.0, 1.0),
        (3.0, 1.0),
        (9.0, 1.0),
        (f64::NAN, 1.0),
        (1.0, 0.0),
        (1.0, 1e-5),
        (1.0, f64::NAN),
    ] {
        let refused = WorkPlane { height, spacing }.places(&surfaces);
        assert!(
            refused.is_err_and(|error| error.to_string().starts_with("grid: ")),
            "{height} {spacing}"
        );
    }
    assert_eq!(
        WorkPlane { height: 1.0, spacing: 100.0 }.places(&surfaces).map_or(0, |p| p.len()),
        1
    );
}

#[test]
fn under_a_lamp_direct_light_is_that_of_its_form_factor() {
    let mut stage = Stage::default();
    let (wall, light) = (stage.material(0.5, 0.0), stage.material(0.0, 10.0));
    stage.room(wall, ROOM.0, ROOM.1);
    stage.lamp(light, DVec3::new(1.0, 2.8, 1.5), DVec3::new(3.0, 2.8, 3.5));
    let plane = WorkPlane { height: 0.8, spacing: 5.0 };
    let readings = readings(&stage.scene, &coarse(), plane);
    // Of the middle of a parallel square of 2 m × 2 m at 2 m: four corners (Howell, configuration B-3).
    let (x, root) = (0.5, 1.25_f64.sqrt());
    let factor = 4.0 * 2.0 * (x / root * (x / root).atan()) / (2.0 * PI);
    let [reading] = readings.as_slice() else { panic!("{readings:?}") };
    assert_eq!(reading.place, DVec3::new(2.0, 0.8, 2.5));
    assert!((reading.direct.x - factor * 10.0 * PI).abs() < 1e-9, "{reading:?}");
    assert!(reading.indirect.x > 0.0);
}
