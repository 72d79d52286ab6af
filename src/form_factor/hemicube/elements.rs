//! Delta form factors by element: each cell's goes to the leaf where its ray ends.
//!
//! Patch by patch and face by face, the cells that see a patch are first laid out one after the other,
//! then looked up in whole registers, and only then added to their leaves one by one: most spans of cells
//! are too short to fill registers of their own.

use std::array;

use glam::DVec3;
use pulp::{Simd, WithSimd};
use smallvec::SmallVec;

use super::chart::{BilinearChart, straighten};
use super::clip::FACES;
use super::coverage::Coverage;
use super::delta::DeltaProfile;
use super::element_map::{ElementMap, Grid};
use super::frame::Frame;
use super::item_buffer::{NOTHING, Span};
use super::look::Hemicube;
use super::raster::{LANES, count_up, rounded};

/// Parts of a list of cells that are added to leaves in turns.
const STREAMS: usize = 4;

/// Delta form factors summed by element, reused from look to look.
#[derive(Clone, Debug)]
pub struct ElementSums<'a> {
    map: &'a ElementMap,
    batch: CellBatch,
    /// Sums of the leaves of one patch, counted from its first; zero between patches.
    sums: Vec<f32>,
    seen: Vec<LeafSum>,
}

/// A leaf that a hemicube sees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LeafSum {
    /// Index into [`ElementMap::leaves`].
    pub leaf: u32,
    /// Sum of the delta factors of the cells that see it.
    pub sum: f32,
}

/// Cells of one face that see one patch; room for a register more than a face has.
#[derive(Clone, Debug, Default)]
struct CellBatch {
    face: usize,
    /// How many there are.
    count: usize,
    /// Their columns and rows, then the places in the coordinates of the patch's grid that they see.
    places: [Vec<f32>; 2],
    /// The cells of the grid that they see, then the patch's leaves, counted from its first.
    leaves: Vec<u32>,
    /// Their delta factors.
    shares: Vec<f32>,
}

/// The projective map from the cells of a face to the piece of a patch that they see.
#[derive(Clone, Copy, Debug)]
struct Homography {
    /// The two oblique coordinates of its chart over depth, and one over depth, as coefficients of 1, the
    /// column and the row.
    over_depth: [[f32; 3]; 3],
    bend: [f32; 2],
}

/// What a register of cells sees: places in the coordinates of a grid, and its cells.
#[derive(Clone, Copy)]
struct GridPoints<S: Simd> {
    places: [S::f32s; 2],
    cells: S::u32s,
}

impl<'a> ElementSums<'a> {
    /// Sums that are all zero.
    pub fn new(map: &'a ElementMap) -> Self {
        let most = map.grids.iter().map(|grid| grid.leaves.len()).max().unwrap_or(0);
        Self { map, batch: CellBatch::default(), sums: vec![0.0; most], seen: Vec::new() }
    }

    /// The leaves that a hemicube sees, patch by patch.
    pub fn of(&mut self, hemicube: &Hemicube<'_>) -> &[LeafSum] {
        self.batch.make_room(hemicube.buffer.resolution());
        let count = hemicube.arch.dispatch(Summing { sums: self, hemicube });
        &self.seen[..count]
    }
}

struct Summing<'s, 'a, 'h> {
    sums: &'s mut ElementSums<'a>,
    hemicube: &'h Hemicube<'h>,
}

impl WithSimd for Summing<'_, '_, '_> {
    /// How many leaves are seen.
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let Self { sums, hemicube } = self;
        let mut count = 0;
        for &patch in &hemicube.drawn {
            count += sums.add(simd, hemicube, patch, count);
        }
        count
    }
}

impl ElementSums<'_> {
    /// Lists the leaves of a patch that cells see, and their sums, after the `count` listed before; returns how many
    /// there are.
    #[inline(always)]
    fn add<S: Simd>(
        &mut self,
        simd: S,
        hemicube: &Hemicube<'_>,
        patch: u32,
        count: usize,
    ) -> usize {
        let map = self.map;
        let Self { batch, sums, seen, .. } = self;
        let Coverage { last, kept, .. } = hemicube.coverage[patch as usize];
        if last == NOTHING {
            return 0;
        }
        let grid = &map.grids[patch as usize];
        // One more than there are: cells of leaves seen before write there as well.
        let room = count + grid.leaves.len() + 1;
        if seen.len() < room {
            seen.resize(room, LeafSum::default());
        }
        let seen = &mut seen[count..room];
        if grid.leaves.len() == 1 {
            seen[0] = LeafSum { leaf: grid.leaves.start as u32, sum: kept };
            return 1;
        }
        let (mut next, mut found) = (last, 0);
        while next != NOTHING {
            next = batch.lay_out(simd, &hemicube.spans, next);
            batch.look_up(simd, hemicube, grid);
            if !grid.is_regular {
                batch.descend(map, grid);
            }
            found = batch.scatter(sums, seen, found);
        }
        for LeafSum { leaf, sum } in &mut seen[..found] {
            *sum = std::mem::take(&mut sums[*leaf as usize]);
            *leaf += grid.leaves.start as u32;
        }
        found
    }
}

impl CellBatch {
    fn make_room(&mut self, resolution: usize) {
        let room = resolution * resolution + LANES;
        if self.leaves.len() < room {
            self.places.iter_mut().for_each(|list| list.resize(room, 0.0));
            self.leaves.resize(room, 0);
            self.shares.resize(room, 0.0);
        }
    }

    /// Lists the cells of a span and of those of the same patch and face before it; returns the span before
    /// them.
    #[inline(always)]
    fn lay_out<S: Simd>(&mut self, simd: S, spans: &[Span], last: u32) -> u32 {
        let [columns, rows] = &mut self.places;
        let face = spans[last as usize].face;
        let (mut count, mut next) = (0, last);
        while let Some(span) = spans.get(next as usize).filter(|span| span.face == face) {
            let [from, to] = span.columns.map(usize::from);
            let row = simd.splat_f32s(span.row.into());
            // What registers hold beyond the span is written over by the next.
            for first in (from..to).step_by(S::F32_LANES) {
                let here = count + first - from..count + first - from + S::F32_LANES;
                S::as_mut_simd_f32s(&mut columns[here.clone()]).0[0] = count_up(simd, first);
                S::as_mut_simd_f32s(&mut rows[here]).0[0] = row;
            }
            count += to - from;
            next = span.before;
        }
        (self.face, self.count) = (face.into(), count);
        next
    }

    /// Finds which cells of a patch's grid, and where, they see, and their factors.
    #[inline(always)]
    fn look_up<S: Simd>(&mut self, simd: S, hemicube: &Hemicube<'_>, grid: &Grid) {
        let (face, count) = (self.face, self.count);
        let homographies =
            grid.pieces.iter().map(|piece| Homography::new(hemicube, face, piece, grid.normal));
        let homographies: SmallVec<[Homography; 8]> = homographies.collect();
        let profile = hemicube.buffer.delta().profile(face);
        let [columns, rows] = self.places.each_mut().map(|list| S::as_mut_simd_f32s(list).0);
        let leaves = S::as_mut_simd_u32s(&mut self.leaves).0;
        let shares = S::as_mut_simd_f32s(&mut self.shares).0;
        let batch = columns.iter_mut().zip(rows).zip(leaves.iter_mut().zip(shares));
        for ((column, row), (leaf, share)) in batch.take(count.div_ceil(S::F32_LANES)) {
            let cell = [*column, *row];
            let GridPoints::<S> { places, cells } = see(simd, &homographies, grid.size, cell);
            *share = factors(simd, profile, cell);
            [*column, *row] = places;
            *leaf = cells;
        }
    }

    /// Replaces the cells of a grid whose cells are not the leaves by the leaves.
    #[inline(always)]
    fn descend(&mut self, map: &ElementMap, grid: &Grid) {
        let places = self.places[0].iter().zip(&self.places[1]);
        for (leaf, (&u, &v)) in self.leaves[..self.count].iter_mut().zip(places) {
            *leaf = map.leaf(grid, *leaf, [u, v]);
        }
    }

    /// Adds the factors of the cells to the leaves they see, and lists those seen for the first time after
    /// the `found` that were before; returns how many those are then.
    #[inline(always)]
    fn scatter(&self, sums: &mut [f32], seen: &mut [LeafSum], mut found: usize) -> usize {
        let count = self.count;
        let mut put = |leaf: u32, share: f32| {
            let sum = &mut sums[leaf as usize];
            // Without a branch: nobody could foretell it.
            seen[found].leaf = leaf;
            found += usize::from(sum.to_bits() == 0);
            *sum += share;
        };
        // Neighbours often see the same leaf, and a sum is slow to read again just after it was written.
        let length = count / STREAMS;
        let stream = |k: usize| k * length..(k + 1) * length;
        let leaves: [&[u32]; STREAMS] = array::from_fn(|k| &self.leaves[stream(k)]);
        let shares: [&[f32]; STREAMS] = array::from_fn(|k| &self.shares[stream(k)]);
        for cell in 0..length {
            for (leaves, shares) in leaves.iter().zip(shares) {
                put(leaves[cell], shares[cell]);
            }
        }
        for cell in STREAMS * length..count {
            put(self.leaves[cell], self.shares[cell]);
        }
        found
    }
}

impl Homography {
    #[inline(always)]
    fn new(
        Hemicube { frame, buffer, .. }: &Hemicube<'_>,
        face: usize,
        piece: &BilinearChart<DVec3>,
        normal: DVec3,
    ) -> Self {
        let Frame { eye, axes } = *frame;
        let offset = eye - piece.origin;
        let plane = axes * (normal * (-1.0 / offset.dot(normal)));
        let [u, v] = piece.axes.map(
            #[inline(always)]
            |axis| axes * axis + plane * axis.dot(offset),
        );
        let by_cell = |n: DVec3| FACES[face].by_cell(n.as_vec3(), buffer.resolution());
        Self { over_depth: [u, v, plane].map(by_cell), bend: piece.bend }
    }

    /// Places that cells see, in the coordinates of the chart.
    #[inline(always)]
    fn places<S: Simd>(&self, simd: S, cell: [S::f32s; 2]) -> [S::f32s; 2] {
        let [u, v, w] = self.over_depth.map(
            #[inline(always)]
            |coefficients| linear(simd, coefficients, cell),
        );
        let depth = simd.div_f32s(simd.splat_f32s(1.0), w);
        let places = [simd.mul_f32s(u, depth), simd.mul_f32s(v, depth)];
        if self.bend == [0.0; 2] { places } else { straighten(simd, self.bend, places) }
    }
}

/// What cells see of a patch: of its pieces, each sees that whose middle is nearest.
#[inline(always)]
fn see<S: Simd>(
    simd: S,
    homographies: &[Homography],
    size: [u32; 2],
    cell: [S::f32s; 2],
) -> GridPoints<S> {
    let width = size[0] * homographies.len() as u32;
    let mut seen = GridPoints { places: cell, cells: simd.splat_u32s(0) };
    let mut nearest = simd.splat_f32s(f32::INFINITY);
    for (homography, first) in homographies.iter().zip((0..width).step_by(size[0] as usize)) {
        let places = homography.places(simd, cell);
        let here = on_grid(simd, places, size, first, width);
        if homographies.len() == 1 {
            return here;
        }
        let distance = from_middle(simd, places);
        let nearer = simd.less_than_f32s(distance, nearest);
        nearest = simd.select_f32s(nearer, distance, nearest);
        seen.cells = simd.select_u32s(nearer, here.cells, seen.cells);
        for (seen, here) in seen.places.iter_mut().zip(here.places) {
            *seen = simd.select_f32s(nearer, here, *seen);
        }
    }
    seen
}

/// Places of a chart on its piece of a grid, which begins at the column `first` of `width`.
#[inline(always)]
fn on_grid<S: Simd>(
    simd: S,
    places: [S::f32s; 2],
    size: [u32; 2],
    first: u32,
    width: u32,
) -> GridPoints<S> {
    let [s, t] = [0, 1].map(
        #[inline(always)]
        |k| simd.mul_f32s(places[k], simd.splat_f32s(size[k] as f32)),
    );
    let [i, j] = [(s, size[0]), (t, size[1])].map(
        #[inline(always)]
        // The nearest whole number to half a cell back is the cell's.
        |(at, size)| rounded(simd, simd.sub_f32s(at, simd.splat_f32s(0.5)), (size - 1) as f32),
    );
    let row = simd.add_u32s(simd.mul_u32s(j, simd.splat_u32s(width)), simd.splat_u32s(first));
    let s = simd.add_f32s(s, simd.splat_f32s(first as f32));
    GridPoints { places: [s, t], cells: simd.add_u32s(row, i) }
}

/// The larger of the distances from a chart's middle along its coordinates.
#[inline(always)]
fn from_middle<S: Simd>(simd: S, places: [S::f32s; 2]) -> S::f32s {
    let half = simd.splat_f32s(0.5);
    let [s, t] = places.map(
        #[inline(always)]
        |at| simd.max_f32s(simd.sub_f32s(at, half), simd.sub_f32s(half, at)),
    );
    simd.max_f32s(s, t)
}

/// A linear function, by its coefficients of 1, the column and the row.
#[inline(always)]
fn linear<S: Simd>(simd: S, coefficients: [f32; 3], [column, row]: [S::f32s; 2]) -> S::f32s {
    let [origin, by_column, by_row] = coefficients.map(
        #[inline(always)]
        |x| simd.splat_f32s(x),
    );
    let start = simd.add_f32s(origin, simd.mul_f32s(by_row, row));
    simd.add_f32s(start, simd.mul_f32s(by_column, column))
}

/// Delta factors of cells. Computed: a table of all would be read from far away.
#[inline(always)]
fn factors<S: Simd>(simd: S, profile: DeltaProfile, [column, row]: [S::f32s; 2]) -> S::f32s {
    let along = |[origin, step]: [f32; 2], at| {
        simd.add_f32s(simd.splat_f32s(origin), simd.mul_f32s(simd.splat_f32s(step), at))
    };
    let (x, y) = (along(profile.x, column), along(profile.y, row));
    let squares = simd.add_f32s(simd.mul_f32s(x, x), simd.mul_f32s(y, y));
    let square = simd.add_f32s(squares, simd.splat_f32s(1.0));
    simd.div_f32s(along(profile.scale, row), simd.mul_f32s(square, square))
}
