//! What is known of light on one element, and how far interpolation is from it.

use smallvec::SmallVec;

use crate::colour::{Rgb, strength};
use crate::mesh::{ElementId, Mesh, Middle, VertexId};

/// One kind of light on an element, as radiosities, W/m².
#[derive(Clone, Debug)]
pub struct Sample<'m> {
    pub(super) mesh: &'m Mesh,
    pub(super) element: ElementId,
    /// At the corners.
    pub(super) corners: SmallVec<[Rgb; 4]>,
}

/// Errors of interpolation across an element, W/m².
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Errors {
    /// Largest at the midpoints of edges 0 and 2, then of edges 1 and 3 and all others.
    pub(super) edges: [f64; 2],
    /// At the centre, from all corners.
    centre: f64,
    /// At the centre, from the midpoints of edges 0 and 2, and from those of edges 1 and 3.
    pub(super) across: [f64; 2],
}

impl<'m> Sample<'m> {
    /// What `light` says of the corners of an element.
    pub fn new(mesh: &'m Mesh, element: ElementId, light: impl Fn(VertexId) -> Rgb) -> Self {
        let corners = mesh[element].corners.iter().map(|&v| light(v)).collect();
        Self { mesh, element, corners }
    }

    /// How far what `light` says of the middle of the element is from what its corners let expect.
    pub(super) fn errors(&self, middle: &Middle, light: impl Fn(VertexId) -> Rgb) -> Errors {
        Errors::new(&self.corners, middle, light)
    }

    /// Difference of the brightest and the darkest corner, channel by channel, W/m².
    pub(super) fn range(&self) -> Rgb {
        let low = self.corners.iter().copied().fold(Rgb::INFINITY, Rgb::min);
        let high = self.corners.iter().copied().fold(Rgb::NEG_INFINITY, Rgb::max);
        high - low
    }
}

impl Errors {
    fn new(corners: &[Rgb], middle: &Middle, light: impl Fn(VertexId) -> Rgb) -> Self {
        let n = corners.len();
        let edges: SmallVec<[Rgb; 8]> = middle.edges.iter().map(|&v| light(v)).collect();
        let centre = light(middle.centre);
        let mut errors = Self {
            centre: strength(centre - corners.iter().sum::<Rgb>() / n as f64),
            ..Self::default()
        };
        for k in 0..n {
            let error = strength(edges[k] - (corners[k] + corners[(k + 1) % n]) * 0.5);
            let pair = usize::from(n != 4 || k % 2 == 1);
            errors.edges[pair] = errors.edges[pair].max(error);
        }
        if n == 4 {
            errors.across = [0, 1].map(|k| strength(centre - (edges[k] + edges[k + 2]) * 0.5));
        }
        errors
    }

    pub(super) fn largest(&self) -> f64 {
        self.edges[0].max(self.edges[1]).max(self.centre)
    }
}
