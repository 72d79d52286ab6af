//! Laws of segments through occluders: regular meshes, where boxes are flat and rays run along
//! edges, lose none.

use glam::DVec3;
use proptest::prelude::*;
use radiosity::surfaces_of;
use radiosity::visibility::Occluders;

use crate::common::Stage;

const ACROSS: i32 = 16;

/// A vector with its axes moved on, so that z becomes the given axis.
fn turned(v: DVec3, axis: usize) -> DVec3 {
    let mut v = v.to_array();
    v.rotate_right((axis + 1) % 3);
    DVec3::from(v)
}

/// A wall in squares of two materials by turns, so that none are merged, in the plane across `axis`.
fn chequered(axis: usize) -> Occluders {
    let mut stage = Stage::default();
    let materials = [stage.material(0.2, 0.0), stage.material(0.8, 0.0)];
    for (i, j) in (0..ACROSS * ACROSS).map(|k| (k / ACROSS, k % ACROSS)) {
        let at = |x: i32, y: i32| turned(DVec3::new(f64::from(x), f64::from(y), 0.0), axis);
        let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        stage.polygon(materials[(i + j) as usize % 2], &corners);
    }
    Occluders::new(&surfaces_of(&stage.scene))
}

#[test]
fn no_segment_slips_through_the_joints_of_a_regular_wall() {
    for axis in 0..3 {
        let wall = chequered(axis);
        for k in 0..(4 * ACROSS + 1).pow(2) {
            let place = |k: i32| f64::from(k) / 4.0;
            let (x, y) = (place(k / (4 * ACROSS + 1)), place(k % (4 * ACROSS + 1)));
            let at = DVec3::new(x, y, 0.0);
            for slant in [DVec3::Z, DVec3::new(0.0, 0.5, 1.0), DVec3::new(-0.25, 0.5, 1.0)] {
                let ends = [at + slant, at - slant].map(|end| turned(end, axis));
                assert!(wall.blocks(ends[0], ends[1]), "through {at} along {slant} across {axis}");
            }
        }
        // Inside the wall's own plane and beside it, nothing stands in the way.
        for height in [0.0, 0.5] {
            let ends = [DVec3::new(-1.0, 3.0, height), DVec3::new(20.0, 3.0, height)];
            let [a, b] = ends.map(|end| turned(end, axis));
            assert!(!wall.blocks(a, b), "along the wall at {height} across {axis}");
        }
    }
}

/// Whether a segment crosses a triangle; `None` if it is too near an edge to tell.
fn crosses([a, b, c]: [DVec3; 3], from: DVec3, to: DVec3) -> Option<bool> {
    let volume = |p: DVec3, q: DVec3, r: DVec3| (p - from).cross(q - from).dot(r - from);
    let sides = [volume(a, b, to), volume(b, c, to), volume(c, a, to)];
    let heights = [volume(a, b, c), -(a - to).cross(b - to).dot(c - to)];
    let clear = sides.iter().chain(&heights).all(|v| v.abs() > 1e-5);
    let same = |v: &[f64]| v.iter().all(|&v| v > 0.0) || v.iter().all(|&v| v < 0.0);
    clear.then(|| same(&sides) && same(&heights))
}

fn point() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(DVec3::from)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_segment_is_blocked_where_a_test_of_every_triangle_says_so(
        triangles in prop::collection::vec([point(), point(), point()], 1..20),
        segments in prop::collection::vec((point(), point()), 20),
    ) {
        let triangles: Vec<[DVec3; 3]> = triangles
            .into_iter()
            .filter(|[a, b, c]| (b - a).cross(c - a).length() > 0.05)
            .collect();
        let mut stage = Stage::default();
        let grey = stage.material(0.5, 0.0);
        for triangle in &triangles {
            stage.polygon(grey, triangle);
        }
        let occluders = Occluders::new(&surfaces_of(&stage.scene));
        for (from, to) in segments {
            let crossed: Option<Vec<bool>> =
                triangles.iter().map(|&triangle| crosses(triangle, from, to)).collect();
            let Some(crossed) = crossed else { continue };
            prop_assert_eq!(occluders.blocks(from, to), crossed.contains(&true), "{} {}", from, to);
        }
    }
}
