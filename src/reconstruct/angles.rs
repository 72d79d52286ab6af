//! How slender the triangles are.

use glam::DVec3;
use serde::Serialize;

use super::trimesh::TriMesh;

/// Width of a bin of the histogram, degrees.
const BIN: f64 = 5.0;

/// The smallest angle of each triangle, which is at most 60°.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Angles {
    /// The smallest of all, degrees; 0 without triangles, or if one has no area.
    pub smallest: f64,
    /// Share of the triangles that have an angle below 10°, 0..=1.
    pub below_ten: f64,
    /// Triangles by their smallest angle, in bins of 5°.
    pub histogram: [usize; 12],
}

impl TriMesh {
    /// The smallest angles of the triangles.
    pub fn angles(&self) -> Angles {
        if self.triangles.is_empty() {
            return Angles::default();
        }
        let mut angles = Angles { smallest: 180.0, ..Angles::default() };
        let mut slender = 0;
        for triangle in &self.triangles {
            let smallest = smallest_angle(triangle.map(|v| self.positions[v as usize]));
            angles.smallest = angles.smallest.min(smallest);
            slender += usize::from(smallest < 10.0);
            let last = angles.histogram.len() - 1;
            angles.histogram[((smallest / BIN) as usize).min(last)] += 1;
        }
        angles.below_ten = slender as f64 / self.triangles.len() as f64;
        angles
    }
}

/// The smallest angle of a triangle, degrees: that opposite its shortest side.
fn smallest_angle(corners: [DVec3; 3]) -> f64 {
    let angle = |k: usize| {
        let [a, b] = [1, 2].map(|step| corners[(k + step) % 3] - corners[k]);
        // Better than by the cosine where the angle is small.
        a.cross(b).length().atan2(a.dot(b)).to_degrees()
    };
    (0..3).map(angle).fold(180.0, f64::min)
}
