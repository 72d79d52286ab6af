//! Hemicubes per second on one core, from random points of a furnished room.
//!
//! `look` fills the item buffer and sums the delta factors of each patch, `elements` also those of each
//! element, `exact` computes the exact factors of the elements seen. Items are hemicubes.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use divan::{Bencher, counter::ItemsCount};
use glam::DVec3;
use radiosity::form_factor::contour::point_to_polygon;
use radiosity::form_factor::hemicube::{
    DeltaFactors, ElementMap, ElementSums, Hemicube, HemicubeScene,
};
use radiosity::mesh::{ElementId, Mesh, Reason};
use radiosity::surface::Surfaces;
use radiosity::visibility::{Occluders, SurfacePoint};
use radiosity::{Length, Settings, surfaces_of};

#[path = "../tests/library/common/stage.rs"]
mod stage;

use stage::{Block, Stage};

/// Hemicubes in one measurement, each from another point.
const LOOKS: usize = 16;

/// Resolutions, cells along the edges of the top face.
const RESOLUTIONS: [usize; 4] = [64, 128, 256, 512];

/// What is looked at.
struct Room {
    surfaces: Surfaces,
    mesh: Mesh,
    targets: HemicubeScene,
    map: ElementMap,
    occluders: Occluders,
}

/// A thousand patches, with that many elements, a hundred thousand, and a million.
static COARSE: LazyLock<[Room; 3]> = LazyLock::new(|| [0, 3, 5].map(|levels| room(0.9, levels)));

/// Ten thousand patches, with that many elements, a hundred thousand, and a million.
static FINE: LazyLock<[Room; 3]> = LazyLock::new(|| [0, 2, 3].map(|levels| room(0.218, levels)));

fn main() {
    for room in COARSE.iter().chain(FINE.iter()) {
        println!("{} patches, {} elements", room.targets.len(), room.map.leaves().len());
    }
    divan::main();
}

#[divan::bench(args = RESOLUTIONS, consts = [0, 1, 2], sample_count = 12, sample_size = 1)]
fn elements_of_1k_patches<const ROOM: usize>(bencher: Bencher, resolution: usize) {
    elements(bencher, &COARSE[ROOM], resolution);
}

#[divan::bench(args = RESOLUTIONS, consts = [0, 1, 2], sample_count = 10, sample_size = 1)]
fn elements_of_10k_patches<const ROOM: usize>(bencher: Bencher, resolution: usize) {
    elements(bencher, &FINE[ROOM], resolution);
}

#[divan::bench(args = RESOLUTIONS, sample_count = 12, sample_size = 1)]
fn look_at_1k_patches(bencher: Bencher, resolution: usize) {
    let room = &COARSE[0];
    let delta = DeltaFactors::new(resolution);
    let mut hemicube = Hemicube::new(&delta, &room.targets, &room.occluders);
    let eyes = eyes(&room.mesh);
    bencher.counter(ItemsCount::new(LOOKS)).bench_local(|| {
        eyes.iter()
            .zip(0..)
            .map(|(&eye, k)| hemicube.look(eye, f64::from(k)).escaping())
            .sum::<f64>()
    });
}

/// Without the hemicubes, which say which elements are seen.
#[divan::bench(consts = [0, 1], sample_count = 5, sample_size = 1)]
fn exact_factors_at_256_of_1k_patches<const ROOM: usize>(bencher: Bencher) {
    let room = &COARSE[ROOM];
    let delta = DeltaFactors::new(256);
    let mut hemicube = Hemicube::new(&delta, &room.targets, &room.occluders);
    let mut sums = ElementSums::new(&room.map);
    let mut seen = |(eye, k): (&SurfacePoint, u32)| -> Vec<ElementId> {
        let seen = sums.of(hemicube.look(*eye, f64::from(k)));
        seen.iter().map(|seen| room.map.leaves()[seen.leaf as usize]).collect()
    };
    let eyes = eyes(&room.mesh);
    let views: Vec<Vec<ElementId>> = eyes.iter().zip(0..).map(&mut seen).collect();
    bencher.counter(ItemsCount::new(LOOKS)).bench_local(|| {
        let factors = |(eye, seen): (&SurfacePoint, &Vec<ElementId>)| {
            let factor = |&leaf: &ElementId| {
                point_to_polygon(eye.position, eye.normal, &corners(room, leaf))
            };
            seen.iter().map(factor).sum::<f64>()
        };
        eyes.iter().zip(&views).map(factors).sum::<f64>()
    });
}

fn elements(bencher: Bencher, room: &Room, resolution: usize) {
    let delta = DeltaFactors::new(resolution);
    let mut hemicube = Hemicube::new(&delta, &room.targets, &room.occluders);
    let mut sums = ElementSums::new(&room.map);
    let eyes = eyes(&room.mesh);
    bencher.counter(ItemsCount::new(LOOKS)).bench_local(|| {
        let looks = eyes.iter().zip(0..);
        looks.map(|(&eye, k)| sums.of(hemicube.look(eye, f64::from(k))).len()).sum::<usize>()
    });
}

/// A room of 10 × 8 × 3 m with 24 turned boxes, some of them floating; its patches at most this long,
/// m, divided in quarters so many times.
fn room(size: f64, levels: u32) -> Room {
    let mut stage = Stage::default();
    let grey = stage.material(0.5, 0.0);
    stage.room(grey, DVec3::ZERO, DVec3::new(10.0, 3.0, 8.0));
    for k in 0..24 {
        let share = |step: f64| (f64::from(k + 1) * step).fract();
        let height = if k % 4 == 0 { 0.8 } else { 0.0 };
        let size =
            DVec3::new(0.4 + 0.8 * share(0.33), 0.4 + 1.2 * share(0.77), 0.4 + 0.8 * share(0.57));
        let base = DVec3::new(0.8 + 8.4 * share(0.618_034), height, 0.8 + 6.4 * share(0.754_878));
        stage.block(grey, Block { base, size, turn: TAU * share(0.41) });
    }
    let surfaces = surfaces_of(&stage.scene);
    let settings = Settings { patch_size: Length::Metres(size), ..Settings::medium() };
    let mut mesh = Mesh::new(&surfaces, &settings);
    for _ in 0..levels {
        for leaf in mesh.leaves().collect::<Vec<_>>() {
            mesh.split(leaf, radiosity::mesh::Split::Quarters, Reason::Uniform);
        }
    }
    let (targets, map) = (HemicubeScene::new(&mesh.patches), ElementMap::new(&mesh));
    Room { occluders: Occluders::new(&surfaces), surfaces, mesh, targets, map }
}

/// Points of patches and their normals, by area.
fn eyes(mesh: &Mesh) -> Vec<SurfacePoint> {
    let total: f64 = mesh.patches.iter().map(|patch| patch.area).sum();
    let share = |k: usize, step: f64| ((k + 1) as f64 * step).fract();
    let eye = |k: usize| {
        let mut left = total * share(k, 0.618_034);
        let patch = mesh.patches.iter().find(|patch| {
            left -= patch.area;
            left <= 0.0
        });
        let patch = patch.unwrap_or(&mesh.patches[0]);
        let [a, b, c] = [0, 1, 2].map(|corner| patch.corners[corner]);
        let at = a.lerp(b, share(k, 0.754_878)).lerp(c, 0.9 * share(k, 0.569_84));
        SurfacePoint::new(at, patch.normal)
    };
    (0..LOOKS).map(eye).collect()
}

fn corners(room: &Room, leaf: ElementId) -> Vec<DVec3> {
    let plane = &room.surfaces[room.mesh.surface_of(leaf)].plane;
    room.mesh.outline(leaf).iter().map(|&position| plane.lift(position)).collect()
}
