//! Colours of vertices, laid over a surface.

use glam::{DMat2, DVec2};
use serde::Serialize;

use crate::colour::Rgb;
use crate::scene::Face;

/// Tints that differ by less than this are one: half a step of colours of 8 bits.
const ALIKE: f64 = 0.5 / 255.0;

/// A factor on a surface's reflectance, linear over its plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tint {
    /// At the plane's origin.
    origin: Rgb,
    /// Change along either coordinate, 1/m.
    slopes: [Rgb; 2],
}

/// The corner of a polygon at which most area is spanned, by whose edges affine maps are known best.
#[derive(Clone, Copy, Debug)]
pub(super) struct Widest {
    pub(super) corner: usize,
    /// From the plane to shares of the edges to the next and to the last corner.
    pub(super) inverse: DMat2,
}

impl Widest {
    /// That of a polygon of at least three corners; `None` without any.
    pub(super) fn of(places: &[DVec2]) -> Option<Self> {
        let n = places.len();
        let frame = |k: usize| {
            let (next, last) = (places[(k + 1) % n], places[(k + n - 1) % n]);
            DMat2::from_cols(next - places[k], last - places[k])
        };
        let spread = |k: &usize| frame(*k).determinant().abs();
        let corner = (0..n).max_by(|a, b| spread(a).total_cmp(&spread(b)))?;
        Some(Self { corner, inverse: frame(corner).inverse() })
    }

    /// The next and the last of so many corners.
    pub(super) fn neighbours(&self, count: usize) -> [usize; 2] {
        [(self.corner + 1) % count, (self.corner + count - 1) % count]
    }
}

impl Tint {
    /// No tint.
    pub const ONE: Self = Self { origin: Rgb::ONE, slopes: [Rgb::ZERO; 2] };

    /// That of a face with corners at `places` of its plane; the mean where they are too close to tell a slope.
    pub(super) fn of(face: &Face, widest: Option<&Widest>, places: &[DVec2]) -> Self {
        let Some(first) = face.tints.first() else { return Self::ONE };
        let uniform = |tint: Rgb| Self { origin: tint, ..Self::ONE };
        if face.tints.iter().all(|tint| tint == first) {
            return uniform(first.as_dvec3());
        }
        let by_corners = |widest: &Widest| {
            let tint = |corner: usize| Some(face.tints.get(corner)?.as_dvec3());
            let at = tint(widest.corner)?;
            let [next, last] = widest.neighbours(face.tints.len()).map(tint);
            let ([next, last], [x, y]) =
                ([next? - at, last? - at], [0, 1].map(|k| widest.inverse.col(k)));
            let slopes = [x, y].map(|share| next * share.x + last * share.y);
            let place = places[widest.corner];
            let origin = at - slopes[0] * place.x - slopes[1] * place.y;
            (origin.is_finite() && slopes.iter().all(|s| s.is_finite()))
                .then_some(Self { origin, slopes })
        };
        widest.and_then(by_corners).unwrap_or_else(|| {
            let sum: Rgb = face.tints.iter().map(|tint| tint.as_dvec3()).sum();
            uniform(sum / face.tints.len() as f64)
        })
    }

    /// The factor at a place of the plane, 0..=1 per channel.
    pub fn at(&self, place: DVec2) -> Rgb {
        let tint = self.origin + self.slopes[0] * place.x + self.slopes[1] * place.y;
        tint.clamp(Rgb::ZERO, Rgb::ONE)
    }

    /// The same factor everywhere, if it is.
    pub fn uniform(&self) -> Option<Rgb> {
        (self.slopes == [Rgb::ZERO; 2]).then_some(self.origin)
    }

    /// Whether both are the same at a place, as far as can be seen.
    pub(super) fn is_like(&self, other: &Self, place: DVec2) -> bool {
        (self.at(place) - other.at(place)).abs().max_element() < ALIKE
    }

    /// The same with the coordinates exchanged.
    pub(super) fn reversed(&self) -> Self {
        let [x, y] = self.slopes;
        Self { slopes: [y, x], ..*self }
    }
}
