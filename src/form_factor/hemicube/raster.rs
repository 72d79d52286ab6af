//! The cells of a face whose centres a polygon covers, a register of rows at a time.

use glam::Vec3;
use pulp::Simd;
use smallvec::SmallVec;

use super::clip::{ClippedPolygon, FACES, HemicubeFace, LocalPolygon, is_below};

/// Most numbers that a register holds.
pub(super) const LANES: usize = 16;

/// Above this power of two 32-bit floating point numbers are whole: adding it rounds.
const WHOLE: f32 = 8_388_608.0;

/// Where a polygon covers a face.
pub(super) struct Footprint<'a> {
    /// Number of the face.
    pub(super) face: usize,
    /// Reciprocal depth at a cell's centre is `depth[0] + depth[1] column + depth[2] row`.
    pub(super) depth: [f32; 3],
    resolution: usize,
    edges: &'a [ScanEdge],
    /// First and last but one row whose centre is covered.
    rows: [i32; 2],
}

/// An edge of a polygon, in cells, and the rows from the first to before the second whose centres it
/// crosses.
#[derive(Clone, Copy, Debug, Default)]
struct ScanEdge {
    start: [f32; 2],
    slope: f32,
    rows: [i32; 2],
}

/// Scratch space for clipping and scan conversion.
#[derive(Clone, Debug, Default)]
pub(super) struct Raster {
    clipped: [ClippedPolygon; 2],
    edges: SmallVec<[ScanEdge; 16]>,
}

impl Raster {
    /// Hands the footprint of a polygon on each face it covers to `draw`; in its plane, `plane` · p = 1.
    #[inline(always)]
    pub(super) fn project(
        &mut self,
        resolution: usize,
        polygon: &LocalPolygon<'_>,
        plane: Vec3,
        mut draw: impl FnMut(&Footprint<'_>),
    ) {
        let sides = polygon.sides();
        if is_below(sides) {
            return;
        }
        for (number, face) in FACES.iter().enumerate() {
            if face.misses(sides) {
                continue;
            }
            let seen = polygon.seen_by(face);
            let rows = if !face.cuts(sides) {
                trace(seen, face, resolution, &mut self.edges)
            } else if face.clip(seen, &mut self.clipped) {
                trace(self.clipped[0].iter().copied(), face, resolution, &mut self.edges)
            } else {
                continue;
            };
            let depth = face.by_cell(plane, resolution);
            draw(&Footprint { face: number, depth, resolution, edges: &self.edges, rows });
        }
    }
}

/// Lists the edges of a polygon that a face sees whole and that cross a row's centre; returns the rows
/// they cross.
#[inline(always)]
fn trace(
    polygon: impl ExactSizeIterator<Item = Vec3>,
    face: &HemicubeFace,
    resolution: usize,
    edges: &mut SmallVec<[ScanEdge; 16]>,
) -> [i32; 2] {
    let most = face.rows(resolution) as i32;
    let half = resolution as f32 / 2.0;
    edges.resize(polygon.len(), ScanEdge::default());
    let mut rows = [i32::MAX, 0];
    let mut corners = polygon.map(
        #[inline(always)]
        |corner| corner_at(face, corner, half, most),
    );
    let Some(start) = corners.next() else { return [0, 0] };
    let (mut from, mut count) = (start, 0);
    for to in corners.chain(std::iter::once(start)) {
        // Edges are as good as random: without branches, nothing is foretold wrongly.
        let ends = [from, to];
        let lower = usize::from(from.0[1] >= to.0[1]);
        let [lower, upper] = [ends[lower], ends[1 - lower]];
        let slope = (upper.0[0] - lower.0[0]) / (upper.0[1] - lower.0[1]);
        edges[count] = ScanEdge { start: lower.0, slope, rows: [lower.1, upper.1] };
        count += usize::from(lower.1 < upper.1);
        rows = [rows[0].min(to.1), rows[1].max(to.1)];
        from = to;
    }
    edges.truncate(count);
    rows
}

/// Where a point is on a face, in cells, and the first row whose centre is beyond it.
#[inline(always)]
fn corner_at(face: &HemicubeFace, p: Vec3, half: f32, most: i32) -> ([f32; 2], i32) {
    let scale = half / p.z;
    let at = [(p.x + p.z) * scale, (p.y - face.lowest * p.z) * scale];
    (at, first_centre(at[1], most))
}

impl Footprint<'_> {
    /// Calls `visit` with each row of the face and its columns from the first to before the second.
    #[inline(always)]
    pub(super) fn for_each_row<S: Simd>(
        &self,
        simd: S,
        mut visit: impl FnMut(usize, usize, usize),
    ) {
        let [mut first, end] = self.rows.map(|row| row as usize);
        while first < end {
            let [from, to] = self.columns(simd, first);
            for lane in 0..S::F32_LANES.min(end - first) {
                if from[lane] < to[lane] {
                    visit(first + lane, from[lane] as usize, to[lane] as usize);
                }
            }
            first += S::F32_LANES;
        }
    }

    /// Columns from the first to before the second in as many rows from `first` on as a register holds.
    #[inline(always)]
    fn columns<S: Simd>(&self, simd: S, first: usize) -> [[u32; LANES]; 2] {
        let row = count_up(simd, first);
        let centre = simd.add_f32s(row, simd.splat_f32s(0.5));
        let mut low = simd.splat_f32s(f32::INFINITY);
        let mut high = simd.splat_f32s(f32::NEG_INFINITY);
        for edge in self.edges {
            let [x, y] = edge.start.map(|value| simd.splat_f32s(value));
            let run = simd.mul_f32s(simd.splat_f32s(edge.slope), simd.sub_f32s(centre, y));
            let x = simd.add_f32s(x, run);
            let [start, end] = edge.rows.map(|row| simd.splat_f32s(row as f32));
            let crosses = simd.and_m32s(
                simd.greater_than_or_equal_f32s(row, start),
                simd.less_than_f32s(row, end),
            );
            let further = |mask| simd.and_m32s(crosses, mask);
            low = simd.select_f32s(further(simd.less_than_f32s(x, low)), x, low);
            high = simd.select_f32s(further(simd.greater_than_f32s(x, high)), x, high);
        }
        let mut columns = [[0; LANES]; 2];
        for (columns, ends) in columns.iter_mut().zip([low, high]) {
            // The nearest whole number to a position is the first column whose centre is beyond it.
            let ends = rounded(simd, ends, self.resolution as f32);
            S::as_mut_simd_u32s(columns).0[0] = ends;
        }
        columns
    }

    /// Reciprocal depth at the first cell of a row, and what it grows by from column to column.
    #[inline(always)]
    pub(super) fn nearness(&self, row: usize) -> [f32; 2] {
        let [origin, by_column, by_row] = self.depth;
        [origin + by_row * row as f32, by_column]
    }
}

/// First row whose centre is beyond `position`.
#[inline(always)]
fn first_centre(position: f32, count: i32) -> i32 {
    // Casting saturates, and rounds towards zero.
    ((position + 0.5) as i32).clamp(0, count)
}

/// The whole numbers from 0 to `most` nearest to the values.
#[inline(always)]
pub(super) fn rounded<S: Simd>(simd: S, values: S::f32s, most: f32) -> S::u32s {
    let [zero, most, whole] = [0.0, most, WHOLE].map(
        #[inline(always)]
        |x| simd.splat_f32s(x),
    );
    // Of a number and none, the number is the larger on all processors.
    let value = simd.min_f32s(simd.max_f32s(values, zero), most);
    let value = simd.transmute_u32s_f32s(simd.add_f32s(value, whole));
    simd.sub_u32s(value, simd.transmute_u32s_f32s(whole))
}

/// The whole numbers from `first` on.
#[inline(always)]
pub(super) fn count_up<S: Simd>(simd: S, first: usize) -> S::f32s {
    const UP: [f32; LANES] =
        [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];
    simd.add_f32s(simd.splat_f32s(first as f32), S::as_simd_f32s(&UP).0[0])
}
