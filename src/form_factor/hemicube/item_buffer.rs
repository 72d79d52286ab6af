//! What the cells of a hemicube see: the item buffer, face by face.

use glam::Vec3;
use pulp::Simd;

use super::cells::FaceCell;
use super::clip::FACES;
use super::delta::DeltaFactors;
use super::raster::{Footprint, LANES, count_up};

pub(super) use crate::visibility::packet::NOTHING;

/// Cells of the five faces, row by row; rows are filled up to whole registers.
#[derive(Clone, Debug)]
pub(super) struct ItemBuffer<'a> {
    delta: &'a DeltaFactors,
    /// Cells in a row, those beyond the resolution included.
    stride: usize,
    /// Reciprocal depth of what each cell sees.
    depth: Vec<f32>,
    /// Patch that each cell sees.
    item: Vec<u32>,
}

/// Cells beside each other that see the same patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    /// The patch, or [`NOTHING`].
    pub(super) patch: u32,
    pub(super) face: u16,
    pub(super) row: u16,
    /// Columns from the first to before the second.
    pub(super) columns: [u16; 2],
    /// The span of the same patch before it, or [`NOTHING`].
    pub(super) before: u32,
}

impl<'a> ItemBuffer<'a> {
    /// Cells that weigh what `delta` says.
    pub(super) fn new(delta: &'a DeltaFactors) -> Self {
        let resolution = delta.resolution();
        let stride = resolution.next_multiple_of(LANES);
        let count = 3 * resolution * stride;
        let (depth, item) = (vec![0.0; count], vec![NOTHING; count]);
        Self { delta, stride, depth, item }
    }

    /// Cells along the edge of the top face.
    #[inline(always)]
    pub(super) fn resolution(&self) -> usize {
        self.delta.resolution()
    }

    /// What the cells weigh.
    #[inline(always)]
    pub(super) fn delta(&self) -> &'a DeltaFactors {
        self.delta
    }

    /// Puts a patch and its reciprocal depth into a cell.
    pub(super) fn put(
        &mut self,
        face: usize,
        [row, column]: [usize; 2],
        patch: u32,
        nearness: f32,
    ) {
        let cell = (self.first_row(face) + row) * self.stride + column;
        self.item[cell] = patch;
        self.depth[cell] = nearness;
    }

    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.depth.fill(0.0);
        self.item.fill(NOTHING);
    }

    /// Draws a patch where it is nearest; depths are multiplied by `recess`. Returns the sum of the
    /// delta factors of all cells it covers.
    #[inline(always)]
    pub(super) fn draw<S: Simd>(
        &mut self,
        simd: S,
        footprint: &Footprint<'_>,
        patch: u32,
        recess: f32,
    ) -> f32 {
        let mut covered = 0.0;
        let (delta, face) = (self.delta, footprint.face);
        let first_row = self.first_row(face);
        footprint.for_each_row(
            simd,
            #[inline(always)]
            |row, from, to| {
                let sums = delta.sums(face, row);
                covered += sums[to] - sums[from];
                let [first, step] = footprint.nearness(row).map(|nearness| nearness * recess);
                let start = (first_row + row) * self.stride;
                let depths = S::as_mut_simd_f32s(&mut self.depth[start..start + self.stride]).0;
                let items = S::as_mut_simd_u32s(&mut self.item[start..start + self.stride]).0;
                let registers = from / S::F32_LANES..to.div_ceil(S::F32_LANES);
                let [first, step] = [first, step].map(|value| simd.splat_f32s(value));
                let patch = simd.splat_f32s(f32::from_bits(patch));
                let zero = simd.splat_f32s(0.0);
                let mut column = count_up(simd, registers.start * S::F32_LANES);
                let [from, to] = [from, to].map(|end| simd.splat_f32s(end as f32));
                let cells = depths[registers.clone()].iter_mut().zip(&mut items[registers]);
                for (depth, item) in cells {
                    let nearness = simd.add_f32s(first, simd.mul_f32s(step, column));
                    let inside = simd.and_m32s(
                        simd.greater_than_or_equal_f32s(column, from),
                        simd.less_than_f32s(column, to),
                    );
                    let nearer = simd.and_m32s(inside, simd.greater_than_f32s(nearness, *depth));
                    // Plain selections compile to masked stores, which are slow on many processors.
                    *depth = simd.max_f32s(simd.select_f32s(nearer, nearness, zero), *depth);
                    let new = simd.select_f32s(nearer, patch, zero);
                    let old = simd.select_f32s(nearer, zero, simd.transmute_f32s_u32s(*item));
                    *item = simd.transmute_u32s_f32s(simd.max_f32s(new, old));
                    column = simd.add_f32s(column, simd.splat_f32s(S::F32_LANES as f32));
                }
            },
        );
        covered
    }

    /// Calls `visit` for each span of cells that see the same, row by row.
    #[inline(always)]
    pub(super) fn for_each_span(&self, mut visit: impl FnMut(Span)) {
        for (face, shape) in FACES.iter().enumerate() {
            for row in 0..shape.rows(self.resolution()) {
                let items = self.items(face, row);
                let mut start = 0;
                for_each_end(
                    items,
                    #[inline(always)]
                    |end| {
                        let (patch, columns) = (items[start], [start as u16, end as u16]);
                        let [face, row] = [face, row].map(|k| k as u16);
                        visit(Span { patch, face, row, columns, before: NOTHING });
                        start = end;
                    },
                );
            }
        }
    }

    /// Each row as its face, its number there and its patches.
    #[inline(always)]
    pub(super) fn rows(&self) -> impl Iterator<Item = (usize, usize, &[u32])> {
        FACES.iter().enumerate().flat_map(move |(face, shape)| {
            let rows = 0..shape.rows(self.resolution());
            rows.map(move |row| (face, row, self.items(face, row)))
        })
    }

    /// The patches that the cells of a row see.
    #[inline(always)]
    pub(super) fn items(&self, face: usize, row: usize) -> &[u32] {
        let start = (self.first_row(face) + row) * self.stride;
        &self.item[start..start + self.stride][..self.resolution()]
    }

    /// The patch that the cell in a direction above the horizon, in the hemicube's frame, and all around it see, if it
    /// is one and the same.
    pub(super) fn item_around(&self, direction: Vec3) -> Option<u32> {
        let resolution = self.resolution();
        let FaceCell { face, row, column } = FaceCell::along(direction, resolution);
        let is_inside = |at: usize, count: usize| at >= 1 && at + 1 < count;
        if !is_inside(column, resolution) || !is_inside(row, FACES[face].rows(resolution)) {
            return None;
        }
        let item = self.items(face, row)[column];
        let mut rows = (row - 1..=row + 1).map(|row| self.items(face, row));
        let is_alone = rows.all(|row| row[column - 1..=column + 1].iter().all(|&k| k == item));
        (is_alone && item != NOTHING).then_some(item)
    }

    /// The reciprocal depths that the cells of a row see.
    #[inline(always)]
    pub(super) fn depths(&self, face: usize, row: usize) -> &[f32] {
        let start = (self.first_row(face) + row) * self.stride;
        &self.depth[start..start + self.stride][..self.resolution()]
    }

    /// Rows before those of a face.
    #[inline(always)]
    fn first_row(&self, face: usize) -> usize {
        let half = self.resolution() / 2;
        if face == 0 { 0 } else { (face + 1) * half }
    }
}

/// Calls `visit` with the ends of runs of equal items.
#[inline(always)]
fn for_each_end(items: &[u32], mut visit: impl FnMut(usize)) {
    let mut first = 0;
    while let (Some(here), Some(next)) =
        (items[first..].first_chunk::<LANES>(), items[first + 1..].first_chunk::<LANES>())
    {
        let mut ends = 0;
        for lane in 0..LANES {
            ends |= u32::from(here[lane] != next[lane]) << lane;
        }
        while ends != 0 {
            visit(first + ends.trailing_zeros() as usize + 1);
            ends &= ends - 1;
        }
        first += LANES;
    }
    for column in first + 1..items.len() {
        if items[column] != items[column - 1] {
            visit(column);
        }
    }
    visit(items.len());
}
