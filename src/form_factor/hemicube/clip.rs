//! Corners in the frame of a hemicube, and what of a polygon each of its five faces sees.

use std::ops::Range;

use glam::Vec3;
use smallvec::SmallVec;

use super::frame::Frame;

/// A part of a convex polygon, in the coordinates of a face.
pub(super) type ClippedPolygon = SmallVec<[Vec3; 16]>;

/// Corners of convex polygons in the frame of a hemicube whose eye is the origin and whose normal is +z.
#[derive(Clone, Debug, Default)]
pub(super) struct LocalCorners {
    at: [Vec<f32>; 3],
    /// On which sides of the planes between the faces they are: bits that are set where z - x,
    /// z + x, z - y, z + y, x - y, x + y and z are negative.
    sides: Vec<u32>,
}

/// Bit of [`LocalCorners::sides`] set below the horizon.
const BELOW: u32 = 1 << 6;

/// A face of the hemicube, as a view with coordinates (a, b, w) of depth w.
#[derive(Debug)]
pub(super) struct HemicubeFace {
    /// Which of x, y, z are a, b and w.
    pub(super) axes: [usize; 3],
    /// Whether w looks along or against its axis.
    pub(super) sign: f32,
    /// Smallest b / w: -1 for the top, 0 for the half faces.
    pub(super) lowest: f32,
    /// Bits of [`LocalCorners::sides`] that are clear, and that are set, for what the face sees.
    clear: u32,
    set: u32,
}

pub(super) const FACES: [HemicubeFace; 5] = [
    HemicubeFace { axes: [0, 1, 2], sign: 1.0, lowest: -1.0, clear: 0b000_1111, set: 0 },
    HemicubeFace { axes: [1, 2, 0], sign: 1.0, lowest: 0.0, clear: 0b111_0000, set: 0b000_0001 },
    HemicubeFace { axes: [1, 2, 0], sign: -1.0, lowest: 0.0, clear: 0b100_0000, set: 0b011_0010 },
    HemicubeFace { axes: [0, 2, 1], sign: 1.0, lowest: 0.0, clear: 0b110_0000, set: 0b001_0100 },
    HemicubeFace { axes: [0, 2, 1], sign: -1.0, lowest: 0.0, clear: 0b101_0000, set: 0b010_1000 },
];

impl LocalCorners {
    /// Replaces all by points of space, by coordinate, m.
    #[inline(always)]
    #[allow(clippy::needless_range_loop, reason = "seven lists in step, for the vectorizer")]
    pub(super) fn place(&mut self, points: [&[f64]; 3], frame: &Frame) {
        let count = points[0].len();
        self.at.iter_mut().for_each(|list| list.resize(count, 0.0));
        self.sides.resize(count, 0);
        let [xs, ys, zs] = points.map(|list| &list[..count]);
        let [ax, ay, az] = self.at.each_mut().map(|list| &mut list[..count]);
        let sides = &mut self.sides[..count];
        let Frame { eye, axes } = frame;
        let [rx, ry, rz] = [axes.row(0), axes.row(1), axes.row(2)];
        for k in 0..count {
            // In 64 bits: near a contact, heights are much smaller than distances.
            let (x, y, z) = (xs[k] - eye.x, ys[k] - eye.y, zs[k] - eye.z);
            ax[k] = (rx.x * x + rx.y * y + rx.z * z) as f32;
            ay[k] = (ry.x * x + ry.y * y + ry.z * z) as f32;
            az[k] = (rz.x * x + rz.y * y + rz.z * z) as f32;
        }
        for k in 0..count {
            let (x, y, z) = (ax[k], ay[k], az[k]);
            sides[k] = bit(z - x, 0)
                | bit(z + x, 1)
                | bit(z - y, 2)
                | bit(z + y, 3)
                | bit(x - y, 4)
                | bit(x + y, 5)
                | bit(z, 6);
        }
    }

    /// The convex polygon with some of the corners.
    #[inline(always)]
    pub(super) fn polygon(&self, range: Range<usize>) -> LocalPolygon<'_> {
        LocalPolygon { corners: self, range }
    }
}

/// A convex polygon in the frame of a hemicube.
pub(super) struct LocalPolygon<'a> {
    corners: &'a LocalCorners,
    range: Range<usize>,
}

impl LocalPolygon<'_> {
    /// Its corners in the coordinates of a face.
    #[inline(always)]
    pub(super) fn seen_by(
        &self,
        face: &HemicubeFace,
    ) -> impl ExactSizeIterator<Item = Vec3> + Clone {
        let [a, b, w] = face.axes.map(|axis| &self.corners.at[axis][self.range.clone()]);
        let sign = face.sign;
        a.iter().zip(b).zip(w).map(
            #[inline(always)]
            move |((&a, &b), &w)| Vec3::new(a, b, w * sign),
        )
    }

    /// The sides on which all of its corners are, and those on which any of them is.
    #[inline(always)]
    pub(super) fn sides(&self) -> [u32; 2] {
        let sides = self.corners.sides[self.range.clone()].iter();
        sides.fold([u32::MAX, 0], |[all, any], &side| [all & side, any | side])
    }
}

/// A bit that is set if a value is negative.
#[inline(always)]
fn bit(value: f32, position: u32) -> u32 {
    value.to_bits() >> 31 << position
}

/// True if all corners are below the horizon.
#[inline(always)]
pub(super) fn is_below([all, _]: [u32; 2]) -> bool {
    all & BELOW != 0
}

impl HemicubeFace {
    pub(super) fn rows(&self, resolution: usize) -> usize {
        if self.lowest < 0.0 { resolution } else { resolution / 2 }
    }

    /// A vector in the coordinates of the face.
    #[inline(always)]
    pub(super) fn look(&self, p: Vec3) -> Vec3 {
        let p = p.to_array();
        Vec3::new(p[self.axes[0]], p[self.axes[1]], p[self.axes[2]] * self.sign)
    }

    /// The value of a linear function of directions at a row's and column's centre, as coefficients of
    /// 1, the column and the row, for directions (a, b, 1).
    #[inline(always)]
    pub(super) fn by_cell(&self, n: Vec3, resolution: usize) -> [f32; 3] {
        let n = self.look(n);
        let step = 2.0 / resolution as f32;
        let origin = n.x * (0.5 * step - 1.0) + n.y * (0.5 * step + self.lowest) + n.z;
        [origin, n.x * step, n.y * step]
    }

    /// True only if the face sees nothing of a polygon whose corners are on these sides.
    #[inline(always)]
    pub(super) fn misses(&self, [all, any]: [u32; 2]) -> bool {
        (all & self.clear) | (!any & self.set) != 0
    }

    /// True if the face may not see all of a polygon whose corners are on these sides.
    #[inline(always)]
    pub(super) fn cuts(&self, [all, any]: [u32; 2]) -> bool {
        (any & self.clear) | (!all & self.set) != 0
    }

    /// Leaves the part of a polygon that the face sees in the first of the buffers; false if there is none.
    pub(super) fn clip(
        &self,
        polygon: impl Iterator<Item = Vec3>,
        [clipped, spare]: &mut [ClippedPolygon; 2],
    ) -> bool {
        clipped.clear();
        clipped.extend(polygon);
        for side in 0..4 {
            if clipped.iter().any(|&corner| self.depth(corner, side) <= 0.0) {
                self.cut(side, clipped, spare);
                std::mem::swap(clipped, spare);
            }
        }
        // Only a polygon that runs through the eye itself has corners without depth.
        clipped.len() >= 3 && clipped.iter().all(|p| p.z > 0.0)
    }

    /// How far a point of the view is inside of one of the four planes through the eye that bound the face.
    #[inline(always)]
    fn depth(&self, p: Vec3, side: usize) -> f32 {
        match side {
            0 => p.z + p.x,
            1 => p.z - p.x,
            2 => p.y - self.lowest * p.z,
            _ => p.z - p.y,
        }
    }

    /// The part of a polygon inside of one of the planes that bound the face.
    #[inline(always)]
    fn cut(&self, side: usize, polygon: &[Vec3], inside: &mut ClippedPolygon) {
        inside.clear();
        let Some(&last) = polygon.last() else { return };
        let (mut from, mut depth) = (last, self.depth(last, side));
        for &to in polygon {
            let next = self.depth(to, side);
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
