//! Which of many boxes are close to each other, without looking at all pairs.

use glam::DVec3;

/// Opposite corners.
type Bounds = (DVec3, DVec3);

/// Few enough to look at one by one.
const FEW: usize = 8;

/// Ordered pairs of different boxes that are at most this far from each other along every axis.
pub(super) fn close_pairs(boxes: &[Bounds], close: f64) -> Vec<(usize, usize)> {
    let tree = Tree::new(boxes);
    let mut pairs = Vec::new();
    for (index, &bounds) in boxes.iter().enumerate() {
        let others = tree.near(bounds, close).filter(|&other| other != index);
        pairs.extend(others.map(|other| (index, other)));
    }
    pairs.sort_unstable();
    pairs
}

fn gap(a: Bounds, b: Bounds) -> f64 {
    (a.0 - b.1).max(b.0 - a.1).max_element()
}

/// Boxes in boxes.
struct Tree<'a> {
    boxes: &'a [Bounds],
    /// The boxes in an order in which neighbours are close.
    order: Vec<usize>,
    /// Bounds and range of `order`; children follow their parents, the second at the index given.
    nodes: Vec<(Bounds, std::ops::Range<usize>, Option<usize>)>,
}

impl<'a> Tree<'a> {
    fn new(boxes: &'a [Bounds]) -> Self {
        let order: Vec<usize> = (0..boxes.len()).collect();
        let mut tree = Self { boxes, order, nodes: Vec::new() };
        tree.build(0..boxes.len());
        tree
    }

    /// Divides in the middle, so that the depth is that of a logarithm.
    fn build(&mut self, range: std::ops::Range<usize>) -> usize {
        let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let all = self.order[range.clone()].iter().map(|&index| self.boxes[index]);
        let bounds = all.fold(empty, |(low, high), (a, b)| (low.min(a), high.max(b)));
        let node = self.nodes.len();
        self.nodes.push((bounds, range.clone(), None));
        if range.len() > FEW {
            let size = bounds.1 - bounds.0;
            let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(0);
            let boxes = self.boxes;
            let middle = |index: usize| boxes[index].0[axis] + boxes[index].1[axis];
            let half = range.len() / 2;
            self.order[range.clone()].select_nth_unstable_by(half, |&a, &b| {
                middle(a).total_cmp(&middle(b)).then(a.cmp(&b))
            });
            self.build(range.start..range.start + half);
            let second = self.build(range.start + half..range.end);
            self.nodes[node].2 = Some(second);
        }
        node
    }

    fn near(&self, bounds: Bounds, close: f64) -> impl Iterator<Item = usize> + '_ {
        let (mut stack, mut found) = (vec![0], Vec::new());
        while let Some(node) = stack.pop() {
            let (around, range, second) = &self.nodes[node];
            if gap(*around, bounds) > close {
                continue;
            }
            match second {
                Some(second) => stack.extend([node + 1, *second]),
                None => found.extend(&self.order[range.clone()]),
            }
        }
        found.into_iter().filter(move |&index| gap(self.boxes[index], bounds) <= close)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = Vec<Bounds>> {
        let corner = || prop::array::uniform3(0.0..10.0f64).prop_map(DVec3::from);
        let one = (corner(), prop::array::uniform3(0.0..2.0f64));
        prop::collection::vec(one.prop_map(|(low, size)| (low, low + DVec3::from(size))), 0..60)
    }

    proptest! {
        #[test]
        fn pairs_are_those_of_a_look_at_all(boxes in boxes(), close in 0.0..1.0f64) {
            let all = (0..boxes.len()).flat_map(|a| (0..boxes.len()).map(move |b| (a, b)));
            let near = all.filter(|&(a, b)| a != b && gap(boxes[a], boxes[b]) <= close);
            prop_assert_eq!(close_pairs(&boxes, close), near.collect::<Vec<_>>());
        }
    }
}
