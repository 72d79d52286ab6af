//! Boxes in boxes: which of many lie where something is looked for, without looking at all of them.

use std::ops::Range;

use glam::DVec3;

/// A box along the axes, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aabb {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

/// Few enough to look at one by one.
const FEW: usize = 8;

/// Around nothing.
const NOWHERE: Aabb = Aabb { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

impl Aabb {
    /// The smallest that holds two.
    fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// That of one point.
    fn of_point(point: DVec3) -> Self {
        Self { low: point, high: point }
    }

    /// m.
    pub(crate) fn middle(self) -> DVec3 {
        self.low.midpoint(self.high)
    }

    /// m.
    pub(crate) fn diagonal(self) -> f64 {
        self.low.distance(self.high)
    }

    /// How far it reaches from its middle along a unit vector, m.
    pub(crate) fn half_extent(self, direction: DVec3) -> f64 {
        (self.high - self.low).dot(direction.abs()) / 2.0
    }

    /// That which reaches so much further on all sides.
    pub(crate) fn grown(self, margin: f64) -> Self {
        Self { low: self.low - margin, high: self.high + margin }
    }
}

/// The box around points.
pub(crate) fn around(points: impl IntoIterator<Item = DVec3>) -> Aabb {
    points.into_iter().map(Aabb::of_point).fold(NOWHERE, Aabb::union)
}

/// How many times its size a box may be from the origin before single precision shows: it holds places there to a
/// millionth of the size.
const FAR: f64 = 16.0;

/// A place in a box far from the origin around which its places are to be told in single precision; itself a round
/// number, and exact in that. `None` for a box that is not far.
pub(crate) fn local_origin(low: DVec3, high: DVec3) -> Option<DVec3> {
    let size = (high - low).max_element();
    let far = low.abs().max(high.abs()).max_element();
    if !(size > 0.0 && far > FAR * size && far.is_finite()) {
        return None;
    }
    let unit = size.log2().floor().exp2();
    Some((((low + high) / (2.0 * unit)).round() * unit).as_vec3().as_dvec3())
}

/// Boxes in an order in which neighbours are close, under a binary tree of the boxes around them.
#[derive(Debug)]
pub(crate) struct Tree {
    boxes: Vec<Aabb>,
    order: Vec<u32>,
    nodes: Vec<BoxNode>,
}

#[derive(Debug)]
struct BoxNode {
    bounds: Aabb,
    /// Of the order.
    range: Range<u32>,
    /// The second child; the first follows its parent. None has number 0, which is the root's.
    second: u32,
}

impl Tree {
    /// Divides in the middle, so that the depth is that of a logarithm.
    pub(crate) fn new(boxes: Vec<Aabb>) -> Self {
        let (count, nodes) = (boxes.len(), Vec::new());
        let mut tree = Self { boxes, order: (0..count as u32).collect(), nodes };
        tree.build(0..count);
        tree
    }

    fn build(&mut self, range: Range<usize>) {
        let all = self.order[range.clone()].iter().map(|&index| self.boxes[index as usize]);
        let bounds = all.fold(NOWHERE, Aabb::union);
        let node = self.nodes.len();
        let numbers = range.start as u32..range.end as u32;
        self.nodes.push(BoxNode { bounds, range: numbers, second: 0 });
        if range.len() > FEW {
            let axis = (bounds.high - bounds.low).max_position();
            let boxes = &self.boxes;
            let middle = |index: u32| {
                let Aabb { low, high } = boxes[index as usize];
                low[axis] + high[axis]
            };
            let half = range.len() / 2;
            self.order[range.clone()].select_nth_unstable_by(half, |&a, &b| {
                middle(a).total_cmp(&middle(b)).then(a.cmp(&b))
            });
            self.build(range.start..range.start + half);
            self.nodes[node].second = self.nodes.len() as u32;
            self.build(range.start + half..range.end);
        }
    }

    /// The boxes, by index.
    pub(crate) fn boxes(&self) -> &[Aabb] {
        &self.boxes
    }

    /// Puts the indices of the boxes that something meets into `found`, in rising order.
    ///
    /// What meets a box must meet all boxes around it.
    pub(crate) fn find(&self, meets: impl Fn(Aabb) -> bool, found: &mut Vec<u32>) {
        found.clear();
        let mut stack = vec![0];
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !meets(node.bounds) {
                continue;
            }
            if node.second > 0 {
                stack.extend([index + 1, node.second]);
            } else {
                let members = &self.order[node.range.start as usize..node.range.end as usize];
                found.extend(members.iter().filter(|&&member| meets(self.boxes[member as usize])));
            }
        }
        found.sort_unstable();
    }
}

/// True if two boxes are at most this far from each other along every axis, m.
pub(crate) fn are_close(a: Aabb, b: Aabb, distance: f64) -> bool {
    (a.low - b.high).max(b.low - a.high).max_element() <= distance
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
        let corner = || prop::array::uniform3(0.0..10.0f64).prop_map(DVec3::from);
        let one = (corner(), prop::array::uniform3(0.0..2.0f64));
        prop::collection::vec(
            one.prop_map(|(low, size)| Aabb { low, high: low + DVec3::from(size) }),
            0..60,
        )
    }

    proptest! {
        #[test]
        fn boxes_found_are_those_of_a_look_at_all(boxes in boxes(), distance in 0.0..1.0f64) {
            let tree = Tree::new(boxes.clone());
            let mut found = Vec::new();
            for &one in &boxes {
                tree.find(|other| are_close(one, other, distance), &mut found);
                let all = 0..boxes.len() as u32;
                let close = all.filter(|&k| are_close(one, boxes[k as usize], distance));
                prop_assert_eq!(&found, &close.collect::<Vec<_>>());
            }
        }
    }
}
