//! Constrained Delaunay triangulation of the leaves of one surface, in its own coordinates.

use std::collections::HashMap;

use glam::DVec2;
use spade::handles::{FixedFaceHandle, InnerTag};
use spade::{
    ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation, mitigate_underflow,
};

/// A corner of the triangulation.
#[derive(Clone, Copy, Debug)]
struct DelaunayVertex {
    position: Point2<f64>,
    place: u32,
}

impl HasPosition for DelaunayVertex {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// A triangle between three places, and the leaf it is part of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeafTriangle {
    pub(crate) corners: [u32; 3],
    /// Index into the loops it was made from.
    pub(crate) leaf: usize,
}

/// Triangulates leaves given as loops of places, counter-clockwise, hanging nodes included.
///
/// Loops that share an edge must share all places on it. `at` gives a place's coordinates.
pub(crate) fn triangulate(loops: &[Vec<u32>], at: impl Fn(u32) -> DVec2) -> Vec<LeafTriangle> {
    let mut numbers: HashMap<u32, usize> = HashMap::new();
    let mut nodes: Vec<DelaunayVertex> = Vec::new();
    let mut edges: Vec<[usize; 2]> = Vec::new();
    let mut owners: HashMap<[u32; 2], usize> = HashMap::new();
    for (leaf, places) in loops.iter().enumerate() {
        let mut number = |place: u32| {
            *numbers.entry(place).or_insert_with(|| {
                let DVec2 { x, y } = at(place);
                nodes.push(DelaunayVertex {
                    position: mitigate_underflow(Point2::new(x, y)),
                    place,
                });
                nodes.len() - 1
            })
        };
        for (k, &from) in places.iter().enumerate() {
            let to = places[(k + 1) % places.len()];
            edges.push([number(from), number(to)]);
            owners.insert([from, to], leaf);
        }
    }
    // Edges of leaves meet in shared places only, so none are in conflict.
    let cdt = ConstrainedDelaunayTriangulation::try_bulk_load_cdt(nodes, edges, |_| ())
        .expect("places have finite coordinates");
    tiles(&cdt, &owners)
}

/// The inner faces that belong to a leaf: those to the left of its edges, and what hangs together
/// with them.
fn tiles(
    cdt: &ConstrainedDelaunayTriangulation<DelaunayVertex>,
    owners: &HashMap<[u32; 2], usize>,
) -> Vec<LeafTriangle> {
    let mut leaf_of: HashMap<FixedFaceHandle<InnerTag>, usize> = HashMap::new();
    let mut open = Vec::new();
    for face in cdt.inner_faces() {
        let owner = face.adjacent_edges().iter().find_map(|edge| {
            owners.get(&[edge.from().data().place, edge.to().data().place]).copied()
        });
        if let Some(leaf) = owner {
            leaf_of.insert(face.fix(), leaf);
            open.push(face.fix());
        }
    }
    while let Some(face) = open.pop() {
        let leaf = leaf_of[&face];
        for edge in cdt.face(face).adjacent_edges() {
            let beyond = edge.rev().face().as_inner().filter(|_| !edge.is_constraint_edge());
            if let Some(next) = beyond.map(|next| next.fix())
                && !leaf_of.contains_key(&next)
            {
                leaf_of.insert(next, leaf);
                open.push(next);
            }
        }
    }
    let tile = |face: spade::handles::FaceHandle<'_, InnerTag, DelaunayVertex, _, _, _>| {
        let corners = face.vertices().map(|vertex| vertex.data().place);
        leaf_of.get(&face.fix()).map(|&leaf| LeafTriangle { corners, leaf })
    };
    cdt.inner_faces().filter_map(tile).collect()
}
