//! A bounding volume hierarchy by the surface area heuristic, in the form in which obvhs keeps it.
//!
//! obvhs merges neighbours bottom-up, and equal costs, of which a regular mesh is full, make lists
//! of its trees. Splitting top-down knows no such ties. Single rays from a place in a room whose
//! walls are 98 304 equal rectangles, same nodes, walk and test, one thread, the best of some hundred runs
//! (`cargo bench --bench bvh`):
//!
//! | builder | build, ms | rays, million a second |
//! |---|---|---|
//! | obvhs, `medium_build` | 36 | 0.06 |
//! | obvhs, `slow_build` | 75 | 0.09 |
//! | obvhs, `very_slow_build` | 600 | 0.23 |
//! | this | 35 | 4.0 |
//!
//! Boxes padded by 0.1 mm differ in their last bits, which breaks the ties by luck: then all four
//! let 3 to 4 million rays through.

use glam::{DVec3, UVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::ray::Ray;

/// Places along each axis at which a node may be split, plus one.
const BINS: usize = 16;

/// Most boxes in a leaf.
const LEAF: usize = 4;

/// Cost of visiting a node, in tests of a box's content.
const VISIT: f32 = 0.5;

/// Levels beyond those of a balanced tree before nodes are simply halved.
const PATIENCE: u32 = 24;

/// A box and its place in the input.
#[derive(Clone, Copy)]
struct Item {
    bounds: Aabb,
    index: u32,
}

/// A node whose children are yet to be made.
struct UnsplitNode {
    node: usize,
    items: std::ops::Range<usize>,
    level: usize,
}

/// Where to split: between two bins along an axis.
#[derive(Clone, Copy)]
struct BinSplit {
    axis: usize,
    /// Last bin of the lower side.
    bin: u32,
    cost: f32,
}

/// Bins over the box of the items' centres.
struct Bins {
    low: Vec3A,
    scale: Vec3A,
    /// By axis and bin.
    counts: [[u32; BINS]; 3],
    bounds: [[Aabb; BINS]; 3],
}

/// A tree of boxes, in which every box is in exactly one leaf; the same for the same input.
///
/// Its depth is at most ⌈log₂ n⌉ + 25 levels, however the boxes lie. `primitive_indices` holds
/// places in `boxes`, in the order of the leaves.
pub fn hierarchy(boxes: &[Aabb]) -> Bvh2 {
    let numbered = boxes.iter().zip(0..);
    let mut items: Vec<Item> = numbered.map(|(&bounds, index)| Item { bounds, index }).collect();
    let mut tree = Bvh2 { max_depth: 1, ..Bvh2::default() };
    if items.is_empty() {
        return tree;
    }
    let deepest = levels(items.len()) + PATIENCE;
    tree.nodes.push(leaf(&items, 0..items.len()));
    let mut open = vec![UnsplitNode { node: 0, items: 0..items.len(), level: 1 }];
    while let Some(UnsplitNode { node, items: range, level }) = open.pop() {
        tree.max_depth = tree.max_depth.max(level);
        let patient = level as u32 + levels(range.len()) <= deepest;
        let bounds = *tree.nodes[node].aabb();
        let Some(lower) = split(&mut items[range.clone()], &bounds, patient) else { continue };
        let middle = range.start + lower;
        let first = tree.nodes.len();
        tree.nodes[node].make_inner(first as u32);
        for (side, items_of) in [range.start..middle, middle..range.end].into_iter().enumerate() {
            tree.nodes.push(leaf(&items, items_of.clone()));
            open.push(UnsplitNode { node: first + side, items: items_of, level: level + 1 });
        }
    }
    tree.primitive_indices = items.iter().map(|item| item.index).collect();
    tree
}

/// A ray through a hierarchy, along a unit vector for so far, in the hierarchy's units.
///
/// The fourth lane of a node's corners holds counts, which as floating point numbers are subnormal; less an origin's
/// lane of zero they would stay so, and each product with them would take a hundred cycles.
pub(crate) fn ray(origin: DVec3, direction: DVec3, length: f32) -> Ray {
    let origin = Vec3A::from_vec4(origin.as_vec3().extend(1.0));
    Ray::new(origin, direction.as_vec3a(), 0.0, length)
}

/// Places in the input of the boxes that overlap one, ascending.
pub(crate) fn overlapping(tree: &Bvh2, bounds: Aabb) -> Vec<u32> {
    let mut near = Vec::new();
    let mut stack: Vec<u32> = tree.nodes.first().map(|_| 0).into_iter().collect();
    while let Some(index) = stack.pop() {
        let node = &tree.nodes[index as usize];
        let overlaps =
            node.aabb().min.cmple(bounds.max).all() && node.aabb().max.cmpge(bounds.min).all();
        if !overlaps {
            continue;
        }
        if !node.is_leaf() {
            stack.extend([node.first_index, node.first_index + 1]);
            continue;
        }
        let first = node.first_index as usize;
        near.extend(&tree.primitive_indices[first..first + node.prim_count as usize]);
    }
    near.sort_unstable();
    near
}

/// Levels below the root of a balanced tree of `count` leaves.
fn levels(count: usize) -> u32 {
    count.next_power_of_two().ilog2()
}

/// A leaf with a range of the items.
fn leaf(items: &[Item], range: std::ops::Range<usize>) -> Bvh2Node {
    let bounds = items[range.clone()].iter().fold(Aabb::INVALID, |b, item| b.union(&item.bounds));
    Bvh2Node::new(bounds, range.len() as u32, range.start as u32)
}

/// Sorts the items of a node into those of its two children and returns how many the first gets;
/// `None` if they should stay together.
fn split(items: &mut [Item], bounds: &Aabb, patient: bool) -> Option<usize> {
    let small = items.len() <= LEAF;
    if items.len() < 2 {
        return None;
    }
    let bins = Bins::new(items);
    let whole = bounds.half_area() * items.len() as f32;
    let best = bins.best().filter(|best| !small || bounds.half_area() * VISIT + best.cost < whole);
    match best {
        Some(best) if patient => {
            let lower = partition(items, |item| bins.bin(item)[best.axis] <= best.bin);
            Some(lower).filter(|lower| (1..items.len()).contains(lower)).or(Some(items.len() / 2))
        }
        _ if small => None,
        // Centres all in one place, or a tree too deep.
        _ => Some(items.len() / 2),
    }
}

/// Moves the items that `belong` to the front and returns their number.
fn partition(items: &mut [Item], belong: impl Fn(&Item) -> bool) -> usize {
    let mut front = 0;
    for k in 0..items.len() {
        if belong(&items[k]) {
            items.swap(front, k);
            front += 1;
        }
    }
    front
}

impl Bins {
    fn new(items: &[Item]) -> Self {
        let centres = || items.iter().map(|item| item.bounds.center());
        let low = centres().fold(Vec3A::INFINITY, Vec3A::min);
        let high = centres().fold(Vec3A::NEG_INFINITY, Vec3A::max);
        let extent = high - low;
        let scale = Vec3A::select(
            extent.cmpgt(Vec3A::ZERO),
            Vec3A::splat(BINS as f32) / extent,
            Vec3A::ZERO,
        );
        let (counts, bounds) = ([[0; BINS]; 3], [[Aabb::INVALID; BINS]; 3]);
        let mut bins = Self { low, scale, counts, bounds };
        for item in items {
            let bin = bins.bin(item);
            for axis in 0..3 {
                let k = bin[axis] as usize;
                bins.counts[axis][k] += 1;
                bins.bounds[axis][k] = bins.bounds[axis][k].union(&item.bounds);
            }
        }
        bins
    }

    /// The bin of an item along each axis.
    fn bin(&self, item: &Item) -> UVec3 {
        // Casting takes what is not a number for zero.
        let place = (item.bounds.center() - self.low) * self.scale;
        place.as_uvec3().min(UVec3::splat(BINS as u32 - 1))
    }

    /// The split of least cost; of equal ones the first. `None` if the centres are all in one place.
    fn best(&self) -> Option<BinSplit> {
        let mut best: Option<BinSplit> = None;
        for axis in (0..3).filter(|&axis| self.scale[axis] > 0.0) {
            let mut above = [0.0; BINS];
            let (mut bounds, mut count) = (Aabb::INVALID, 0);
            for k in (1..BINS).rev() {
                bounds = bounds.union(&self.bounds[axis][k]);
                count += self.counts[axis][k];
                above[k] = cost(&bounds, count);
            }
            let (mut bounds, mut count) = (Aabb::INVALID, 0);
            for k in 0..BINS - 1 {
                bounds = bounds.union(&self.bounds[axis][k]);
                count += self.counts[axis][k];
                let cost = cost(&bounds, count) + above[k + 1];
                if best.is_none_or(|best| cost < best.cost) {
                    best = Some(BinSplit { axis, bin: k as u32, cost });
                }
            }
        }
        best
    }
}

/// What a child is expected to cost, times the area of its parent.
fn cost(bounds: &Aabb, count: u32) -> f32 {
    if count == 0 { 0.0 } else { bounds.half_area() * count as f32 }
}
