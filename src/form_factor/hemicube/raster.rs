//! Projection of polygons on the five faces, and the cells whose centres they cover.

use glam::{DMat3, DVec3};
use smallvec::SmallVec;

/// A convex polygon in the frame of a hemicube whose eye is the origin and whose normal is +z.
type Local = SmallVec<[DVec3; 8]>;

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
    sign: f64,
    /// Smallest b / w: -1 for the top, 0 for the half faces.
    lowest: f64,
}

const FACES: [Face; 5] = [
    Face { axes: [0, 1, 2], sign: 1.0, lowest: -1.0 },
    Face { axes: [1, 2, 0], sign: 1.0, lowest: 0.0 },
    Face { axes: [1, 2, 0], sign: -1.0, lowest: 0.0 },
    Face { axes: [0, 2, 1], sign: 1.0, lowest: 0.0 },
    Face { axes: [0, 2, 1], sign: -1.0, lowest: 0.0 },
];

/// Scratch space for scan conversion.
#[derive(Clone, Debug)]
pub(super) struct Raster {
    resolution: usize,
    spans: Vec<[f32; 2]>,
}

impl Raster {
    pub(super) fn new(resolution: usize) -> Self {
        Self { resolution, spans: vec![[0.0; 2]; resolution] }
    }

    /// Hands the footprint of a polygon on each face it covers to `draw`. `frame` maps to the hemicube's axes.
    pub(super) fn project(
        &mut self,
        (eye, frame): (DVec3, &DMat3),
        (corners, normal): (&[DVec3], DVec3),
        mut draw: impl FnMut(Footprint<'_>),
    ) {
        let local: Local = corners.iter().map(|&corner| *frame * (corner - eye)).collect();
        if local.iter().all(|corner| corner.z <= 0.0) {
            return;
        }
        let plane = *frame * normal / (corners[0] - eye).dot(normal);
        let mut first_row = 0;
        for face in &FACES {
            let view: Local = local.iter().map(|&corner| face.look(corner)).collect();
            if let Some(visible) = face.clip(view) {
                let rows = self.scan(face, &visible);
                let depth = self.depth(face, plane, rows.start);
                let spans = &self.spans[rows.clone()];
                draw(Footprint { first_row: first_row + rows.start, spans, depth });
            }
            first_row += face.rows(self.resolution);
        }
    }

    /// Cell that a direction falls on, as (row counted over all faces, column).
    pub(super) fn cell(&self, local: DVec3) -> Option<(usize, usize)> {
        let mut first_row = 0;
        for face in &FACES {
            let view = face.look(local);
            let rows = face.rows(self.resolution);
            if face.sides().all(|side| side.dot(view) >= 0.0) && view.z > 0.0 {
                let [x, y] = face.place(view, self.resolution);
                let column = (x as usize).min(self.resolution - 1);
                return Some((first_row + (y as usize).min(rows - 1), column));
            }
            first_row += rows;
        }
        None
    }

    /// Fills the spans of the rows whose centres the polygon crosses.
    fn scan(&mut self, face: &Face, polygon: &[DVec3]) -> std::ops::Range<usize> {
        let rows = face.rows(self.resolution);
        let at: SmallVec<[[f32; 2]; 8]> =
            polygon.iter().map(|&p| face.place(p, self.resolution).map(|x| x as f32)).collect();
        let low = at.iter().map(|p| p[1]).fold(f32::INFINITY, f32::min);
        let high = at.iter().map(|p| p[1]).fold(f32::NEG_INFINITY, f32::max);
        let (first, last) = (first_centre(low, rows), first_centre(high, rows));
        self.spans[first..last].fill([f32::INFINITY, f32::NEG_INFINITY]);
        for (k, &from) in at.iter().enumerate() {
            let to = at[(k + 1) % at.len()];
            let (from, to) = if from[1] < to[1] { (from, to) } else { (to, from) };
            let slope = (to[0] - from[0]) / (to[1] - from[1]);
            for row in first_centre(from[1], rows)..first_centre(to[1], rows) {
                let x = from[0] + slope * (row as f32 + 0.5 - from[1]);
                let span = &mut self.spans[row];
                *span = [span[0].min(x), span[1].max(x)];
            }
        }
        first..last
    }

    /// Coefficients of the reciprocal depth over columns and rows.
    fn depth(&self, face: &Face, plane: DVec3, first_row: usize) -> [f32; 3] {
        // On the plane n·p = 1, 1/w = nₐ a/w + n_b b/w + n_w.
        let n = face.look(plane);
        let step = 2.0 / self.resolution as f64;
        let origin =
            n.x * (0.5 * step - 1.0) + n.y * ((first_row as f64 + 0.5) * step + face.lowest) + n.z;
        [origin as f32, (n.x * step) as f32, (n.y * step) as f32]
    }
}

/// First row or column whose centre is not below `position`.
pub(super) fn first_centre(position: f32, count: usize) -> usize {
    ((position - 0.5).ceil().max(0.0) as usize).min(count)
}

impl Face {
    fn rows(&self, resolution: usize) -> usize {
        if self.lowest < 0.0 { resolution } else { resolution / 2 }
    }

    fn look(&self, p: DVec3) -> DVec3 {
        DVec3::new(p[self.axes[0]], p[self.axes[1]], p[self.axes[2]] * self.sign)
    }

    /// Inward normals of the four planes through the eye that bound the face.
    fn sides(&self) -> impl Iterator<Item = DVec3> {
        let floor = DVec3::new(0.0, 1.0, -self.lowest);
        [DVec3::new(1.0, 0.0, 1.0), DVec3::new(-1.0, 0.0, 1.0), floor, DVec3::new(0.0, -1.0, 1.0)]
            .into_iter()
    }

    /// Position in cells of a point of the view in front of the eye.
    fn place(&self, p: DVec3, resolution: usize) -> [f64; 2] {
        let scale = resolution as f64 / 2.0 / p.z;
        [(p.x + p.z) * scale, (p.y - self.lowest * p.z) * scale]
    }

    /// The part of a polygon that the face sees.
    fn clip(&self, mut polygon: Local) -> Option<Local> {
        for side in self.sides() {
            let inside = polygon.iter().filter(|p| side.dot(**p) > 0.0).count();
            if inside == 0 {
                return None;
            }
            if inside < polygon.len() {
                polygon = cut(&polygon, side);
            }
        }
        // Only a polygon that runs through the eye itself has corners without depth.
        (polygon.len() >= 3 && polygon.iter().all(|p| p.z > 0.0)).then_some(polygon)
    }
}

fn cut(polygon: &[DVec3], side: DVec3) -> Local {
    let mut inside = Local::new();
    for (k, &corner) in polygon.iter().enumerate() {
        let next = polygon[(k + 1) % polygon.len()];
        let (from, to) = (side.dot(corner), side.dot(next));
        if from >= 0.0 {
            inside.push(corner);
        }
        if from * to < 0.0 {
            inside.push(corner.lerp(next, from / (from - to)));
        }
    }
    inside
}
