//! What may stand in a shaft, found once and handed down to the shafts inside of it.

use smallvec::SmallVec;

use super::ids::OccluderId;
use super::occluder::Occluder;
use super::occluders::Occluders;
use super::shaft::{ConvexBody, Shaft};
use crate::surface::SurfaceId;

/// More occluders than this are not listed one by one.
const FEW: usize = 32;

/// Most nodes of the hierarchy under which the occluders of a shaft are, when they are not listed.
const NODES: usize = 24;

/// What may stand in a shaft.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Blockers {
    /// All of these occluders, by their numbers, and no others.
    Few(SmallVec<[OccluderId; 4]>),
    /// Some of the occluders under these nodes of the hierarchy.
    Many(Box<[u32]>),
    /// One occluder that hides each body from the other.
    Opaque,
}

impl Blockers {
    /// True if nothing stands in the shaft.
    pub fn is_clear(&self) -> bool {
        self.are_few(0)
    }

    /// True if they are known to be no more than `most`.
    pub fn are_few(&self, most: usize) -> bool {
        matches!(self, Self::Few(list) if list.len() <= most)
    }
}

impl Occluders {
    /// All occluders, as what may stand in any shaft.
    pub fn all(&self) -> Blockers {
        if self.is_empty() { Blockers::Few(SmallVec::new()) } else { Blockers::Many(Box::new([0])) }
    }

    /// Of the blockers of a shaft around that between two bodies, those that stand between these.
    ///
    /// Occluders of which `ignored` is true, told by their surfaces, do not count.
    pub fn narrowed(
        &self,
        around: &Blockers,
        a: &ConvexBody,
        b: &ConvexBody,
        ignored: impl Fn(SurfaceId) -> bool,
    ) -> Blockers {
        let shaft = Shaft::between(a, b, self.epsilon);
        let search = Search { occluders: self, bodies: [a, b], shaft: &shaft, ignored: &ignored };
        match around {
            Blockers::Opaque => Blockers::Opaque,
            Blockers::Few(list) => search.among(list.iter().copied()),
            Blockers::Many(nodes) => search.under(nodes),
        }
    }

    /// Calls `visit` for the blockers of a shaft that may stand in another inside of it, until it returns false.
    pub(super) fn for_each_in(
        &self,
        around: &Blockers,
        shaft: &Shaft,
        mut visit: impl FnMut(OccluderId, &Occluder) -> bool,
    ) {
        match around {
            Blockers::Opaque => {}
            Blockers::Few(list) => {
                let mut list = list.iter();
                // `all` stops where `visit` has had enough.
                list.all(|&number| visit(number, &self.polygons[number.index()]));
            }
            Blockers::Many(nodes) => self.for_each_under(
                nodes,
                |low, high| shaft.meets_box(low, high, self.epsilon),
                |number, occluder| {
                    !shaft.meets(&occluder.corners, self.epsilon) || visit(number, occluder)
                },
            ),
        }
    }

    /// The numbers of the blockers of a shaft that stand between two bodies inside of it, up to `most` of them.
    pub fn numbers_in(
        &self,
        around: &Blockers,
        a: &ConvexBody,
        b: &ConvexBody,
        most: usize,
    ) -> Vec<OccluderId> {
        let shaft = Shaft::between(a, b, self.epsilon);
        let mut numbers = Vec::new();
        self.for_each_in(around, &shaft, |number, occluder| {
            if occluder.inside(shaft.sides(), self.epsilon).is_some() {
                numbers.push(number);
            }
            numbers.len() < most
        });
        numbers
    }
}

/// Looks for what stands in a shaft.
struct Search<'a, F> {
    occluders: &'a Occluders,
    bodies: [&'a ConvexBody; 2],
    shaft: &'a Shaft,
    ignored: &'a F,
}

impl<F: Fn(SurfaceId) -> bool> Search<'_, F> {
    fn among(&self, numbers: impl Iterator<Item = OccluderId>) -> Blockers {
        let Self { occluders, shaft, .. } = self;
        let mut found = SmallVec::new();
        for number in numbers {
            let occluder = &occluders.polygons[number.index()];
            if (self.ignored)(occluder.surface)
                || occluder.inside(shaft.sides(), occluders.epsilon).is_none()
            {
                continue;
            }
            if self.hides_all(occluder) {
                return Blockers::Opaque;
            }
            found.push(number);
        }
        Blockers::Few(found)
    }

    /// Opens nodes that reach into the shaft, the largest first and in their places, while they are few.
    fn under(&self, nodes: &[u32]) -> Blockers {
        let reached = |nodes: &[u32]| -> SmallVec<[(u32, f32); 32]> {
            let reached = nodes.iter().filter(|&&node| self.reaches(node));
            reached.map(|&node| (node, self.size(node))).collect()
        };
        let mut open = reached(nodes);
        while open.len() < NODES {
            let largest =
                |best: usize, at: usize| if open[at].1 > open[best].1 { at } else { best };
            let Some(at) = (0..open.len()).reduce(largest) else { break };
            let (node, size) = open[at];
            if size < 0.0 {
                break;
            }
            let first = self.node(node).first_index;
            open.remove(at);
            open.insert_many(at, reached(&[first, first + 1]));
        }
        let leaves = || open.iter().map(|&(node, _)| self.node(node)).filter(|node| node.is_leaf());
        let numbers = || {
            leaves()
                .flat_map(|node| node.first_index..node.first_index + node.prim_count)
                .map(OccluderId)
        };
        if leaves().count() == open.len() {
            let listed = self.among(numbers());
            if !matches!(&listed, Blockers::Few(list) if list.len() > FEW) {
                return listed;
            }
        }
        let is_opaque = |number: OccluderId| {
            let occluder = &self.occluders.polygons[number.index()];
            !(self.ignored)(occluder.surface) && self.hides_all(occluder)
        };
        if numbers().any(is_opaque) {
            Blockers::Opaque
        } else {
            Blockers::Many(open.iter().map(|&(node, _)| node).collect())
        }
    }

    /// Half of the area of an inner node's box, m²; of leaves, which are not opened, less than nothing.
    fn size(&self, node: u32) -> f32 {
        let node = self.node(node);
        if node.is_leaf() { -1.0 } else { node.aabb().half_area() }
    }

    fn node(&self, index: u32) -> &obvhs::bvh2::node::Bvh2Node {
        &self.occluders.bvh.nodes[index as usize]
    }

    fn reaches(&self, node: u32) -> bool {
        let (low, high) = self.occluders.bounds_of(node);
        self.shaft.meets_box(low, high, self.occluders.epsilon)
    }

    fn hides_all(&self, occluder: &Occluder) -> bool {
        let [a, b] = self.bodies;
        occluder.hides(a.corners(), b.corners(), self.occluders.epsilon)
    }
}
