//! Which element lies at a place on a patch.

use glam::{DVec2, DVec3};

use crate::mesh::{Element, ElementId, Mesh, PatchId, VertexId};

/// Finds elements on patches; made once for a mesh as it is.
///
/// Over each patch lies a grid no finer than its elements; a cell of it names a leaf, or the part of
/// the tree to go on in, by the sides of lines. Leaves have numbers of their own, patch after patch
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

/// A grid over a patch.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// Where its coordinates are zero, m.
    pub(super) origin: DVec3,
    /// Gradients of its two coordinates, cells / m.
    pub(super) axes: [DVec3; 2],
    pub(super) normal: DVec3,
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

/// Coordinates on a surface's plane as those of a unit grid.
struct Unit {
    origin: DVec2,
    axes: [DVec2; 2],
}

impl ElementMap {
    /// A map of all leaves of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let units: Vec<Unit> =
            (0..mesh.patches.len() as u32).map(|p| Unit::new(mesh, PatchId(p))).collect();
        let mut finest = vec![DVec2::ONE; units.len()];
        for leaf in mesh.leaves() {
            let patch = mesh[leaf].patch.index();
            finest[patch] = finest[patch].min(units[patch].extent(mesh, leaf));
        }
        let mut map = Self::default();
        for (index, (unit, finest)) in units.iter().zip(finest).enumerate() {
            map.add(mesh, PatchId(index as u32), unit, finest);
        }
        map
    }

    /// The leaves of the mesh, patch after patch.
    pub fn leaves(&self) -> &[ElementId] {
        &self.leaves
    }

    fn add(&mut self, mesh: &Mesh, patch: PatchId, unit: &Unit, finest: DVec2) {
        let size = finest.to_array().map(|least| power_of_two(1.0 / least));
        let scaled =
            Unit { origin: unit.origin, axes: [0, 1].map(|k| unit.axes[k] * f64::from(size[k])) };
        let first_leaf = self.leaves.len();
        let first_branch = self.branches.len();
        let root = self.tree(mesh, &scaled, mesh[patch].root);
        let count = size[0] * size[1];
        let place = |cell: u32| [cell % size[0], cell / size[0]].map(|k| k as f32);
        let cells: Vec<u32> = (0..count).map(|cell| self.narrow(root, place(cell))).collect();
        let mut grid = scaled.in_space(mesh, patch, size);
        // As many leaves as cells, and no cell of more than one leaf: each is one.
        grid.is_regular = self.leaves.len() - first_leaf == count as usize
            && cells.iter().all(|cell| cell & BRANCH == 0);
        if grid.is_regular {
            let leaves = cells.iter().map(|&leaf| self.leaves[leaf as usize]).collect::<Vec<_>>();
            self.leaves.splice(first_leaf.., leaves);
            self.branches.truncate(first_branch);
        } else {
            grid.first = self.cells.len() as u32;
            self.cells.extend(cells);
        }
        grid.leaves = first_leaf..self.leaves.len();
        self.grids.push(grid);
    }

    /// The branches under an element, or the number it gets if there are none.
    fn tree(&mut self, mesh: &Mesh, unit: &Unit, id: ElementId) -> u32 {
        let element = &mesh[id];
        let parts: Vec<u32> =
            element.children.iter().map(|&part| self.tree(mesh, unit, part)).collect();
        let corners: Vec<DVec2> =
            element.corners.iter().map(|&v| unit.place(mesh[v].position)).collect();
        let n = corners.len();
        let middle = |k: usize| (corners[k % n] + corners[(k + 1) % n]) * 0.5;
        match (n, parts.as_slice()) {
            (_, []) => {
                self.leaves.push(id);
                self.leaves.len() as u32 - 1
            }
            (_, &[left, right]) => {
                let [from, to] = cut(mesh, element).map(|v| unit.place(mesh[v].position));
                self.branch(from, to, [right, left])
            }
            (3, &[a, b, c, middle_part]) => {
                let other = self.branch(middle(2), middle(1), [middle_part, c]);
                let other = self.branch(middle(1), middle(0), [other, b]);
                self.branch(middle(0), middle(2), [other, a])
            }
            (4, &[a, b, c, d]) => {
                let left = self.branch(middle(1), middle(3), [d, a]);
                let right = self.branch(middle(1), middle(3), [c, b]);
                self.branch(middle(0), middle(2), [right, left])
            }
            (_, parts) => {
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

    /// What of a tree a whole cell of a grid is part of.
    fn narrow(&self, mut found: u32, [u, v]: [f32; 2]) -> u32 {
        while found & BRANCH != 0 {
            let Branch { line, sides } = self.branches[(found & !BRANCH) as usize];
            let corners = [[u, v], [u + 1.0, v], [u + 1.0, v + 1.0], [u, v + 1.0]];
            let heights = corners.map(|[u, v]| line[0] + line[1] * u + line[2] * v);
            if heights.iter().all(|&height| height >= -ON_LINE) {
                found = sides[1];
            } else if heights.iter().all(|&height| height <= ON_LINE) {
                found = sides[0];
            } else {
                break;
            }
        }
        found
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

/// The ends of the edge that the two parts of an element share, the first part to its left.
fn cut(mesh: &Mesh, element: &Element) -> [VertexId; 2] {
    let corners = |part: usize| &mesh[element.children[part]].corners;
    let (first, second) = (corners(0), corners(1));
    let n = first.len();
    let shared = |v: &VertexId| second.iter().any(|&w| mesh[w].position == mesh[*v].position);
    let edges = (0..n).map(|k| [first[k], first[(k + 1) % n]]);
    edges.into_iter().find(|edge| edge.iter().all(shared)).unwrap_or([first[0], first[n - 1]])
}

/// The smallest power of two not below a number, up to the most cells of a grid.
fn power_of_two(count: f64) -> u32 {
    ((count.min(MOST) - 0.01).max(1.0).ceil() as u32).next_power_of_two()
}

impl Unit {
    /// Over a parallelogram, its own edges; else a box around the patch along its first edge.
    fn new(mesh: &Mesh, patch: PatchId) -> Self {
        let outline = mesh.outline(mesh[patch].root);
        let (origin, along) = (outline[0], outline[1] - outline[0]);
        if let &[a, b, c, d] = outline.as_slice() {
            let skew = (a + c).distance(b + d);
            if skew < 1e-6 * a.distance(c) {
                return Self::spanned(origin, [along, d - a]);
            }
        }
        let across = along.perp();
        let unit = Self::spanned(origin, [along, across]);
        let at = || outline.iter().map(|&p| unit.place(p));
        let low = at().fold(DVec2::INFINITY, DVec2::min);
        let size = at().fold(DVec2::NEG_INFINITY, DVec2::max) - low;
        let origin = origin + along * low.x + across * low.y;
        Self::spanned(origin, [along * size.x, across * size.y])
    }

    fn spanned(origin: DVec2, [a, b]: [DVec2; 2]) -> Self {
        let area = a.perp_dot(b);
        Self { origin, axes: [-b.perp() / area, a.perp() / area] }
    }

    fn place(&self, position: DVec2) -> DVec2 {
        DVec2::from(self.axes.map(|axis| axis.dot(position - self.origin)))
    }

    /// Width and height of an element.
    fn extent(&self, mesh: &Mesh, element: ElementId) -> DVec2 {
        let at = || mesh[element].corners.iter().map(|&v| self.place(mesh[v].position));
        at().fold(DVec2::NEG_INFINITY, DVec2::max) - at().fold(DVec2::INFINITY, DVec2::min)
    }

    fn in_space(&self, mesh: &Mesh, id: PatchId, size: [u32; 2]) -> Grid {
        let patch = &mesh[id];
        let outline = mesh.outline(patch.root);
        let flat = outline[1] - outline[0];
        let along = (patch.corners[1] - patch.corners[0]) / flat.length_squared();
        let across = patch.normal.cross(along);
        let lift = |p: DVec2| along * flat.dot(p) + across * flat.perp_dot(p);
        Grid {
            origin: patch.corners[0] + lift(self.origin - outline[0]),
            axes: self.axes.map(lift),
            normal: patch.normal,
            size,
            first: 0,
            leaves: 0..0,
            is_regular: false,
        }
    }
}
