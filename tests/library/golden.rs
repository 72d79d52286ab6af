//! Pictures that a person has looked at stay as they are. `UPDATE_GOLDEN=1 cargo test golden::`
//! makes them anew.

use std::ops::ControlFlow;
use std::path::Path;

use image::RgbImage;
use radiosity::render::{self, Display, RenderOptions, Solved, Subject, View};
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Settings, load, reconstruct, solve, surfaces_of};

/// Largest mean difference of a channel, of 255: rounding on other processors, not another picture.
const TOLERANCE: f64 = 0.5;

fn picture(scene: &str, view: View, final_gather: bool) -> RgbImage {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = load(&root.join("scenes").join(scene), &Default::default()).unwrap();
    let surfaces = surfaces_of(&scene);
    let settings = Settings { max_level: 4, ..Settings::draft() };
    let solution = solve(&surfaces, &settings, |_| ControlFlow::Continue(())).unwrap();
    let mesh = reconstruct(&surfaces, &solution);
    let found = scene.cameras.first().cloned();
    let camera = found.unwrap_or_else(|| render::automatic_camera(&mesh, 4.0 / 3.0));
    let options =
        RenderOptions { view, width: 240, height: 180, final_gather, ..RenderOptions::default() };
    let solved = Some(Solved { surfaces: &surfaces, settings: &settings, solution: &solution });
    let subject = Subject { mesh: &mesh, solved };
    let picture = render::render_solved(subject, &camera, &options, |_| ControlFlow::Continue(()));
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("picture.png");
    let display = Display::exposed(exposure_scale(&mesh, Exposure::Automatic));
    render::save(&picture, &path, &display).unwrap();
    image::open(path).unwrap().to_rgb8()
}

fn hold(scene: &str, view: View, final_gather: bool, golden: &str) {
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/library/golden").join(golden);
    let seen = picture(scene, view, final_gather);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::create_dir_all(golden.parent().unwrap()).unwrap();
        seen.save(&golden).unwrap();
    }
    let kept = image::open(&golden).expect("a golden picture; UPDATE_GOLDEN=1 makes it").to_rgb8();
    assert_eq!(seen.dimensions(), kept.dimensions(), "{scene}");
    let differences = seen.iter().zip(kept.iter()).map(|(&a, &b)| f64::from(a.abs_diff(b)));
    let mean = differences.sum::<f64>() / seen.len() as f64;
    assert!(mean <= TOLERANCE, "{scene} differs from its golden picture by {mean} of 255");
}

#[test]
fn golden_cornell_box() {
    hold("cornell-box.glb", View::Light, false, "cornell-box.png");
}

#[test]
fn golden_blocker() {
    hold("blocker.obj", View::Light, false, "blocker.png");
}

#[test]
fn golden_two_rooms() {
    hold("two-rooms.obj", View::Light, false, "two-rooms.png");
}

#[test]
fn golden_final_gather() {
    hold("blocker.obj", View::Light, true, "blocker-final.png");
}

#[test]
fn golden_illuminance() {
    hold("two-rooms.obj", View::Illuminance, false, "two-rooms-illuminance.png");
}
