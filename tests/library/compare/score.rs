//! Errors of meshes whose errors are known.

use glam::{DVec3, Vec2, Vec3};
use proptest::prelude::*;
use radiosity::colour::Rgb;
use radiosity::compare::{Origin, Point, Reference, Score, Set, score};
use radiosity::{TriMesh, reconstruct::MeshPart};

const SIDE: usize = 5;

/// A square of 1 m in the plane y = 0 that shows a linear field.
fn square(field: impl Fn(DVec3) -> Rgb) -> TriMesh {
    let at = |k: usize| k as f64 / (SIDE - 1) as f64;
    let places = (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| DVec3::new(at(i), 0.0, at(j))));
    let positions: Vec<DVec3> = places.collect();
    let number = |i: usize, j: usize| (i * SIDE + j) as u32;
    let cells = (1..SIDE).flat_map(|i| (1..SIDE).map(move |j| (i, j)));
    let triangles: Vec<[u32; 3]> = cells
        .flat_map(|(i, j)| {
            let [a, b] = [number(i - 1, j - 1), number(i - 1, j)];
            let [c, d] = [number(i, j), number(i, j - 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let count = positions.len();
    TriMesh {
        radiosity: positions.iter().map(|&p| field(p)).collect(),
        normals: vec![Vec3::Y; count],
        uvs: vec![Vec2::ZERO; count],
        texture_mean: vec![Rgb::ONE; count],
        parts: vec![MeshPart { triangles: 0..triangles.len(), ..MeshPart::default() }],
        positions,
        triangles,
        ..TriMesh::default()
    }
}

fn reference(field: impl Fn(DVec3) -> Rgb, error: f64) -> Reference {
    let points = (0..200)
        .map(|k| {
            let at = |step: f64| (0.5 + f64::from(k) * step).fract();
            let place = DVec3::new(at(0.754_877_666), 0.0, at(0.569_840_291));
            let set = if k % 4 == 0 { Set::Shadow } else { Set::Area };
            let error = Rgb::splat(error);
            Point { place, normal: DVec3::Y, radiosity: field(place), error, set, weight: 1.0 }
        })
        .collect();
    Reference::new(points, Origin::File("made up".into()), 1.5).unwrap()
}

fn check(score: &Score, expected: f64) {
    for errors in [&score.all, &score.shadow] {
        assert!((errors.rmse - expected).abs() < 1e-9, "{errors:?}");
    }
}

proptest! {
    #[test]
    fn a_linear_field_has_no_error(base in 1.0..5.0_f64, x in -0.4..0.4_f64, z in -0.4..0.4_f64) {
        let field = |p: DVec3| Rgb::new(base + p.x * x + p.z * z, base, base * 2.0);
        let found = score(&reference(field, 0.0), &square(field), 1.5);
        check(&found, 0.0);
        prop_assert_eq!(found.unmatched, 0);
        prop_assert!(found.all.max < 1e-9);
    }

    #[test]
    fn light_too_much_is_found_to_the_last_digit(share in -0.5..2.0_f64) {
        let found = score(&reference(|_| Rgb::splat(3.0), 0.0), &square(|_| Rgb::splat(3.0 * (1.0 + share))), 1.5);
        check(&found, share.abs());
        prop_assert!((found.all.bias - share).abs() < 1e-9);
        prop_assert!((found.all.median - share.abs()).abs() < 1e-9);
        prop_assert!((found.all.mean_absolute - share.abs()).abs() < 1e-9);
    }
}

#[test]
fn the_reference_s_own_variance_is_taken_off() {
    let field = |_| Rgb::splat(2.0);
    let mesh = square(|_| Rgb::splat(2.2));
    let found = score(&reference(field, 0.12), &mesh, 1.5);
    // 10 % measured, of which 6 % could be the reference's: √(0.1² - 0.06²) = 8 %.
    check(&found, 0.08);
    assert!((found.all.raw_rmse - 0.1).abs() < 1e-9 && (found.all.noise - 0.06).abs() < 1e-9);
    assert!(found.all.floor > 0.0 && found.all.floor < found.all.noise, "{:?}", found.all);
}

#[test]
fn places_without_a_triangle_count_as_black() {
    let field = |_| Rgb::splat(2.0);
    let mut mesh = square(field);
    mesh.triangles.truncate(2 * (SIDE - 1) * (SIDE - 1) / 2);
    mesh.parts[0].triangles = 0..mesh.triangles.len();
    let found = score(&reference(field, 0.0), &mesh, 1.5);
    assert!((90..=110).contains(&found.unmatched), "{}", found.unmatched);
    assert!((found.all.max - 1.0).abs() < 1e-9);

    let mut turned = square(field);
    turned.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    assert_eq!(score(&reference(field, 0.0), &turned, 1.5).unmatched, 200);
}
