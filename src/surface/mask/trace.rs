//! The outline of what is there of a picture with holes.

use glam::DVec2;

use crate::geometry::polygon::Ring;
use crate::scene::Texture;

/// Most opacities that are looked at between texels, so that outlines of few texels are round.
const FINE: f64 = 16_384.0;

/// Most opacities that are looked at of one face; of more texels, each second or fourth, and so on.
const MOST: f64 = 2_097_152.0;

/// Places at which opacities are looked at: middles of texels, and as many between them or as few of them as told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Lattice {
    /// Of its first place, in steps from the middle of the first texel.
    first: [i64; 2],
    /// Places along each axis.
    count: [usize; 2],
    /// Texels of a step, as a power of two.
    step: i32,
}

impl Lattice {
    /// That over a box and, beyond it, a `margin`, all in texels.
    pub(super) fn over([low, high]: [DVec2; 2], margin: f64, texture: &Texture) -> Self {
        let finest = if texture.sampler.nearest { 0 } else { -4 };
        let at = |step: i32| {
            let texels = f64::from(step).exp2();
            let beyond = 2.0 + (margin / texels).ceil();
            let first = ((low - 0.5) / texels).floor() - beyond;
            let count = ((high - 0.5) / texels).ceil() + beyond - first + 1.0;
            (first, count, step)
        };
        let fits = |&(_, count, step): &(DVec2, DVec2, i32)| {
            count.element_product() <= if step < 0 { FINE } else { MOST }
        };
        let (first, count, step) = (finest..).map(at).find(fits).unwrap_or_else(|| at(finest));
        let first = first.to_array().map(|first| first as i64);
        Self { first, count: count.to_array().map(|count| count as usize), step }
    }

    /// The place of this number, in texels from the picture's top left.
    fn place(&self, number: usize) -> DVec2 {
        let along = [number % self.count[0], number / self.count[0]];
        let steps = [0, 1].map(|axis| (self.first[axis] + along[axis] as i64) as f64);
        DVec2::from(steps) * f64::from(self.step).exp2() + 0.5
    }

    /// By how much the opacity at each place is above a cutoff. Places on its border are holes, so that outlines close.
    fn heights(&self, texture: &Texture, cutoff: f64) -> Vec<f64> {
        let [width, height] = self.count;
        let height_at = |number: usize| {
            let (column, row) = (number % width, number / width);
            let is_inner = (1..width - 1).contains(&column) && (1..height - 1).contains(&row);
            if is_inner { texture.opacity_at(self.place(number)) - cutoff } else { -1.0 }
        };
        (0..width * height).map(height_at).collect()
    }
}

/// What of a picture is there.
#[derive(Clone, Debug)]
pub(super) enum Opaque {
    /// All of it.
    Whole,
    /// What is inside these rings: counter-clockwise where x points right and y up, holes clockwise.
    Within(Vec<Ring>),
}

/// The outline of what has at least the opacity `cutoff`, in texels, by marching squares ([Maple 2003]): exact to within a
/// step of the lattice, along the borders of texels that are not mixed.
///
/// [Maple 2003]: https://doi.org/10.1109/GMAG.2003.1219671
pub(super) fn outline(texture: &Texture, cutoff: f64, lattice: Lattice) -> Opaque {
    let tracer = ContourTracer {
        heights: lattice.heights(texture, cutoff),
        lattice,
        is_stepped: texture.sampler.nearest,
    };
    let [width, height] = lattice.count;
    let borders = 2 * (width + height) - 4;
    let inner = width * height - borders;
    if tracer.heights.iter().filter(|&&height| height >= 0.0).count() == inner {
        return Opaque::Whole;
    }
    Opaque::Within(tracer.rings())
}

struct ContourTracer {
    lattice: Lattice,
    heights: Vec<f64>,
    /// Whether opacity is the same all over a texel.
    is_stepped: bool,
}

/// No edge of the lattice.
const NONE: u32 = u32::MAX;

impl ContourTracer {
    fn rings(&self) -> Vec<Ring> {
        let mut next = self.crossed_cells();
        let mut rings = Vec::new();
        for start in 0..next.len() {
            let mut ring = Ring::new();
            let mut edge = start;
            while next[edge] != NONE {
                let following = std::mem::replace(&mut next[edge], NONE) as usize;
                self.step(edge, following, &mut ring);
                edge = following;
            }
            if ring.len() > 2 {
                rings.push(ring);
            }
        }
        rings
    }

    /// By edge of the lattice across which the outline enters a cell, that across which it leaves. Edge 2 k runs from
    /// place k to the next, 2 k + 1 to that in the next row.
    fn crossed_cells(&self) -> Vec<u32> {
        let [width, height] = self.lattice.count;
        let mut next = vec![NONE; 2 * width * height];
        for low in (0..height - 1).flat_map(|row| row * width..(row + 1) * width - 1) {
            let corners = [low, low + 1, low + width + 1, low + width];
            let edges = [2 * low, 2 * low + 3, 2 * (low + width), 2 * low + 1];
            let inside = corners.map(|corner| self.heights[corner] >= 0.0);
            // Round the cell, what is there ends at some edges and begins at others.
            let changes =
                |k: &usize, ends: bool| inside[*k] == ends && inside[(*k + 1) % 4] != ends;
            for end in (0..4).filter(|k| changes(k, true)) {
                // At a saddle, what lies in two corners hangs together or does not.
                let turn = if self.is_joined(corners) { 1 } else { 3 };
                let around = (1..4).map(|k| (end + turn * k) % 4);
                let begin = around.into_iter().find(|k| changes(k, false));
                next[edges[end]] = begin.map_or(NONE, |begin| edges[begin] as u32);
            }
        }
        next
    }

    /// Whether opacity in the middle of a saddle is above the cutoff.
    fn is_joined(&self, corners: [usize; 4]) -> bool {
        let [a, b, c, d] = corners.map(|corner| self.heights[corner]);
        let sum = a + c - b - d;
        // The height where it is level: the sign tells.
        (a * c - b * d) * sum > 0.0
    }

    /// Where the outline crosses an edge.
    fn crossing(&self, edge: usize) -> DVec2 {
        let from = edge / 2;
        let to = if edge.is_multiple_of(2) { from + 1 } else { from + self.lattice.count[0] };
        let [low, high] = [from, to].map(|place| self.heights[place]);
        let share = if self.is_stepped { 0.5 } else { low / (low - high) };
        self.lattice.place(from).lerp(self.lattice.place(to), share)
    }

    /// Adds the corners of an outline that crosses a cell from one edge to another.
    fn step(&self, from: usize, to: usize, ring: &mut Ring) {
        let [start, end] = [from, to].map(|edge| self.crossing(edge));
        if ring.last() != Some(&start) {
            ring.push(start);
        }
        // Between texels that are not mixed, it turns in the middle.
        match (self.is_stepped, from % 2, to % 2) {
            (true, 0, 1) => ring.push(DVec2::new(start.x, end.y)),
            (true, 1, 0) => ring.push(DVec2::new(end.x, start.y)),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::area;
    use crate::scene::{Sampler, Wrap};

    fn traced(alpha: &[u8], width: u32, nearest: bool) -> (f64, Vec<Ring>) {
        let height = alpha.len() as u32 / width;
        let texture = Texture {
            width,
            height,
            texels: vec![[1.0; 3]; alpha.len()].into(),
            alpha: alpha.to_vec(),
            sampler: Sampler { wrap: [Wrap::Clamp; 2], nearest },
            ..Texture::default()
        };
        let size = DVec2::new(f64::from(width), f64::from(height));
        let lattice = Lattice::over([DVec2::ZERO, size], 0.0, &texture);
        let rings = match outline(&texture, 0.5, lattice) {
            Opaque::Whole => Vec::new(),
            Opaque::Within(rings) => rings,
        };
        (rings.iter().map(|ring| area(ring)).sum(), rings)
    }

    #[test]
    fn texels_that_are_not_mixed_are_squares() {
        let ring = [
            0, 0, 0, 0, 0, 0, 255, 255, 255, 0, 0, 255, 0, 255, 0, 0, 255, 255, 255, 0, 0, 0, 0, 0,
            0,
        ];
        let (area, rings) = traced(&ring, 5, true);
        assert_eq!((area, rings.len()), (8.0, 2));
    }

    #[test]
    fn mixed_texels_end_where_their_mixture_is_the_cutoff() {
        // (1 − |x|) (1 − |y|) ≥ 1/2 around a texel.
        let (area, rings) = traced(&[0, 0, 0, 0, 255, 0, 0, 0, 0], 3, false);
        let exact = 4.0 * (0.5 - 0.5 * std::f64::consts::LN_2);
        assert_eq!(rings.len(), 1);
        assert!((area / exact - 1.0).abs() < 0.01, "{area} of {exact}");
    }

    #[test]
    fn what_meets_in_a_corner_hangs_together_or_not_but_closes() {
        for nearest in [false, true] {
            let squares = [0, 0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0, 0, 0, 0];
            let (area, rings) = traced(&squares, 4, nearest);
            assert!(area > 1.0 && area < 2.1 && rings.len() <= 2, "{area} {rings:?}");
        }
    }

    #[test]
    fn what_has_no_holes_has_no_outline() {
        assert!(traced(&[255; 6], 3, false).1.is_empty());
        assert_eq!(traced(&[0; 6], 3, true), (0.0, Vec::new()));
    }
}
