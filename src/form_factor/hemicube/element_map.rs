//! Which element lies at a place on a patch.

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::chart::{BilinearChart, STRAIGHT};
use crate::geometry::polygon::edges;
use crate::mesh::{Element, ElementId, Mesh, PatchId, VertexId};

/// Finds elements on patches; made once for a mesh as it is.
///
/// Over each patch lies a grid no finer than its elements; a cell of it names a leaf, or a tree of those
/// that share it, to be told apart by the sides of lines. Leaves have numbers of their own, patch after patch
/// and, where each is a cell, in the order of the grid.
#[derive(Clone, Debug, Default)]
pub struct ElementMap {
    pub(super) grids: Vec<Grid>,
    /// Cells of the grids that are more than their leaves: numbers of leaves, or [`BRANCH`] and a branch.
    cells: Vec<u32>,
    branches: Vec<Branch>,
    /// By number: the leaves.
    leaves: Vec<ElementId>,
}

/// Most cells along a side of a grid.
const MOST: f64 = 32.0;

/// Marks numbers of branches, among those of leaves.
const BRANCH: u32 = 1 << 31;

/// How far from a line, in cells of a grid, still counts as on it.
const ON_LINE: f32 = 1e-3;

/// A grid over a patch: over a triangle or a quadrilateral in one piece, over any other polygon in a strip
/// of the quadrilaterals that it is divided in, side by side along the first coordinate.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    pub(super) pieces: SmallVec<[BilinearChart<DVec3>; 1]>,
    pub(super) normal: DVec3,
    /// Cells of a piece along its coordinates.
    pub(super) size: [u32; 2],
    /// Number of its first cell if its cells are not the leaves.
    first: u32,
    /// Numbers of the leaves.
    pub(super) leaves: std::ops::Range<usize>,
    /// True if its cells are the leaves.
    pub(super) is_regular: bool,
}

/// A line across an element, in the coordinates of its grid.
#[derive(Clone, Copy, Debug)]
struct Branch {
    /// Heights above the line are `line[0] + line[1] u + line[2] v`.
    line: [f32; 3],
    /// What is below and what above: leaves, or [`BRANCH`] and a branch.
    sides: [u32; 2],
}

impl ElementMap {
    /// A map of all leaves of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let mut map = Self::default();
        for index in 0..mesh.patches.len() as u32 {
            map.add(mesh, PatchId(index));
        }
        map
    }

    /// The leaves of the mesh, patch after patch.
    pub fn leaves(&self) -> &[ElementId] {
        &self.leaves
    }

    fn add(&mut self, mesh: &Mesh, id: PatchId) {
        let patch = &mesh[id];
        let (elements, charts) = pieces(mesh, patch.root);
        let finest = elements.iter().zip(&charts).map(|(&piece, chart)| finest(mesh, chart, piece));
        let finest = finest.fold(DVec2::ONE, DVec2::min);
        let size = finest.to_array().map(|least| power_of_two(1.0 / least));
        let first_leaf = self.leaves.len();
        let mut forest = Forest { leaves: &mut self.leaves, branches: Vec::new() };
        let scale = DVec2::new(size[0].into(), size[1].into());
        let trees = elements.iter().zip(&charts).zip(0..).map(|((&piece, chart), number)| {
            let place = |p: DVec2| (chart.place(p) + DVec2::X * f64::from(number)) * scale;
            forest.tree(mesh, &place, piece)
        });
        let trees: SmallVec<[u32; 8]> = trees.collect();
        let tree = forest.branches;
        let width = size[0] * trees.len() as u32;
        let cells = (0..width * size[1]).map(|cell| {
            let [i, j] = [cell % width, cell / width];
            self.narrow(&tree, trees[(i / size[0]) as usize], [i, j].map(|k| k as f32))
        });
        let cells: Vec<u32> = cells.collect();
        // As many leaves as cells, and no cell of more than one leaf: each is one.
        let is_regular = self.leaves.len() - first_leaf == cells.len()
            && cells.iter().all(|cell| cell & BRANCH == 0);
        let first = self.cells.len() as u32;
        if is_regular {
            let leaves = cells.iter().map(|&leaf| self.leaves[leaf as usize]).collect::<Vec<_>>();
            self.leaves.splice(first_leaf.., leaves);
        } else {
            self.cells.extend(cells);
        }
        let outline = mesh.outline(patch.root);
        let pieces = charts.iter().map(|chart| chart.in_space(patch, &outline)).collect();
        let leaves = first_leaf..self.leaves.len();
        self.grids.push(Grid { pieces, normal: patch.normal, size, first, leaves, is_regular });
    }

    /// What of a tree a cell of a grid is part of: a leaf, or a branch of its own.
    fn narrow(&mut self, tree: &[Branch], found: u32, [u, v]: [f32; 2]) -> u32 {
        if found & BRANCH == 0 {
            return found;
        }
        let Branch { line, sides } = tree[(found & !BRANCH) as usize];
        let corners = [[u, v], [u + 1.0, v], [u + 1.0, v + 1.0], [u, v + 1.0]];
        let heights = corners.map(|[u, v]| line[0] + line[1] * u + line[2] * v);
        if heights.iter().all(|&height| height >= -ON_LINE) {
            self.narrow(tree, sides[1], [u, v])
        } else if heights.iter().all(|&height| height <= ON_LINE) {
            self.narrow(tree, sides[0], [u, v])
        } else {
            let sides = sides.map(|side| self.narrow(tree, side, [u, v]));
            self.branches.push(Branch { line, sides });
            BRANCH | (self.branches.len() - 1) as u32
        }
    }

    /// The leaf at a place on a patch in the coordinates of its grid, in this of its cells; counted
    /// from the patch's first.
    #[inline(always)]
    pub(super) fn leaf(&self, grid: &Grid, cell: u32, [u, v]: [f32; 2]) -> u32 {
        let mut found = self.cells[(grid.first + cell) as usize];
        while found & BRANCH != 0 {
            let Branch { line, sides } = self.branches[(found & !BRANCH) as usize];
            found = sides[usize::from(line[0] + line[1] * u + line[2] * v >= 0.0)];
        }
        found - grid.leaves.start as u32
    }
}

/// The trees of a patch's elements.
struct Forest<'a> {
    leaves: &'a mut Vec<ElementId>,
    branches: Vec<Branch>,
}

impl Forest<'_> {
    /// The branches under an element, or the number it gets if there are none.
    fn tree(&mut self, mesh: &Mesh, place: &dyn Fn(DVec2) -> DVec2, id: ElementId) -> u32 {
        let element = &mesh[id];
        let parts: SmallVec<[u32; 4]> =
            element.children.iter().map(|&part| self.tree(mesh, place, part)).collect();
        let corners: SmallVec<[DVec2; 4]> = mesh.outline(id).iter().map(|&p| place(p)).collect();
        let n = corners.len();
        let middle = |k: usize| (corners[k % n] + corners[(k + 1) % n]) * 0.5;
        match *parts {
            [] => {
                self.leaves.push(id);
                self.leaves.len() as u32 - 1
            }
            [left, right] => {
                let [from, to] = cut(mesh, element).map(|v| place(mesh[v].position));
                self.branch(from, to, [right, left])
            }
            [a, b, c, middle_part] if n == 3 => {
                let other = self.branch(middle(2), middle(1), [middle_part, c]);
                let other = self.branch(middle(1), middle(0), [other, b]);
                self.branch(middle(0), middle(2), [other, a])
            }
            [a, b, c, d] if n == 4 => {
                let left = self.branch(middle(1), middle(3), [d, a]);
                let right = self.branch(middle(1), middle(3), [c, b]);
                self.branch(middle(0), middle(2), [right, left])
            }
            _ => {
                let centre = corners.iter().sum::<DVec2>() / n as f64;
                let mut found = parts[parts.len() - 1];
                for (k, &part) in parts.iter().enumerate().rev().skip(1) {
                    let inside = self.branch(centre, middle(k), [part, found]);
                    found = self.branch(centre, middle(k + n - 1), [found, inside]);
                }
                found
            }
        }
    }

    /// A branch with what is right and what is left of a line.
    fn branch(&mut self, from: DVec2, to: DVec2, sides: [u32; 2]) -> u32 {
        let across = (to - from).normalize_or_zero().perp();
        let line = [-across.dot(from), across.x, across.y].map(|c| c as f32);
        self.branches.push(Branch { line, sides });
        BRANCH | (self.branches.len() - 1) as u32
    }
}

/// Elements that cover a patch's, and a chart of each: of the triangle or the quadrilaterals that it is
/// or is divided in, or, where straight cuts would be curves in these, one of the whole.
fn pieces(
    mesh: &Mesh,
    root: ElementId,
) -> (SmallVec<[ElementId; 1]>, SmallVec<[BilinearChart<DVec2>; 1]>) {
    let Element { corners, children, .. } = &mesh[root];
    if is_cut(mesh, root) || (corners.len() > 4 && children.is_empty()) {
        let chart = BilinearChart::around(&mesh.outline(root));
        return (SmallVec::from([root]), SmallVec::from_iter([chart]));
    }
    let pieces: SmallVec<[ElementId; 1]> = match corners.len() {
        3 | 4 => SmallVec::from([root]),
        _ => children.iter().copied().collect(),
    };
    let charts = pieces.iter().map(|&piece| BilinearChart::new(&mesh.outline(piece))).collect();
    (pieces, charts)
}

/// True if an element or a part of it is cut otherwise than between the middles of its edges.
fn is_cut(mesh: &Mesh, id: ElementId) -> bool {
    let element = &mesh[id];
    let outline = mesh.outline(id);
    let is_middle = |v: VertexId| {
        let middle = |[a, b]: [DVec2; 2]| (a + b) * 0.5;
        edges(&outline).any(|edge| {
            middle(edge).distance(mesh[v].position) < STRAIGHT * edge[0].distance(edge[1])
        })
    };
    (element.children.len() == 2 && !cut(mesh, element).into_iter().all(is_middle))
        || element.children.iter().any(|&part| is_cut(mesh, part))
}

/// The ends of the edge that the two parts of an element share, the first part to its left.
fn cut(mesh: &Mesh, element: &Element) -> [VertexId; 2] {
    let corners = |part: usize| &mesh[element.children[part]].corners;
    let (first, second) = (corners(0), corners(1));
    let n = first.len();
    let is_shared = |v: &VertexId| second.iter().any(|&w| mesh[w].position == mesh[*v].position);
    let mut sides = (0..n).map(|k| [first[k], first[(k + 1) % n]]);
    sides.find(|side| side.iter().all(is_shared)).unwrap_or([first[n - 1], first[0]])
}

/// Least width and height of the leaves of an element.
fn finest(mesh: &Mesh, chart: &BilinearChart<DVec2>, id: ElementId) -> DVec2 {
    if mesh[id].is_leaf() {
        let outline = mesh.outline(id);
        let at = || outline.iter().map(|&p| chart.place(p));
        return at().fold(DVec2::NEG_INFINITY, DVec2::max) - at().fold(DVec2::INFINITY, DVec2::min);
    }
    let parts = mesh[id].children.iter();
    parts.map(|&part| finest(mesh, chart, part)).fold(DVec2::INFINITY, DVec2::min)
}

/// The smallest power of two not below a number, up to the most cells of a grid.
fn power_of_two(count: f64) -> u32 {
    ((count.min(MOST) - 0.01).max(1.0).ceil() as u32).next_power_of_two()
}
