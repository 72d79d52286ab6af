//! Laws of the hemicube: what its cells see, by patch and by element, and on what processor.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::common::{Block, Stage, coarse, furnished_room};
use glam::DVec3;
use proptest::prelude::*;
use radiosity::form_factor::contour::point_to_polygon;
use radiosity::form_factor::hemicube::{
    DeltaFactors, ElementMap, ElementSums, Hemicube, HemicubeScene, LeafSum, VisiblePatch,
};
use radiosity::mesh::{ElementId, Mesh, Reason, Split};
use radiosity::surface::Surfaces;
use radiosity::visibility::{Occluders, SurfacePoint};
use radiosity::{Length, Settings, surfaces_of};

fn block() -> impl Strategy<Value = Block> {
    let base = (0.7..3.3, 0.0..1.5, 0.7..4.3).prop_map(DVec3::from);
    let size = (0.1..1.2, 0.1..1.2, 0.1..1.2).prop_map(DVec3::from);
    (base, size, 0.0..TAU).prop_map(|(base, size, turn)| Block { base, size, turn })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn every_processor_sees_the_same(
        blocks in prop::collection::vec(block(), 0..5),
        (x, y, z) in (0.1..3.9, 0.1..2.7, 0.1..4.9),
        normal in (-1.0..1.0, -1.0..1.0, -1.0..1.0),
        turn in 0.0..TAU,
        resolution in 16_usize..60,
    ) {
        let surfaces = surfaces_of(&furnished_room(&blocks));
        let mut mesh = Mesh::new(&surfaces, &coarse());
        divide(&mut mesh, 2);
        let (targets, map) = (HemicubeScene::new(&mesh.patches), ElementMap::new(&mesh));
        let occluders = Occluders::new(&surfaces);
        let delta = DeltaFactors::new(2 * resolution);
        let mut fast = Hemicube::new(&delta, &targets, &occluders);
        let mut plain = fast.clone().portable();
        let normal = DVec3::from(normal).normalize_or(DVec3::Y);
        let eye = SurfacePoint::new(DVec3::new(x, y, z), normal);
        let (fast, plain) = (fast.look(eye, turn), plain.look(eye, turn));
        prop_assert!(fast.items().eq(plain.items()));
        let sights = |hemicube: &Hemicube<'_>| hemicube.visible_patches().collect::<Vec<VisiblePatch>>();
        prop_assert_eq!(sights(fast), sights(plain));
        let (mut these, mut those) = (ElementSums::new(&map), ElementSums::new(&map));
        prop_assert_eq!(these.of(fast), those.of(plain));
    }
}

/// Divides about two of three leaves, in all ways there are, `levels` times.
fn divide(mesh: &mut Mesh, levels: u32) {
    for _ in 0..levels {
        for leaf in mesh.leaves().collect::<Vec<_>>() {
            let split = match (leaf.0 % 5, mesh[leaf].corners.len()) {
                (0 | 3, _) => continue,
                (k @ (1 | 2), 4) => Split::Halves(k as usize - 1),
                _ => Split::Quarters,
            };
            mesh.split(leaf, split, Reason::Uniform);
        }
    }
}

/// A room 2 m high over a convex floor, of whole walls.
fn prism(floor: &[[f64; 2]]) -> Surfaces {
    let mut stage = Stage::default();
    let grey = stage.material(0.5, 0.0);
    let at = |k: usize, y: f64| DVec3::new(floor[k % floor.len()][0], y, floor[k % floor.len()][1]);
    let n = floor.len();
    stage.polygon(grey, &(0..n).map(|k| at(k, 0.0)).collect::<Vec<_>>());
    stage.polygon(grey, &(0..n).rev().map(|k| at(k, 2.0)).collect::<Vec<_>>());
    for k in 0..n {
        stage.polygon(grey, &[at(k + 1, 0.0), at(k, 0.0), at(k, 2.0), at(k + 1, 2.0)]);
    }
    surfaces_of(&stage.scene)
}

#[test]
fn cells_go_to_the_elements_that_they_see() {
    let floors: [&[[f64; 2]]; 3] = [
        &[[0.0, 0.0], [0.5, 3.0], [2.5, 1.0]],
        &[[0.0, 0.0], [0.3, 2.0], [2.5, 2.5], [2.0, 0.2]],
        &[[0.0, 0.0], [-0.5, 1.5], [1.0, 3.0], [2.5, 1.8], [2.0, 0.2]],
    ];
    let whole = Settings { patch_size: Length::Metres(20.0), ..coarse() };
    let delta = DeltaFactors::new(256);
    for floor in floors {
        let surfaces = prism(floor);
        let mut mesh = Mesh::new(&surfaces, &whole);
        divide(&mut mesh, 4);
        let (targets, map) = (HemicubeScene::new(&mesh.patches), ElementMap::new(&mesh));
        let occluders = Occluders::new(&surfaces);
        let mut hemicube = Hemicube::new(&delta, &targets, &occluders);
        let mut sums = ElementSums::new(&map);
        for (k, normal) in
            [DVec3::Y, DVec3::X, DVec3::NEG_Y, DVec3::ONE.normalize()].iter().enumerate()
        {
            let eye = DVec3::new(0.8, 0.9, 1.0);
            let hemicube = hemicube.look(SurfacePoint::new(eye, *normal), k as f64);
            let mut seen: BTreeMap<ElementId, f64> = BTreeMap::new();
            for &LeafSum { leaf, sum } in sums.of(hemicube) {
                let before = seen.insert(map.leaves()[leaf as usize], sum.into());
                assert_eq!(before, None, "leaf {leaf} is there twice");
            }
            for leaf in mesh.leaves() {
                let plane = &surfaces[mesh.surface_of(leaf)].plane;
                let corners: Vec<DVec3> =
                    mesh.outline(leaf).iter().map(|&p| plane.lift(p)).collect();
                let exact = point_to_polygon(eye, *normal, &corners);
                let cells = seen.get(&leaf).copied().unwrap_or(0.0);
                assert!((cells - exact).abs() < 1e-3, "{cells} for {exact} of {leaf:?}");
            }
            for sight in hemicube.visible_patches() {
                let own = seen.iter().filter(|(leaf, _)| mesh[**leaf].patch == sight.patch);
                let sum: f64 = own.map(|(_, sum)| sum).sum();
                assert!((sum - sight.delta).abs() < 1e-5, "{sum} for {sight:?}");
            }
        }
    }
}
