//! The reference against closed forms, and where it looks.

use std::ops::ControlFlow;
use std::time::Duration;

use glam::DVec3;
use radiosity::Scene;
use radiosity::compare::{Effort, Reference, Set};
use radiosity::surfaces_of;

use crate::common::{Block, furnished_room, shipped};

/// One lengthening of all rounds and no more.
fn quick(area_points: usize, shadow_points: usize, seed: u64) -> Effort {
    let budget = Duration::from_secs(600);
    Effort { area_points, shadow_points, noise: Some(10.0), budget, seed }
}

fn trace(scene: &Scene, effort: &Effort) -> Reference {
    Reference::trace(&surfaces_of(scene), effort, &mut |_| ControlFlow::Continue(())).unwrap()
}

fn room() -> Scene {
    furnished_room(&[Block::spanning(DVec3::new(0.5, 0.0, 1.0), DVec3::new(1.5, 1.0, 2.0))])
}

#[test]
fn light_between_facing_squares_is_exact() {
    let reference = trace(&shipped("facing-squares.obj"), &quick(2000, 0, 1));
    let weight: f64 = reference.points.iter().map(|point| point.weight).sum();
    let light = reference.points.iter().map(|point| point.weight * point.radiosity.x);
    let mean = light.sum::<f64>() / weight;
    assert!((mean - 0.5 * 0.199_825).abs() < 2e-4, "{mean}");
    assert!(reference.points.iter().all(|point| point.error == DVec3::ZERO));
    assert!(weight > 0.99 && weight < 1.01, "{weight} m² of the lower square");
}

#[test]
fn places_inside_solids_and_on_lamps_are_left_out() {
    let reference = trace(&room(), &quick(1500, 400, 1));
    for point in &reference.points {
        let under = point.place.y < 1e-9
            && (0.5..1.5).contains(&point.place.x)
            && (1.0..2.0).contains(&point.place.z);
        assert!(!under, "{point:?} is under the block");
        assert!((point.place.y - 2.8).abs() > 1e-9, "{point:?} is on the lamp or its lid");
    }
    let shadow = reference.points.iter().filter(|point| point.set == Set::Shadow).count();
    assert!((200..=400).contains(&shadow), "{shadow} places in the edges of shadows");
}

#[test]
fn shadow_places_lie_in_the_penumbra() {
    let reference = trace(&shipped("blocker.obj"), &quick(500, 300, 1));
    let shadow = || reference.points.iter().filter(|point| point.set == Set::Shadow);
    assert!(shadow().count() > 100);
    // The lamp of 1 m at 2.4 m and a blocker half way leave the far corners of the floor in full light.
    let farthest = shadow().map(|point| point.place.x.abs().max(point.place.z.abs()));
    assert!(farthest.fold(0.0, f64::max) < 1.45, "a place in full light");
    let rest = reference.in_band.iter().filter(|in_band| !**in_band).count();
    assert!(rest > 100, "{rest} places of the area set are outside the shadow band");
}
