//! A part of an atlas: surfaces, projected on one plane.

use glam::{DVec2, DVec3, UVec2, Vec2Swizzles};

use super::coarse::TriangulatedSurface;
use crate::geometry::Plane;
use crate::geometry::polygon::bounds;
use crate::surface::Surfaces;

/// Texels around a chart that repeat its border, at least. As the rectangles of charts begin and end at
/// multiples of [`BLOCK`], bilinear lookups in the map and in its first two mip levels stay in them.
pub const PADDING: u32 = 2;

/// Rectangles of charts have sides of a multiple of this many texels.
pub const BLOCK: u32 = 4;

/// Edges along which a chart's rectangle may lie: the longest ones.
const DIRECTIONS: usize = 16;

/// Surfaces that lie side by side in an atlas without covering each other.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Indices into [`Surfaces::list`]: one flat surface, or facets of a curved one.
    pub surfaces: Vec<u32>,
    /// What they are projected on; the origin is a corner of the rectangle around them, m.
    plane: Plane,
    /// Sides of that rectangle, m.
    sides: DVec2,
    /// Its share of the texels to a metre, 0..=1: less than 1 beyond [`Surfaces::extent`].
    share: f64,
    /// The first texel of its rectangle in the atlas, from the left and the top.
    pub corner: UVec2,
    /// Texels of its rectangle, padding included.
    pub texels: UVec2,
    /// Texels to a metre.
    pub density: f64,
}

impl Chart {
    /// A chart of these surfaces, not yet in its place. Its plane is that of the first, its rectangle as
    /// small as can be.
    pub(super) fn new(
        surfaces: &Surfaces,
        triangulated: &[TriangulatedSurface],
        group: Vec<u32>,
    ) -> Self {
        let plane = surfaces.list[group[0] as usize].plane;
        let outline: Vec<[DVec3; 2]> =
            group.iter().flat_map(|&surface| triangulated[surface as usize].edges()).collect();
        let mut directions: Vec<DVec3> = outline.iter().map(|[a, b]| *b - *a).collect();
        directions.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
        directions.truncate(DIRECTIONS);
        directions.insert(0, plane.u);
        let framed = directions.into_iter().map(|direction| framed(&plane, direction, &outline));
        let area = |(_, sides): &(Plane, DVec2)| sides.x * sides.y;
        // The first of equals, so that rounding does not choose.
        let best =
            framed.reduce(
                |best, next| {
                    if area(&next) < area(&best) * (1.0 - 1e-9) { next } else { best }
                },
            );
        let (plane, sides) = best.unwrap_or((plane, DVec2::ZERO));
        Self {
            surfaces: group,
            plane,
            sides,
            share: (surfaces.extent / sides.length().max(f64::MIN_POSITIVE)).min(1.0),
            corner: UVec2::ZERO,
            texels: UVec2::ZERO,
            density: 0.0,
        }
    }

    /// Area of the rectangle, m², as far as it counts.
    pub(super) fn weight(&self) -> f64 {
        self.sides.x * self.sides.y * self.share * self.share
    }

    /// Blocks that the rectangle would take at so many texels to a metre.
    pub(super) fn blocks(&self, density: f64) -> UVec2 {
        let texels = (self.sides * density * self.share).ceil().max(DVec2::ONE);
        texels.as_uvec2().map(|side| side.saturating_add(2 * PADDING).div_ceil(BLOCK))
    }

    /// A quarter turn about its normal.
    pub(super) fn turn(&mut self) {
        let Plane { origin, u, v, normal } = self.plane;
        self.plane = Plane { origin: origin + u * self.sides.x, u: v, v: -u, normal };
        self.sides = self.sides.yx();
    }

    /// Gives the chart its place.
    pub(super) fn put(&mut self, corner: UVec2, density: f64) {
        self.corner = corner * BLOCK;
        self.texels = self.blocks(density) * BLOCK;
        self.density = density * self.share;
    }

    /// Where a place on its surfaces, m, is in the atlas, texels from the left and the top.
    pub fn texel(&self, place: DVec3) -> DVec2 {
        let margin = (self.texels.as_dvec2() - self.sides * self.density) / 2.0;
        self.corner.as_dvec2() + margin + self.plane.flatten(place) * self.density
    }
}

/// The plane with its first axis along `direction` and its origin at the corner of the rectangle around
/// an outline, and that rectangle's sides, m.
fn framed(plane: &Plane, direction: DVec3, outline: &[[DVec3; 2]]) -> (Plane, DVec2) {
    let plane = Plane::new(plane.origin, plane.normal, direction);
    // A surface can be too small to have an outline of places that differ.
    if outline.is_empty() {
        return (plane, DVec2::ZERO);
    }
    let places: Vec<DVec2> = outline.iter().map(|edge| plane.flatten(edge[0])).collect();
    let [low, high] = bounds(&places);
    (Plane { origin: plane.lift(low), ..plane }, high - low)
}
