//! Laws of the hierarchy: it holds every box once, keeps flat, and loses no hit.

use glam::{Vec3A, vec3a};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ray::Ray;
use proptest::prelude::*;
use radiosity::geometry::hierarchy::hierarchy;

fn boxes(range: f32, size: f32) -> impl Strategy<Value = Vec<Aabb>> {
    let corner = prop::array::uniform3(-range..range);
    let one = (corner, prop::array::uniform3(0.0..size)).prop_map(|(low, size)| {
        let low = Vec3A::from(low);
        Aabb::new(low, low + Vec3A::from(size))
    });
    prop::collection::vec(one, 0..200)
}

/// The boxes around the squares of an axis-parallel grid of `n` × `n`, in the plane across `axis`.
fn grid(n: usize, axis: usize, padding: f32) -> Vec<Aabb> {
    let place = |i: usize, j: usize| {
        let mut at = [i as f32, j as f32, 0.0];
        at.rotate_right((axis + 1) % 3);
        Vec3A::from(at)
    };
    let cells = (0..n * n).map(|k| (k / n, k % n));
    let padding = Vec3A::splat(padding);
    cells.map(|(i, j)| Aabb::new(place(i, j) - padding, place(i + 1, j + 1) + padding)).collect()
}

fn contains(outer: &Aabb, inner: &Aabb) -> bool {
    outer.min.cmple(inner.min).all() && outer.max.cmpge(inner.max).all()
}

/// Asserts the structure and returns the number of levels.
fn check(tree: &Bvh2, boxes: &[Aabb]) -> usize {
    let mut found = vec![0; boxes.len()];
    let mut levels = 0;
    let mut reached = 0;
    let mut open = if boxes.is_empty() { vec![] } else { vec![(0, 1)] };
    while let Some((index, level)) = open.pop() {
        let node = &tree.nodes[index];
        levels = levels.max(level);
        reached += 1;
        let first = node.first_index as usize;
        if node.is_leaf() {
            for &item in &tree.primitive_indices[first..first + node.prim_count as usize] {
                found[item as usize] += 1;
                assert!(contains(node.aabb(), &boxes[item as usize]), "leaf {index} holds {item}");
            }
        } else {
            for child in [first, first + 1] {
                assert!(contains(node.aabb(), tree.nodes[child].aabb()), "{index} around {child}");
                open.push((child, level + 1));
            }
        }
    }
    assert!(found.iter().all(|&count| count == 1), "every box is in one leaf");
    assert_eq!(reached, tree.nodes.len(), "no node is lost");
    assert_eq!(tree.max_depth, levels.max(1), "the tree knows its depth");
    assert_eq!(tree.primitive_indices.len(), boxes.len());
    levels
}

fn balanced(count: usize) -> usize {
    count.next_power_of_two().ilog2() as usize + 1
}

/// Boxes that a ray enters, by the tree's walk, in order of their places.
fn entered(tree: &Bvh2, ray: Ray) -> Vec<u32> {
    let mut found = Vec::new();
    tree.ray_traverse_anyhit(ray, |_, slot| found.push(tree.primitive_indices[slot]));
    found.sort_unstable();
    found
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_box_is_in_one_leaf_and_inside_all_above_it(boxes in boxes(10.0, 3.0)) {
        check(&hierarchy(&boxes), &boxes);
    }

    #[test]
    fn a_ray_reaches_every_box_it_enters(
        boxes in boxes(10.0, 3.0),
        from in prop::array::uniform3(-12.0f32..12.0),
        along in prop::array::uniform3(-1.0f32..1.0),
        straight in 0usize..6,
    ) {
        let direction = Vec3A::from(along).normalize_or(Vec3A::X);
        // Half of the rays run along an axis.
        let axis = [Vec3A::X, Vec3A::Y, Vec3A::Z];
        let direction = axis.get(straight).copied().unwrap_or(direction);
        let ray = Ray::new_inf(Vec3A::from(from), direction);
        let tree = hierarchy(&boxes);
        let reached = entered(&tree, ray);
        for (index, bounds) in boxes.iter().enumerate() {
            if bounds.intersect_ray(&ray) < f32::INFINITY {
                prop_assert!(reached.binary_search(&(index as u32)).is_ok(), "box {index} is lost");
            }
        }
    }

    #[test]
    fn rows_that_grow_like_powers_do_not_make_a_list(ratio in 1.05f32..4.0) {
        let place = |k: i32| Vec3A::splat(ratio.powi(k % 60)) * (1.0 + k as f32 * 1e-4);
        let boxes: Vec<Aabb> = (0..600).map(|k| Aabb::from_point(place(k))).collect();
        let levels = check(&hierarchy(&boxes), &boxes);
        prop_assert!(levels <= balanced(600) + 25, "{levels} levels");
    }
}

#[test]
fn ten_thousand_boxes_in_one_place_make_a_balanced_tree() {
    let same = Aabb::new(Vec3A::ZERO, Vec3A::ONE);
    for count in [1, 2, 3, 5, 17, 10_000] {
        let boxes = vec![same; count];
        let levels = check(&hierarchy(&boxes), &boxes);
        assert!(levels <= balanced(count), "{levels} levels for {count}");
    }
}

#[test]
fn no_boxes_make_a_tree_that_every_ray_misses() {
    let tree = hierarchy(&[]);
    assert!(tree.ray_traverse_miss(Ray::new_inf(Vec3A::ZERO, Vec3A::X), |_, _| 0.0));
}

#[test]
fn regular_grids_stay_flat() {
    for axis in 0..3 {
        let boxes = grid(100, axis, 0.0);
        let levels = check(&hierarchy(&boxes), &boxes);
        assert!(levels <= balanced(boxes.len()) + 4, "{levels} levels across {axis}");
    }
}

#[test]
fn a_far_outlier_and_numbers_out_of_range_do_no_harm() {
    let mut boxes = grid(20, 2, 0.0);
    boxes.push(Aabb::from_point(Vec3A::splat(1e30)));
    boxes.push(Aabb::from_point(Vec3A::splat(f32::MIN_POSITIVE / 4.0)));
    check(&hierarchy(&boxes), &boxes);
}

#[test]
fn rays_along_the_lines_of_a_padded_grid_meet_both_neighbours() {
    let n = 16;
    for axis in 0..3 {
        let boxes = grid(n, axis, 1e-5 * n as f32);
        let tree = hierarchy(&boxes);
        for k in 0..=2 * n {
            // Through the grid along its lines and between them, from in front, and inside its plane.
            let at = k as f32 / 2.0;
            for (origin, direction) in [
                (vec3a(at, at, 5.0), Vec3A::NEG_Z),
                (vec3a(at, -1.0, 0.0), Vec3A::Y),
                (vec3a(-1.0, at, 0.0), Vec3A::X),
            ] {
                let turned = |v: Vec3A| {
                    let mut v = v.to_array();
                    v.rotate_right((axis + 1) % 3);
                    Vec3A::from(v)
                };
                let ray = Ray::new_inf(turned(origin), turned(direction));
                let expected: Vec<u32> = (0..boxes.len() as u32)
                    .filter(|&b| boxes[b as usize].intersect_ray(&ray) < f32::INFINITY)
                    .collect();
                assert!(!expected.is_empty(), "{ray:?}");
                let reached = entered(&tree, ray);
                assert!(expected.iter().all(|b| reached.contains(b)), "{ray:?}");
            }
        }
    }
}
