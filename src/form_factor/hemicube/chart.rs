//! Coordinates on patches in which their elements are squares of a grid.

use glam::{DVec2, DVec3};
use pulp::Simd;

use crate::mesh::Patch;

/// Less of a bend than this, of the coordinates' range, is rounding.
pub(super) const STRAIGHT: f64 = 1e-6;

/// Coordinates from 0 to 1 along the edges of a convex quadrilateral, or of the parallelogram that a
/// triangle is half of.
///
/// Halving opposite edges again and again draws the lines of the bilinear coordinates (s, t), with
/// u = s + g s t and v = t + h s t in the oblique coordinates (u, v) along two edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct BilinearChart<V> {
    /// Where the coordinates are zero, m.
    pub(super) origin: V,
    /// Gradients of u and v, 1 / m.
    pub(super) axes: [V; 2],
    /// g and h, from -1 to 0; both are zero for parallelograms.
    pub(super) bend: [f32; 2],
}

impl BilinearChart<DVec2> {
    /// A chart of a triangle or a quadrilateral; begins where two edges span the most.
    pub(super) fn new(outline: &[DVec2]) -> Self {
        let n = outline.len();
        let corner = |k: usize| outline[k % n];
        let edges = |k: usize| [corner(k + 1), corner(k + n - 1)].map(|end| end - corner(k));
        let span = |k: usize| edges(k)[0].perp_dot(edges(k)[1]);
        let start = (1..n).fold(0, |best, k| if span(k) > span(best) { k } else { best });
        let [a, b] = edges(start);
        let axes = [-b.perp(), a.perp()].map(|axis| axis / span(start));
        let mut chart = Self { origin: corner(start), axes, bend: [0.0; 2] };
        if n == 4 {
            let bend = chart.oblique(corner(start + 2)) - 1.0;
            if bend.abs().max_element() > STRAIGHT {
                chart.bend = bend.as_vec2().to_array();
            }
        }
        chart
    }

    /// A chart of the box around any polygon, along its first edge.
    pub(super) fn around(outline: &[DVec2]) -> Self {
        let along = (outline[1] - outline[0]).normalize_or_zero();
        let place = |p: &DVec2| DVec2::new(along.dot(*p), along.perp_dot(*p));
        let low = outline.iter().map(place).fold(DVec2::INFINITY, DVec2::min);
        let high = outline.iter().map(place).fold(DVec2::NEG_INFINITY, DVec2::max);
        let size = high - low;
        let origin = along * low.x + along.perp() * low.y;
        Self { origin, axes: [along / size.x, along.perp() / size.y], bend: [0.0; 2] }
    }

    /// The coordinates (s, t) of a position.
    pub(super) fn place(&self, position: DVec2) -> DVec2 {
        let DVec2 { x: u, y: v } = self.oblique(position);
        let [g, h] = self.bend.map(f64::from);
        let b = 1.0 + h * u - g * v;
        let t = 2.0 * v / (b + (b * b + 4.0 * g * v).max(0.0).sqrt());
        DVec2::new(u / (1.0 + g * t), t)
    }

    fn oblique(&self, position: DVec2) -> DVec2 {
        DVec2::from(self.axes.map(|axis| axis.dot(position - self.origin)))
    }

    /// The same in space, for a patch with this outline on its surface's plane.
    pub(super) fn in_space(&self, patch: &Patch, outline: &[DVec2]) -> BilinearChart<DVec3> {
        let flat = outline[1] - outline[0];
        let along = (patch.corners[1] - patch.corners[0]) / flat.length_squared();
        let across = patch.normal.cross(along);
        let lift = |p: DVec2| along * flat.dot(p) + across * flat.perp_dot(p);
        BilinearChart {
            origin: patch.corners[0] + lift(self.origin - outline[0]),
            axes: self.axes.map(lift),
            bend: self.bend,
        }
    }
}

/// The coordinates (s, t) of places in the oblique coordinates (u, v) of a chart with this bend.
#[inline(always)]
pub(super) fn straighten<S: Simd>(simd: S, [g, h]: [f32; 2], [u, v]: [S::f32s; 2]) -> [S::f32s; 2] {
    let [one, two, four, g, h] = [1.0, 2.0, 4.0, g, h].map(
        #[inline(always)]
        |x| simd.splat_f32s(x),
    );
    let gv = simd.mul_f32s(g, v);
    let b = simd.sub_f32s(simd.add_f32s(one, simd.mul_f32s(h, u)), gv);
    let square = simd.add_f32s(simd.mul_f32s(b, b), simd.mul_f32s(four, gv));
    let root = simd.sqrt_f32s(simd.max_f32s(square, simd.splat_f32s(0.0)));
    let t = simd.div_f32s(simd.mul_f32s(two, v), simd.add_f32s(b, root));
    let s = simd.div_f32s(u, simd.add_f32s(one, simd.mul_f32s(g, t)));
    [s, t]
}

#[cfg(test)]
mod tests {
    use pulp::Scalar;

    use super::*;

    #[test]
    fn halves_of_opposite_edges_are_halves_of_coordinates() {
        let outlines = [
            [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]],
            [[0.0, 0.0], [3.0, 0.5], [2.0, 2.5], [0.5, 1.0]],
            // With a corner on the straight line between its neighbours.
            [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 2.0]],
        ];
        for outline in outlines.map(|corners| corners.map(DVec2::from)) {
            let chart = BilinearChart::new(&outline);
            let corners = outline.map(|corner| chart.place(corner));
            let along = |outline: [DVec2; 4], s: f64, t: f64| {
                outline[0].lerp(outline[1], s).lerp(outline[3].lerp(outline[2], s), t)
            };
            for (s, t) in [(0.5, 0.25), (0.125, 0.875), (0.75, 0.5)] {
                let position = along(outline, s, t);
                let place = chart.place(position);
                let expected = along(corners, s, t);
                assert!(place.distance(expected) < 1e-6, "{place} for {expected}");
                let oblique = chart.oblique(position).as_vec2().to_array();
                let [s, t] = straighten(Scalar::new(), chart.bend, oblique);
                let place = DVec2::new(s.into(), t.into());
                assert!(place.distance(expected) < 1e-5, "{place} for {expected}");
            }
        }
    }
}
