//! How much a luminaire sends in each direction: a table of candela over angles.

use std::f64::consts::PI;

use glam::DVec3;
use serde::Serialize;

/// The luminous intensities of a luminaire in C-planes (type C photometry), linear between angles.
///
/// Vertical angles are from straight down, horizontal ones counter-clockwise seen from above.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Photometry {
    /// What the file calls it.
    pub name: String,
    /// Degrees, ascending, 0..=180; nothing shines outside of them.
    pub(super) vertical: Vec<f64>,
    /// Degrees, ascending, 0..=360; the rest follows by symmetry.
    pub(super) horizontal: Vec<f64>,
    /// Candela, all multipliers applied: for each horizontal angle, one by vertical angle.
    pub(super) candela: Vec<f64>,
}

impl Photometry {
    /// Luminous intensity, cd, in a unit `direction` away from the luminaire, Y up, horizontal angle 0
    /// along +X.
    pub fn candela(&self, direction: DVec3) -> f64 {
        let vertical = (-direction.y).clamp(-1.0, 1.0).acos().to_degrees();
        // Seen from above, with X to the right, Z points at the reader.
        let around = (-direction.z).atan2(direction.x).to_degrees().rem_euclid(360.0);
        let (row, across) = between(&self.horizontal, self.folded(around)).unwrap_or((0, 0.0));
        let Some((column, along)) = between(&self.vertical, vertical) else { return 0.0 };
        let at = |row: usize| {
            let row = row.min(self.horizontal.len() - 1) * self.vertical.len();
            let next = (column + 1).min(self.vertical.len() - 1);
            self.candela[row + column] * (1.0 - along) + self.candela[row + next] * along
        };
        at(row) * (1.0 - across) + at(row + 1) * across
    }

    /// A horizontal angle where the table has it, degrees.
    fn folded(&self, around: f64) -> f64 {
        let (first, last) = (self.horizontal[0], self.horizontal[self.horizontal.len() - 1]);
        if first > 0.0 {
            // Alike on both sides of the plane through 90° and 270°.
            let mirrored = (540.0 - around) % 360.0;
            return if (90.0..=270.0).contains(&around) { around } else { mirrored };
        }
        let half = if around > 180.0 { 360.0 - around } else { around };
        match last {
            x if x > 180.0 => around,
            x if x > 90.0 => half,
            x if x > 0.0 => half.min(180.0 - half),
            _ => 0.0,
        }
    }

    /// Luminous flux of the whole table, lm: exact for what is linear between its angles.
    pub fn flux(&self) -> f64 {
        let row = |row: usize| self.flux_per_radian(row);
        let [count, first] = [self.horizontal.len(), 0];
        if count == 1 {
            return 2.0 * PI * row(first);
        }
        let width = |k: usize| (self.horizontal[k + 1] - self.horizontal[k]).to_radians();
        let covered = (self.horizontal[count - 1] - self.horizontal[0]).to_radians();
        let sum = (0..count - 1).map(|k| width(k) * (row(k) + row(k + 1)) / 2.0).sum::<f64>();
        sum * 2.0 * PI / covered
    }

    /// ∫ I(θ) sin θ dθ along one C-plane, lm by radian of horizontal angle.
    fn flux_per_radian(&self, row: usize) -> f64 {
        let at =
            |k: usize| (self.vertical[k].to_radians(), self.candela[row * self.vertical.len() + k]);
        let strip = |k: usize| {
            let ((a, from), (b, to)) = (at(k), at(k + 1));
            // By parts: ∫ I sin θ = [-I cos θ] + I' [sin θ].
            from * a.cos() - to * b.cos() + (to - from) / (b - a) * (b.sin() - a.sin())
        };
        (0..self.vertical.len() - 1).map(strip).sum()
    }
}

/// Between which of some ascending angles another one is, and how far on the way; `None` outside of them.
fn between(angles: &[f64], angle: f64) -> Option<(usize, f64)> {
    let last = angles.len() - 1;
    // Angles computed from vectors are off by rounding.
    if angle < angles[0] - 1e-9 || angle > angles[last] + 1e-9 {
        return None;
    }
    let next = angles.partition_point(|&a| a <= angle);
    if next == 0 || next > last {
        return Some((if next == 0 { 0 } else { last }, 0.0));
    }
    let (low, high) = (angles[next - 1], angles[next]);
    Some((next - 1, (angle - low) / (high - low)))
}
