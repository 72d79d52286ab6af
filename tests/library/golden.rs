//! Pictures that a person has looked at stay as they are. `UPDATE_GOLDEN=1 cargo test golden::`
//! makes them anew.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use glam::DVec3;
use image::RgbImage;
use radiosity::render::{self, Display, RenderOptions, Solved, Subject, View};
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Scene, Settings, load, reconstruct, solve, surfaces_of};

/// How far the channels of one picture are from those of another, of 255.
#[derive(Clone, Copy, Debug)]
struct Difference {
    mean: f64,
    /// No more than one of a hundred channels differs by more.
    percentile: u8,
    largest: u8,
}

/// Rounding on other processors, not another picture: a sample of a pixel at an edge may see what is beside it.
const TOLERANCE: Difference = Difference { mean: 0.5, percentile: 3, largest: 32 };

impl Difference {
    fn between(seen: &RgbImage, kept: &RgbImage) -> Self {
        assert_eq!(seen.dimensions(), kept.dimensions());
        let mut all: Vec<u8> = seen.iter().zip(kept.iter()).map(|(&a, &b)| a.abs_diff(b)).collect();
        all.sort_unstable();
        let mean = all.iter().map(|&by| f64::from(by)).sum::<f64>() / all.len() as f64;
        let (percentile, largest) = (all[all.len() * 99 / 100], all[all.len() - 1]);
        Self { mean, percentile, largest }
    }

    fn is_rounding(self) -> bool {
        self.mean <= TOLERANCE.mean
            && self.percentile <= TOLERANCE.percentile
            && self.largest <= TOLERANCE.largest
    }
}

fn scene(name: &str) -> Scene {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    load(&root.join("scenes").join(name), &Default::default()).unwrap()
}

fn picture(scene: &Scene, view: View, final_gather: bool) -> RgbImage {
    let surfaces = surfaces_of(scene);
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

fn path(golden: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/library/golden").join(golden)
}

fn kept(golden: &str) -> RgbImage {
    image::open(path(golden)).expect("a golden picture; UPDATE_GOLDEN=1 makes it").to_rgb8()
}

fn hold(name: &str, view: View, final_gather: bool, golden: &str) {
    let seen = picture(&scene(name), view, final_gather);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::create_dir_all(path(golden).parent().unwrap()).unwrap();
        seen.save(path(golden)).unwrap();
    }
    let difference = Difference::between(&seen, &kept(golden));
    assert!(difference.is_rounding(), "{name} differs from its golden picture: {difference:?}");
}

#[test]
fn a_bright_pixel_is_another_picture() {
    let golden = kept("blocker.png");
    let mut speckled = golden.clone();
    speckled.put_pixel(120, 90, image::Rgb([255; 3]));
    let difference = Difference::between(&speckled, &golden);
    assert!(difference.mean < TOLERANCE.mean, "not seen by its mean: {difference:?}");
    assert!(!difference.is_rounding(), "{difference:?}");
}

/// The lamp moves by 2 cm over a floor of 3 m, and the shadow with it.
#[test]
fn a_shifted_shadow_is_another_picture() {
    let mut moved = scene("blocker.obj");
    let lamp: Vec<u32> = moved
        .faces
        .iter()
        .filter(|face| moved[face.material].emission != DVec3::ZERO)
        .flat_map(|face| face.vertices.iter().copied())
        .collect();
    assert!(!lamp.is_empty());
    lamp.iter().for_each(|&vertex| moved.positions[vertex as usize].x += 0.02);
    let shifted = picture(&moved, View::Light, false);
    let difference = Difference::between(&shifted, &kept("blocker.png"));
    assert!(!difference.is_rounding(), "{difference:?}");
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
