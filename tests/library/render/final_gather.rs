//! Direct light at the places a picture shows agrees with the mesh, and is finer.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use glam::{DVec3, Vec3};
use radiosity::colour::luminance;
use radiosity::render::{Picture, RenderOptions, Solved, Subject, View, render_solved};
use radiosity::scene::Camera;
use radiosity::{Scene, Settings, Solution, Surfaces, TriMesh, reconstruct, surfaces_of};

use crate::common::{Block, Stage, coarse, furnished_room, solve};

/// A scene with its light.
struct Lit {
    surfaces: Surfaces,
    settings: Settings,
    solution: Solution,
    mesh: TriMesh,
}

impl Lit {
    fn new(scene: &Scene, settings: Settings) -> Self {
        let surfaces = surfaces_of(scene);
        let solution = solve(&surfaces, &settings);
        let mesh = reconstruct(&surfaces, &solution);
        Self { surfaces, settings, solution, mesh }
    }

    fn picture(&self, view: View, final_gather: bool) -> Picture {
        self.picture_until(view, final_gather, ControlFlow::Continue(()))
    }

    fn picture_until(&self, view: View, final_gather: bool, flow: ControlFlow<()>) -> Picture {
        let Self { surfaces, settings, solution, mesh } = self;
        let solved = Some(Solved { surfaces, settings, solution });
        let (width, height) = (120, 90);
        let options =
            RenderOptions { view, width, height, final_gather, ..RenderOptions::default() };
        render_solved(Subject { mesh, solved }, &camera(), &options, |_| flow)
    }
}

/// Into the room, over the blocks to the floor and the far walls.
fn camera() -> Camera {
    Camera {
        name: String::new(),
        eye: DVec3::new(3.7, 2.0, 4.7),
        target: DVec3::new(1.0, 0.4, 1.0),
        up: DVec3::Y,
        vertical_fov: 1.1,
    }
}

fn block() -> Block {
    Block { base: DVec3::new(1.3, 0.0, 1.6), size: DVec3::new(0.8, 0.9, 0.7), turn: 0.4 }
}

fn luminances(picture: &Picture) -> Vec<f64> {
    picture.values.iter().map(|value| luminance(value.as_dvec3())).collect()
}

/// Relative differences of pixels, in rising order, and that of the means.
fn differences(one: &Picture, other: &Picture) -> (Vec<f64>, f64) {
    let (one, other) = (luminances(one), luminances(other));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let floor = 0.05 * mean(&one);
    let mut all: Vec<f64> =
        one.iter().zip(&other).map(|(a, b)| (a - b).abs() / a.max(floor)).collect();
    all.sort_by(f64::total_cmp);
    (all, mean(&other) / mean(&one) - 1.0)
}

#[test]
fn a_fine_mesh_looks_the_same_with_final_gathering_and_without() {
    let settings = Settings { max_level: 6, hemicube_resolution: 64, ..Settings::medium() };
    let lit = Lit::new(&furnished_room(&[block()]), settings);
    let [plain, exact] = [false, true].map(|gather| lit.picture(View::Light, gather));
    let (all, of_means) = differences(&plain, &exact);
    let at = |share: f64| all[(share * (all.len() - 1) as f64) as usize];
    assert!(of_means.abs() < 0.005, "means differ by {of_means}");
    assert!(at(0.5) < 0.005 && at(0.95) < 0.03, "median {}, 95 % {}", at(0.5), at(0.95));
    assert_eq!(plain.coverage, exact.coverage);
}

#[test]
fn direct_light_at_samples_does_not_depend_on_the_mesh() {
    let scene = furnished_room(&[block()]);
    let uniform = |size| Lit::new(&scene, Settings { uniform: Some(size), ..coarse() });
    let (few, many) = (uniform(1.0), uniform(0.35));
    let [one, other] = [&few, &many].map(|lit| lit.picture(View::Direct, true));
    let (all, _) = differences(&one, &other);
    let (most, largest) = (all[all.len() * 99 / 100], all[all.len() - 1]);
    assert!(most < 5e-3 && largest < 0.03, "{most} {largest}");
    // The meshes themselves see the shadow differently.
    let (interpolated, _) = differences(&few.picture(View::Direct, false), &one);
    assert!(interpolated[interpolated.len() - 1] > 0.2);
}

#[test]
fn threads_do_not_change_it_and_breaking_off_interpolates_the_rest() {
    let lit = Lit::new(&furnished_room(&[block()]), Settings { uniform: Some(1.0), ..coarse() });
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| lit.picture(View::Light, true))
    };
    let gathered = with(1);
    assert_eq!(gathered, with(4));
    let broken_off = lit.picture_until(View::Light, true, ControlFlow::Break(()));
    let plain = lit.picture(View::Light, false);
    let (all, _) = differences(&plain, &broken_off);
    // One ray a pixel is off where light changes across it, and rough at edges.
    let most = all.len() * 4 / 5;
    assert!(all[most] < 0.03, "{}", all[most]);
    assert_ne!(plain, gathered);
}

/// A room with a column of many facets, smooth to the eye.
fn column() -> Scene {
    const FACETS: usize = 16;
    let mut stage = Stage { scene: furnished_room(&[]) };
    let paint = stage.material(0.5, 0.0);
    let axis = DVec3::new(1.3, 0.0, 1.6);
    let out = |k: usize| {
        let (z, x) = ((k % FACETS) as f64 / FACETS as f64 * TAU).sin_cos();
        DVec3::new(x, 0.0, z)
    };
    let foot = |k: usize| axis + out(k) * 0.5;
    for k in 0..FACETS {
        let (a, b) = (foot(k), foot(k + 1));
        let up = DVec3::Y * 1.2;
        let face = stage.polygon(paint, &[a, a + up, b + up, b]);
        let normals: [Vec3; 4] = [k, k, k + 1, k + 1].map(|k| out(k).as_vec3());
        face.normals = normals.into_iter().collect();
    }
    stage.scene
}

#[test]
fn facets_are_no_more_visible_with_final_gathering_than_without() {
    let lit = Lit::new(&column(), Settings { max_level: 5, ..coarse() });
    let [plain, exact] = [false, true].map(|gather| luminances(&lit.picture(View::Direct, gather)));
    // Across the column, well below its upper edge and above its foot.
    let row = 50 * 120;
    let step = |values: &[f64]| -> f64 {
        let steps = values[row + 50..row + 68].windows(2).map(|pair| (pair[1] - pair[0]).abs());
        steps.fold(0.0, f64::max) / values[row + 50..row + 68].iter().copied().fold(0.0, f64::max)
    };
    assert!(step(&exact) < step(&plain) + 0.02, "{} {}", step(&exact), step(&plain));
    assert_ne!(plain, exact);
}
