//! Relaxations of a whole scene: the light is the same, whichever patch is next.

use std::ops::ControlFlow;

use glam::DVec3;
use radiosity::colour::Rgb;
use radiosity::settings::Method;
use radiosity::solver::{Cancellation, Phase, Stop};
use radiosity::{Scene, Settings, Solution, surfaces_of};

use super::METHODS;
use crate::common::{self, Block, Stage, coarse, furnished_room};

fn furnished() -> Scene {
    let size = DVec3::new(0.8, 1.2, 0.7);
    furnished_room(&[Block { base: DVec3::new(1.2, 0.0, 1.3), size, turn: 0.5 }])
}

fn solved(scene: &Scene, settings: &Settings) -> Solution {
    common::solve(&surfaces_of(scene), settings)
}

#[test]
fn all_solvers_leave_the_same_light() {
    let scene = furnished();
    // A uniform mesh is the same whatever the light, so that elements can be compared.
    let base = Settings { unshot_limit: 1e-5, uniform: Some(0.8), ..coarse() };
    let truth = solved(&scene, &base);
    let mean = truth.light.indirect.iter().sum::<Rgb>() / truth.light.indirect.len() as f64;
    let emitted = truth.energy.emitted.element_sum();
    for (method, omega) in METHODS.map(|method| (method, 1.0)).into_iter().chain([
        (Method::Jacobi, 0.8),
        (Method::GaussSeidel, 1.2),
        (Method::Southwell, 1.3),
        (Method::Progressive, 0.7),
        (Method::Progressive, 1.2),
    ]) {
        let solution = solved(&scene, &Settings { method, omega, ..base.clone() });
        assert_eq!(solution.stop, Stop::Converged, "{method:?} {omega}");
        let lost = solution.energy.imbalance() - truth.energy.imbalance();
        assert!(lost.abs() < 1e-4, "{method:?} {omega}: {lost} of the light is lost");
        let absorbed = solution.energy.absorbed - truth.energy.absorbed;
        assert!(absorbed.element_sum().abs() < 1e-4 * emitted, "{method:?} {omega}: {absorbed} W");
        // Shots are scaled to their power, which depends a little on what is shot together.
        let pairs = solution.light.indirect.iter().zip(&truth.light.indirect);
        let errors: Vec<f64> = pairs.map(|(a, b)| (*a - *b).length() / mean.length()).collect();
        let worst = errors.iter().copied().fold(0.0, f64::max);
        let usual = errors.iter().sum::<f64>() / errors.len() as f64;
        assert!(worst < 0.01 && usual < 5e-4, "{method:?} {omega}: {usual}, {worst} at worst");
    }
}

#[test]
fn histories_tell_of_every_shot() {
    let scene = furnished();
    for method in METHODS {
        let settings = Settings { method, ..coarse() };
        let solution = solved(&scene, &settings);
        let steps = &solution.history;
        assert!(steps.iter().enumerate().all(|(number, step)| step.shots == number));
        assert!(steps.windows(2).all(|pair| pair[1].unshot <= pair[0].unshot + 1e-12));
        let last = steps[steps.len() - 1];
        assert!(last.unshot <= settings.unshot_limit && steps.len() > 10, "{method:?}: {last:?}");
    }
}

#[test]
fn the_shot_limit_holds_within_a_sweep() {
    let scene = furnished();
    for method in METHODS {
        let settings = Settings { method, max_shots: Some(20), ..coarse() };
        let solution = solved(&scene, &settings);
        assert_eq!((solution.stop, solution.shots), (Stop::ShotLimit, 20), "{method:?}");
        assert!(solution.energy.imbalance().abs() < 5e-3, "{method:?}");
    }
}

#[test]
fn over_relaxation_that_never_settles_is_refused() {
    let settings = Settings { method: Method::Jacobi, omega: 1.95, ..coarse() };
    let refused =
        radiosity::solve(&surfaces_of(&furnished()), &settings, |_| ControlFlow::Continue(()));
    let message = refused.map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("omega") && message.contains("jacobi"), "{message}");
}

#[test]
fn surfaces_that_reflect_everything_are_refused() {
    let mut stage = Stage { scene: furnished() };
    let bright = stage.material(1.2, 0.0);
    stage.block(bright, Block::spanning(DVec3::splat(0.2), DVec3::splat(0.4)));
    let surfaces = surfaces_of(&stage.scene);
    let refused = radiosity::solve(&surfaces, &coarse(), |_| ControlFlow::Continue(()));
    let message = refused.map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("reflectance 1.2") && message.contains("less than 1"), "{message}");
}

#[test]
fn a_break_in_the_middle_of_a_sweep_loses_no_light() {
    let surfaces = surfaces_of(&furnished());
    for method in METHODS {
        let settings = Settings { method, ..coarse() };
        let solution = radiosity::solve(&surfaces, &settings, |progress| {
            let is_enough = progress.phase == Phase::Shooting && progress.done > 0.3;
            if is_enough {
                ControlFlow::Break(Cancellation::Caller)
            } else {
                ControlFlow::Continue(())
            }
        });
        let solution = solution.unwrap();
        assert_eq!(solution.stop, Stop::Cancelled(Cancellation::Caller), "{method:?}");
        assert!(solution.history.len() > 10, "{method:?}");
        assert!(solution.energy.imbalance().abs() < 5e-3, "{method:?}");
    }
}
