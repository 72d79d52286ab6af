//! What is counted of meshes and solutions, and what rays meet first.

use glam::DVec3;
use proptest::prelude::*;
use radiosity::direct::Emitters;
use radiosity::mesh::{ElementId, Mesh};
use radiosity::surface::SurfaceId;
use radiosity::visibility::{Met, Occluders, SurfacePoint};
use radiosity::{Settings, Surfaces, TriMesh, reconstruct, surfaces_of};
use rayon::ThreadPoolBuilder;

use crate::common::{Block, coarse, furnished_room, shipped, solve};

fn room() -> Surfaces {
    let block = Block::spanning(DVec3::new(1.5, 0.0, 2.0), DVec3::new(2.5, 0.5, 3.0));
    surfaces_of(&furnished_room(&[block]))
}

fn triangle(corners: [DVec3; 3]) -> TriMesh {
    let positions = corners.to_vec();
    TriMesh { positions, triangles: vec![[0, 1, 2]], ..TriMesh::default() }
}

#[test]
fn angles_are_those_of_known_triangles() {
    let tall = |height: f64| triangle([DVec3::ZERO, DVec3::X, DVec3::new(0.5, height, 0.0)]);
    let round = tall(0.75_f64.sqrt()).angles();
    assert!((round.smallest - 60.0).abs() < 1e-9 && round.below_ten == 0.0);
    // Twice the angle whose tangent is ½ over the height.
    let slender = tall(0.5 / 4.0_f64.to_radians().tan()).angles();
    assert!((slender.smallest - 8.0).abs() < 1e-9, "{slender:?}");
    assert_eq!((slender.below_ten, slender.histogram[1]), (1.0, 1));
    assert_eq!(tall(0.0).angles().smallest, 0.0);
    assert_eq!(TriMesh::default().angles().histogram.iter().sum::<usize>(), 0);
}

#[test]
fn every_leaf_and_every_division_is_counted_once() {
    let solution = solve(&room(), &coarse());
    let mesh = &solution.mesh;
    let leaves = mesh.leaves().count();
    assert_eq!(mesh.leaves_by_level().iter().sum::<usize>(), leaves);
    assert_eq!(mesh.leaves_by_size().iter().map(|bin| bin.leaves).sum::<usize>(), leaves);
    let divided = mesh.divided();
    let reasons = divided.uniform
        + divided.gradient
        + divided.shadow_edge
        + divided.discontinuity
        + divided.contact;
    assert_eq!(reasons, mesh.elements.len() - leaves);
    assert!(divided.uniform == 0 && divided.shadow_edge > 0, "{divided:?}");
    for (octave, bin) in mesh.leaves_by_size().iter().enumerate() {
        let sizes = mesh.leaves().map(|leaf: ElementId| mesh[leaf].area.sqrt());
        let own = sizes.filter(|size| (bin.from..2.0 * bin.from).contains(size)).count();
        assert_eq!(own, bin.leaves, "octave {octave}");
    }
}

#[test]
fn work_is_the_same_with_any_number_of_threads_and_grows_with_the_mesh() {
    let surfaces = room();
    let work = |threads: usize, settings: &Settings| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solve(&surfaces, settings).work)
    };
    let one = work(1, &coarse());
    assert_eq!(one, work(3, &coarse()));
    assert_eq!(one.rays, 0, "light is exact");
    let fine = work(2, &Settings { tolerance: 0.02, ..coarse() });
    assert!(fine.direct > one.direct && fine.gathering > one.gathering, "{one:?} {fine:?}");
    let by_rays = work(2, &Settings { shadow_rays: Some(16), ..coarse() });
    // To each triangle of a lamp, where something may be in the way.
    assert!(by_rays.rays > 0 && by_rays.rays.is_multiple_of(16), "{by_rays:?}");
}

#[test]
fn an_adaptive_mesh_has_hanging_places_and_a_room_s_uniform_one_has_none() {
    let hanging = |surfaces: &Surfaces, settings: &Settings| {
        reconstruct(surfaces, &solve(surfaces, settings)).hanging
    };
    assert!(hanging(&room(), &coarse()) > 10);
    let empty = surfaces_of(&shipped("furnace.obj"));
    assert_eq!(hanging(&empty, &Settings { uniform: Some(0.25), ..coarse() }), 0);
}

#[test]
fn the_first_of_several_polygons_is_met_and_its_side_told() {
    let square =
        |z: f64| [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z));
    let squares = [square(3.0), square(1.0), square(2.0)];
    let occluders = Occluders::from_polygons(&squares.each_ref().map(|s| &s[..]), 1e-9);
    let from = |z: f64, direction: DVec3| occluders.first(DVec3::new(0.4, 0.6, z), direction);
    let met = |surface: u32, z: f64, front: bool| {
        Some(Met { place: DVec3::new(0.4, 0.6, z), surface: SurfaceId(surface), front })
    };
    assert_eq!(from(0.0, DVec3::Z), met(1, 1.0, false));
    assert_eq!(from(1.0, DVec3::Z), met(2, 2.0, false), "what the place lies on is passed");
    assert_eq!(from(9.0, DVec3::NEG_Z), met(0, 3.0, true));
    assert_eq!(from(9.0, DVec3::Z), None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]
    #[test]
    fn single_rays_to_lamps_are_right_on_the_mean(x in -1.0..1.0_f64, z in -1.0..1.0_f64) {
        let surfaces = surfaces_of(&shipped("blocker.obj"));
        let mesh = Mesh::new(&surfaces, &Settings::draft());
        let (lamps, occluders) = (Emitters::new(&surfaces, &mesh), Occluders::new(&surfaces));
        let place = DVec3::new(x, 0.0, z);
        let exact = lamps.shine(&occluders, place, DVec3::Y);
        // Two sequences that fill the square evenly: the mean is better than chance.
        let mut count = 0.0;
        let mut next = || {
            count += 1.0;
            let step = if count % 2.0 == 0.0 { 0.754_877_666_246_693 } else { 0.569_840_290_998_053 };
            ((count / 2.0_f64).ceil() * step).fract()
        };
        let rounds = 4000;
        let sum: DVec3 = (0..rounds).map(|_| lamps.sample_unbiased(&occluders, SurfacePoint::new(place, DVec3::Y), &mut next)).sum();
        let error = (sum / f64::from(rounds) - exact.irradiance).x / exact.unoccluded.x;
        prop_assert!(error.abs() < 0.01, "{error} at {place}");
    }
}
