//! Laws of whole matrices: reciprocity, closure, additivity, and a matrix that is made to keep them.

use std::f64::consts::{FRAC_PI_4, SQRT_2};
use std::ops::ControlFlow;

use glam::DVec3;
use proptest::prelude::*;
use radiosity::form_factor::pair::{exchange, visible_exchange};
use radiosity::form_factor::{Assembled, FormFactorMethod, FormFactors, assemble};
use radiosity::geometry::{HalfSpace, PlanarPolygon};
use radiosity::mesh::Mesh;
use radiosity::visibility::Occluders;
use radiosity::{Length, Scene, Settings, surfaces_of};

use crate::common::{Block, Stage, furnished_room};

fn room() -> Scene {
    furnished_room(&[
        Block { base: DVec3::new(1.2, 0.0, 1.3), size: DVec3::new(0.8, 1.2, 0.7), turn: 0.5 },
        Block { base: DVec3::new(2.9, 0.9, 3.3), size: DVec3::new(0.9, 0.6, 1.1), turn: -0.2 },
    ])
}

fn matrix(scene: &Scene, size: f64, method: FormFactorMethod) -> Assembled {
    let surfaces = surfaces_of(scene);
    let settings = Settings { patch_size: Length::Metres(size), ..Settings::draft() };
    let patches = Mesh::new(&surfaces, &settings).patches;
    assemble(&patches, &Occluders::new(&surfaces), method, |_| ControlFlow::Continue(()))
}

/// Largest difference from one of a row's sum, light on backs included.
fn closure(assembled: &Assembled) -> f64 {
    let sums = assembled.factors.row_sums().into_iter().zip(&assembled.on_backs);
    sums.map(|(sum, backs)| (1.0 - sum - backs).abs()).fold(0.0, f64::max)
}

#[test]
fn rows_of_a_closed_room_sum_to_one_by_every_method() {
    let methods = [
        (FormFactorMethod::Contour, 4e-4),
        (FormFactorMethod::Hemicube(256), 0.03),
        (FormFactorMethod::Rays(16_384), 0.03),
    ];
    for (method, tolerance) in methods {
        let assembled = matrix(&room(), 1.0, method);
        let (closure, n) = (closure(&assembled), assembled.factors.len());
        assert!(n > 100 && closure < tolerance, "{method:?}: {closure} in {n} rows");
        assert!(assembled.factors.reciprocity() < 1e-12, "{method:?}");
    }
}

#[test]
fn rows_of_plain_sums_are_full_however_coarse_but_not_reciprocal() {
    let exact = matrix(&room(), 1.0, FormFactorMethod::Contour).factors;
    let mut errors = Vec::new();
    for cells in [32, 512] {
        let assembled = matrix(&room(), 1.0, FormFactorMethod::HemicubeSum(cells));
        assert!(closure(&assembled) < 1e-4, "{cells} cells: {}", closure(&assembled));
        let factors = assembled.factors;
        assert!(factors.reciprocity() > 0.01, "{cells} cells: {}", factors.reciprocity());
        let pairs = (0..exact.len()).flat_map(|i| (0..exact.len()).map(move |j| (i, j)));
        let errors_of = pairs.map(|(i, j)| (factors.get(i, j) - exact.get(i, j)).abs());
        errors.push(errors_of.sum::<f64>() / exact.len() as f64);
    }
    // What is left is that a centre stands for all of its patch.
    assert!(errors[1] < 0.9 * errors[0] && errors[1] > 0.01, "{errors:?}");
}

/// A room of a metre's patches with a box of which two corners jut out by `width`, m, over borders of
/// patches of the floor, and a thin screen that cuts as little off the corner of another.
fn room_with_slivers(width: f64) -> Scene {
    let mut stage = Stage::default();
    let (grey, both) = (stage.material(0.5, 0.0), stage.double_sided(0.5, 0.0));
    stage.room(grey, DVec3::ZERO, DVec3::new(4.0, 3.0, 5.0));
    let side = SQRT_2 * (0.2 + width);
    let (base, size) = (DVec3::new(3.2, 0.0, 1.2), DVec3::new(side, 0.7, side));
    stage.block(grey, Block { base, size, turn: FRAC_PI_4 });
    let (from, to) = (DVec3::new(1.3 - width, 0.0, 4.7), DVec3::new(2.7 - width, 0.0, 3.3));
    stage.polygon(both, &[from, to, to.with_y(2.0), from.with_y(2.0)]);
    stage.scene
}

#[test]
fn slivers_under_boxes_see_the_box_alone_and_those_beside_screens_one_side() {
    for width in [1e-3, 1e-4] {
        let scene = room_with_slivers(width);
        let epsilon = surfaces_of(&scene).epsilon;
        let Assembled { factors, on_backs, .. } = matrix(&scene, 1.0, FormFactorMethod::Contour);
        let is_sliver = |area: f64| area < 2.0 * width * width;
        assert_eq!(factors.areas().iter().filter(|&&area| is_sliver(area)).count(), 3);
        for (i, (sum, backs)) in factors.row_sums().into_iter().zip(on_backs).enumerate() {
            let miss = (1.0 - sum - backs).abs();
            let is_covered = factors.row(i).any(|(_, factor)| factor > 0.999);
            let beside = is_sliver(factors.areas()[i]) && !is_covered;
            // Half a sliver's sight is the screen's, and all within the tolerance is in its plane.
            let allowed = if beside { epsilon / width } else { 4e-4 };
            assert!(miss < allowed, "row {i} of a sliver {width} m wide: {sum}");
        }
    }
}

#[test]
fn an_enforced_matrix_is_reciprocal_and_closed_and_within_bounds() {
    let Assembled { factors, on_backs, .. } = matrix(&room(), 1.2, FormFactorMethod::Hemicube(64));
    let sums: Vec<f64> = on_backs.iter().map(|backs| 1.0 - backs).collect();
    let enforced = factors.enforced(&sums);
    assert!(enforced.reciprocity() < 1e-9, "{}", enforced.reciprocity());
    for (i, (sum, expected)) in enforced.row_sums().into_iter().zip(&sums).enumerate() {
        assert!((sum - expected).abs() < 1e-9, "row {i} sums to {sum}");
        for (j, factor) in enforced.row(i) {
            let most = enforced.areas()[i].min(enforced.areas()[j]) / enforced.areas()[i];
            assert!((0.0..=most + 1e-9).contains(&factor), "{factor} from {i} to {j}");
            let before = factors.get(i, j);
            assert!((factor - before).abs() < 0.05 * before + 1e-9, "{factor} for {before}");
        }
    }
}

#[test]
fn what_is_interrupted_has_whole_rows_and_empty_ones() {
    let surfaces = surfaces_of(&room());
    let settings = Settings { patch_size: Length::Metres(0.8), ..Settings::draft() };
    let patches = Mesh::new(&surfaces, &settings).patches;
    let occluders = Occluders::new(&surfaces);
    let stop =
        |done: f64| if done > 0.2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let part = assemble(&patches, &occluders, FormFactorMethod::Contour, stop);
    let whole =
        assemble(&patches, &occluders, FormFactorMethod::Contour, |_| ControlFlow::Continue(()));
    assert!((1..patches.len()).contains(&part.rows), "{} rows", part.rows);
    for i in 0..patches.len() {
        let row = |factors: &FormFactors| factors.row(i).collect::<Vec<_>>();
        let expected = if i < part.rows { row(&whole.factors) } else { Vec::new() };
        assert_eq!(row(&part.factors), expected, "row {i}");
    }
}

#[test]
fn grouped_patches_exchange_what_their_parts_do() {
    let factors = matrix(&room(), 1.5, FormFactorMethod::Contour).factors;
    let group: Vec<usize> = (0..factors.len()).map(|i| i % 7).collect();
    let grouped = factors.grouped(&group, 7);
    let area: f64 = factors.areas().iter().sum();
    assert!((grouped.areas().iter().sum::<f64>() / area - 1.0).abs() < 1e-12);
    assert!(grouped.reciprocity() < 1e-12);
    for (i, sum) in grouped.row_sums().into_iter().enumerate() {
        assert!((sum - 1.0).abs() < 4e-4, "row {i} sums to {sum}");
    }
}

fn point() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(DVec3::from)
}

fn triangle(centre: DVec3) -> impl Strategy<Value = [DVec3; 3]> {
    (point(), point(), point())
        .prop_map(move |(a, b, c)| [a + centre, b + centre, c + centre])
        .prop_filter("slender", |[a, b, c]| (b - a).cross(c - a).length() > 0.3)
}

fn facet<'a>(corners: &'a [DVec3], towards: DVec3) -> PlanarPolygon<'a> {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
    PlanarPolygon::new(corners, normal * normal.dot(towards - corners[0]).signum())
}

#[test]
fn metres_and_millimetres_give_the_same_shares() {
    let square = |z: f64, size: f64, turn: f64| {
        let corner = |k: u32| {
            let angle = turn * (std::f64::consts::FRAC_PI_2 * f64::from(k) + 0.3);
            DVec3::new(size * angle.cos(), size * angle.sin(), z)
        };
        [0, 1, 2, 3].map(corner)
    };
    let share = |unit: f64| {
        let scaled = |corners: [DVec3; 4]| corners.map(|corner| corner * unit);
        let [a, b] = [scaled(square(0.0, 0.8, 1.0)), scaled(square(1.0, 0.6, -1.0))];
        let blocker = scaled(square(0.6, 0.3, 1.0));
        let occluders = Occluders::from_polygons(&[&blocker], 1e-7 * unit);
        let (first, second) = (facet(&a, b[0]), facet(&b, a[0]));
        visible_exchange(&occluders, first, second, 1e-4) / exchange(first, second)
    };
    let metres = share(1.0);
    assert!((0.2..0.9).contains(&metres), "some of it is hidden: {metres}");
    for unit in [1e-3, 0.3048, 1e3] {
        assert!((share(unit) / metres - 1.0).abs() < 1e-9, "{} in units of {unit} m", share(unit));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn exchanges_are_symmetric_and_parts_add_up(
        a in triangle(DVec3::ZERO), b in triangle(DVec3::Z * 1.7), normal in point(),
    ) {
        let (first, second) = (facet(&a, DVec3::Z * 1.7), facet(&b, DVec3::ZERO));
        let there = exchange(first, second);
        let back = exchange(second, first);
        prop_assert!((there - back).abs() < 1e-6 * there + 1e-12, "{there} and {back} m²");
        let side = HalfSpace::new(DVec3::Z * 1.7, normal.normalize_or(DVec3::X));
        let parts = [side.clip(&b), side.complement().clip(&b)];
        let whole = parts.iter().filter(|part| !part.is_empty());
        let sum: f64 = whole.map(|p| exchange(first, PlanarPolygon { corners: p, ..second })).sum();
        prop_assert!((there - sum).abs() < 2e-6 * there + 1e-9, "{there} whole, {sum} in parts");
    }

    #[test]
    fn visible_exchanges_are_symmetric_and_below_the_unhidden(
        a in triangle(DVec3::ZERO), b in triangle(DVec3::Z * 4.0), blocker in triangle(DVec3::Z * 2.0),
    ) {
        let (first, second) = (facet(&a, DVec3::Z * 4.0), facet(&b, DVec3::ZERO));
        let occluders = Occluders::from_polygons(&[&blocker], 1e-9);
        let all = exchange(first, second);
        let there = visible_exchange(&occluders, first, second, 1e-6);
        let back = visible_exchange(&occluders, second, first, 1e-6);
        prop_assert!((0.0..=all * (1.0 + 1e-6) + 1e-12).contains(&there), "{there} of {all} m²");
        prop_assert!((there - back).abs() < 1e-5, "{there} and {back} m²");
    }
}
