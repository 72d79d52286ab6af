//! Delta form factors by element: each cell's goes to the leaf where its ray ends.

use glam::{DMat3, DVec3};
use pulp::{Simd, WithSimd};

use super::cells::NOTHING;
use super::clip::FACES;
use super::element_map::{ElementMap, Grid};
use super::raster::{LANES, count_up, rounded};
use super::{Hemicube, Print};

/// Number of no face.
const NO_FACE: u16 = u16::MAX;

/// Delta form factors summed by element, reused from look to look.
#[derive(Clone, Debug)]
pub struct ElementSums<'a> {
    map: &'a ElementMap,
    one: PatchSums,
    seen: Vec<(u32, f32)>,
}

/// Sums of the leaves of one patch, counted from its first.
#[derive(Clone, Debug)]
struct PatchSums {
    /// Zero between patches.
    sums: Vec<f32>,
    /// Leaves that were seen; room for one more than there are.
    touched: Vec<u32>,
}

/// A patch's grid as a face sees it: its two coordinates times the reciprocal depth, and that depth, as
/// coefficients of 1, the column and the row.
#[derive(Clone, Copy, Debug)]
struct Lens([[f32; 3]; 3]);

impl<'a> ElementSums<'a> {
    /// Sums that are all zero.
    pub fn new(map: &'a ElementMap) -> Self {
        let most = map.grids.iter().map(|grid| grid.leaves.len()).max().unwrap_or(0);
        let one = PatchSums { sums: vec![0.0; most], touched: vec![0; most + 1] };
        Self { map, one, seen: Vec::new() }
    }

    /// The leaves that a hemicube sees, patch by patch, by their numbers in [`ElementMap::leaves`], each
    /// with the sum of the delta factors of its cells.
    pub fn of(&mut self, hemicube: &Hemicube<'_>) -> &[(u32, f32)] {
        hemicube.arch.dispatch(Summing { sums: self, hemicube });
        &self.seen
    }
}

struct Summing<'s, 'a, 'h> {
    sums: &'s mut ElementSums<'a>,
    hemicube: &'h Hemicube<'h>,
}

impl WithSimd for Summing<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { sums: ElementSums { map, one, seen }, hemicube } = self;
        seen.clear();
        for &patch in &hemicube.drawn {
            let Print { last, kept, .. } = hemicube.prints[patch as usize];
            if last == NOTHING {
                continue;
            }
            let grid = &map.grids[patch as usize];
            let first = grid.leaves.start as u32;
            if grid.leaves.len() == 1 {
                seen.push((first, kept));
                continue;
            }
            let count = one.add(simd, hemicube, (map, grid, last));
            for &leaf in &one.touched[..count] {
                let sum = std::mem::take(&mut one.sums[leaf as usize]);
                seen.push((first + leaf, sum));
            }
        }
    }
}

impl PatchSums {
    /// Adds the cells of a patch, from its last run on, to the leaves they see; returns how many those are.
    #[inline(always)]
    #[allow(clippy::needless_range_loop, reason = "four lists in step")]
    fn add<S: Simd>(
        &mut self,
        simd: S,
        hemicube: &Hemicube<'_>,
        (map, grid, last): (&ElementMap, &Grid, u32),
    ) -> usize {
        let resolution = hemicube.delta.resolution();
        let (mut face, mut lens) = (NO_FACE, Lens([[0.0; 3]; 3]));
        let mut count = 0;
        let mut next = last;
        while next != NOTHING {
            let run = hemicube.runs[next as usize];
            if run.face != face {
                face = run.face;
                lens = Lens::new(grid, (hemicube.eye, &hemicube.frame), (face.into(), resolution));
            }
            let profile = hemicube.delta.profile(face.into(), run.row.into());
            let [from, to] = run.columns.map(usize::from);
            for first in (from..to).step_by(S::F32_LANES) {
                let (cells, [u, v]) = lens.cells(simd, grid, (run.row, first));
                let shares = shares(simd, profile, (first, resolution));
                let here = 0..S::F32_LANES.min(to - first);
                if grid.is_regular {
                    for k in here {
                        count = self.put(cells[k], shares[k], count);
                    }
                } else {
                    for k in here {
                        let leaf = map.leaf(grid, cells[k], [u[k], v[k]]);
                        count = self.put(leaf, shares[k], count);
                    }
                }
            }
            next = run.before;
        }
        count
    }

    /// Adds a cell's factor to the leaf it sees; returns how many have been seen.
    #[inline(always)]
    fn put(&mut self, leaf: u32, share: f32, count: usize) -> usize {
        let sum = &mut self.sums[leaf as usize];
        let is_new = *sum == 0.0;
        *sum += share;
        self.touched[count] = leaf;
        count + usize::from(is_new)
    }
}

/// Cells of a patch's grid, and places in its coordinates.
type Seen = ([u32; LANES], [[f32; LANES]; 2]);

impl Lens {
    #[inline(always)]
    fn new(grid: &Grid, (eye, frame): (DVec3, &DMat3), (face, resolution): (usize, usize)) -> Self {
        let offset = eye - grid.origin;
        let plane = *frame * grid.normal / -offset.dot(grid.normal);
        let along = |axis: DVec3| *frame * axis + plane * axis.dot(offset);
        let directions = [along(grid.axes[0]), along(grid.axes[1]), plane];
        Self(directions.map(|n| FACES[face].by_cell(n.as_vec3(), resolution)))
    }

    /// What the cells of a hemicube from a row's column on see.
    #[inline(always)]
    fn cells<S: Simd>(&self, simd: S, grid: &Grid, (row, first): (u16, usize)) -> Seen {
        let column = count_up(simd, first);
        let row = f32::from(row);
        let [u, v, w] = self.0.map(
            #[inline(always)]
            |[origin, by_column, by_row]| {
                let start = simd.splat_f32s(origin + by_row * row);
                simd.add_f32s(start, simd.mul_f32s(simd.splat_f32s(by_column), column))
            },
        );
        let (mut cells, mut places) = ([0; LANES], [[0.0; LANES]; 2]);
        let depth = simd.div_f32s(simd.splat_f32s(1.0), w);
        let at = [simd.mul_f32s(u, depth), simd.mul_f32s(v, depth)];
        let [i, j] = [0, 1].map(
            #[inline(always)]
            |k| {
                // The nearest whole number to half a cell back is the cell's.
                let back = simd.sub_f32s(at[k], simd.splat_f32s(0.5));
                rounded(simd, back, (grid.size[k] - 1) as f32)
            },
        );
        let whole = simd.mul_u32s(j, simd.splat_u32s(grid.size[0]));
        S::as_mut_simd_u32s(&mut cells).0[0] = simd.add_u32s(whole, i);
        for (places, at) in places.iter_mut().zip(at) {
            S::as_mut_simd_f32s(places).0[0] = at;
        }
        (cells, places)
    }
}

/// Delta factors of the cells of a row from a column on. Computed, since patches take rows in any order:
/// a table of all would be read from far away.
#[inline(always)]
fn shares<S: Simd>(simd: S, [c, d]: [f32; 2], (first, resolution): (usize, usize)) -> [f32; LANES] {
    let step = 2.0 / resolution as f32;
    let [c, d, step, start] = [c, d, step, 0.5 * step - 1.0].map(
        #[inline(always)]
        |x| simd.splat_f32s(x),
    );
    let x = simd.add_f32s(start, simd.mul_f32s(step, count_up(simd, first)));
    let square = simd.add_f32s(simd.mul_f32s(x, x), c);
    let mut shares = [0.0; LANES];
    S::as_mut_simd_f32s(&mut shares).0[0] = simd.div_f32s(d, simd.mul_f32s(square, square));
    shares
}
