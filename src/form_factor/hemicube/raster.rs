//! Projection of polygons on the five faces, and the cells whose centres they cover.

use glam::{DMat3, DVec3, Vec3};
use smallvec::SmallVec;

/// A convex polygon in the frame of a hemicube whose eye is the origin and whose normal is +z.
type Local = SmallVec<[Vec3; 8]>;

/// Where a polygon covers a face.
pub(super) struct Footprint<'a> {
    /// First row, counted over all faces.
    pub(super) first_row: usize,
    /// Columns from the first to before the second, one pair a row; may be empty.
    pub(super) spans: &'a [[f32; 2]],
    /// Reciprocal depth at (column, row) is `depth[0] + depth[1] column + depth[2] (row - first_row)`.
    pub(super) depth: [f32; 3],
}

/// A face of the hemicube, as a view with coordinates (a, b, w) of depth w.
struct Face {
    /// Which of x, y, z are a, b and w.
    axes: [usize; 3],
    /// Whether w looks along or against its axis.
    sign: f32,
    /// Smallest b / w: -1 for the top, 0 for the half faces.
    lowest: f32,
}

const FACES: [Face; 5] = [
    Face { axes: [0, 1, 2], sign: 1.0, lowest: -1.0 },
    Face { axes: [1, 2, 0], sign: 1.0, lowest: 0.0 },
    Face { axes: [1, 2, 0], sign: -1.0, lowest: 0.0 },
    Face { axes: [0, 2, 1], sign: 1.0, lowest: 0.0 },
    Face { axes: [0, 2, 1], sign: -1.0, lowest: 0.0 },
];

/// Scratch space for clipping and scan conversion.
#[derive(Clone, Debug)]
pub(super) struct Raster {
    resolution: usize,
    spans: Vec<[f32; 2]>,
    clipped: [Vec<Vec3>; 2],
}

impl Raster {
    pub(super) fn new(resolution: usize) -> Self {
        Self { resolution, spans: vec![[0.0; 2]; resolution], clipped: [Vec::new(), Vec::new()] }
    }

    /// Hands the footprint of a polygon on each face it covers to `draw`. `frame` maps to the
    /// hemicube's axes.
    pub(super) fn project(
        &mut self,
        (eye, frame): (DVec3, &DMat3),
        (corners, normal): (&[DVec3], DVec3),
        mut draw: impl FnMut(Footprint<'_>),
    ) {
        let local: Local = corners.iter().map(|&c| (*frame * (c - eye)).as_vec3()).collect();
        if local.iter().all(|corner| corner.z <= 0.0) {
            return;
        }
        let plane = (*frame * normal / (corners[0] - eye).dot(normal)).as_vec3();
        let low = local.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = local.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let mut first_row = 0;
        for face in &FACES {
            if face.faces(low, high) && face.clip(&local, &mut self.clipped) {
                let rows = self.scan(face);
                let depth = self.depth(face, plane, rows.start);
                let spans = &self.spans[rows.clone()];
                draw(Footprint { first_row: first_row + rows.start, spans, depth });
            }
            first_row += face.rows(self.resolution);
        }
    }

    /// Fills the spans of the rows whose centres the clipped polygon crosses.
    fn scan(&mut self, face: &Face) -> std::ops::Range<usize> {
        let rows = face.rows(self.resolution);
        let [polygon, _] = &self.clipped;
        let at: SmallVec<[[f32; 2]; 8]> =
            polygon.iter().map(|&p| face.place(p, self.resolution)).collect();
        let low = at.iter().map(|p| p[1]).fold(f32::INFINITY, f32::min);
        let high = at.iter().map(|p| p[1]).fold(f32::NEG_INFINITY, f32::max);
        let (first, last) = (first_centre(low, rows), first_centre(high, rows));
        self.spans[first..last].fill([f32::INFINITY, f32::NEG_INFINITY]);
        let mut from = at[at.len() - 1];
        for &to in &at {
            let (lower, upper) = if from[1] < to[1] { (from, to) } else { (to, from) };
            let slope = (upper[0] - lower[0]) / (upper[1] - lower[1]);
            for row in first_centre(lower[1], rows)..first_centre(upper[1], rows) {
                let x = lower[0] + slope * (row as f32 + 0.5 - lower[1]);
                let span = &mut self.spans[row];
                *span = [span[0].min(x), span[1].max(x)];
            }
            from = to;
        }
        first..last
    }

    /// Coefficients of the reciprocal depth over columns and rows.
    fn depth(&self, face: &Face, plane: Vec3, first_row: usize) -> [f32; 3] {
        // On the plane n·p = 1, 1/w = nₐ a/w + n_b b/w + n_w.
        let n = face.look(plane);
        let step = 2.0 / self.resolution as f32;
        let origin =
            n.x * (0.5 * step - 1.0) + n.y * ((first_row as f32 + 0.5) * step + face.lowest) + n.z;
        [origin, n.x * step, n.y * step]
    }
}

/// First row or column whose centre is beyond `position`.
pub(super) fn first_centre(position: f32, count: usize) -> usize {
    // Casting saturates, and rounds towards zero.
    ((position + 0.5) as usize).min(count)
}

impl Face {
    fn rows(&self, resolution: usize) -> usize {
        if self.lowest < 0.0 { resolution } else { resolution / 2 }
    }

    fn look(&self, p: Vec3) -> Vec3 {
        let p = p.to_array();
        Vec3::new(p[self.axes[0]], p[self.axes[1]], p[self.axes[2]] * self.sign)
    }

    /// False only if a box is nowhere in front of the face.
    fn faces(&self, low: Vec3, high: Vec3) -> bool {
        self.look(if self.sign > 0.0 { high } else { low }).z > 0.0
    }

    /// How far a point of the view is inside of each of the four planes through the eye that bound
    /// the face.
    fn depths(&self, p: Vec3) -> [f32; 4] {
        [p.z + p.x, p.z - p.x, p.y - self.lowest * p.z, p.z - p.y]
    }

    /// Position in cells of a point of the view in front of the eye.
    fn place(&self, p: Vec3, resolution: usize) -> [f32; 2] {
        let scale = resolution as f32 / 2.0 / p.z;
        [(p.x + p.z) * scale, (p.y - self.lowest * p.z) * scale]
    }

    /// Leaves the part of a polygon that the face sees in the first of the buffers; false if there is none.
    fn clip(&self, polygon: &[Vec3], [clipped, spare]: &mut [Vec<Vec3>; 2]) -> bool {
        clipped.clear();
        clipped.extend(polygon.iter().map(|&corner| self.look(corner)));
        let (mut outside_all, mut outside_any) = (0b1111, 0);
        for &corner in clipped.iter() {
            let depths = self.depths(corner);
            let outside = (0..4).fold(0, |bits, k| bits | u32::from(depths[k] <= 0.0) << k);
            outside_all &= outside;
            outside_any |= outside;
        }
        if outside_all != 0 {
            return false;
        }
        for side in (0..4).filter(|side| outside_any >> side & 1 == 1) {
            self.cut(side, clipped, spare);
            std::mem::swap(clipped, spare);
        }
        // Only a polygon that runs through the eye itself has corners without depth.
        clipped.len() >= 3 && clipped.iter().all(|p| p.z > 0.0)
    }

    /// The part of a polygon inside of one of the planes that bound the face.
    fn cut(&self, side: usize, polygon: &[Vec3], inside: &mut Vec<Vec3>) {
        inside.clear();
        let Some(&last) = polygon.last() else { return };
        let (mut from, mut depth) = (last, self.depths(last)[side]);
        for &to in polygon {
            let next = self.depths(to)[side];
            if depth * next < 0.0 {
                inside.push(from.lerp(to, depth / (depth - next)));
            }
            if next >= 0.0 {
                inside.push(to);
            }
            (from, depth) = (to, next);
        }
    }
}
