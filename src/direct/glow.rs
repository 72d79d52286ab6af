//! Emitters of surfaces that glow by a picture.

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use crate::colour::Rgb;
use crate::geometry::polygon::{Convex, Line, bounds};
use crate::mesh::Patch;
use crate::surface::{Surface, Surfaces, mean_texture};

/// Halves of a piece whose emissions differ by more than this share of the brightest become pieces.
const ALIKE: f64 = 0.05;

/// How often a patch is halved at most.
const HALVINGS: u32 = 5;

/// A convex part of a surface, m, and its mean exitance, W/m².
pub(super) type GlowingPiece = (SmallVec<[DVec3; 8]>, Rgb);

/// The pieces of a patch: halved along the picture's axes where it varies.
pub(super) fn pieces(surfaces: &Surfaces, patch: &Patch) -> Vec<GlowingPiece> {
    let surface = &surfaces[patch.surface];
    let outline: Convex = patch.corners.iter().map(|&p| surface.plane.flatten(p)).collect();
    let mean = mean_texture(surfaces, surface, &outline)[1];
    let (mut open, mut pieces) = (vec![(outline, mean, 0)], Vec::new());
    while let Some((outline, mean, depth)) = open.pop() {
        let halves = if depth < HALVINGS { halves(surfaces, surface, &outline) } else { None };
        match halves {
            Some(halves) => open.extend(halves.map(|(half, mean)| (half, mean, depth + 1))),
            None => {
                let corners = outline.iter().map(|&p| surface.plane.lift(p)).collect();
                pieces.push((corners, surface.exitance * mean));
            }
        }
    }
    pieces
}

/// The halves that differ most, of those along either axis of the picture, if they do.
fn halves(surfaces: &Surfaces, surface: &Surface, outline: &Convex) -> Option<[(Convex, Rgb); 2]> {
    let uv = surface.uv.filter(|uv| uv.matrix2.determinant() != 0.0)?;
    let on_picture: Convex = outline.iter().map(|&p| uv.transform_point2(p)).collect();
    let [low, high] = bounds(&on_picture);
    let middle = low.midpoint(high);
    let along = |axis: DVec2| {
        let ends = [middle, middle + axis].map(|p| uv.inverse().transform_point2(p));
        let [left, right] = Line::through(ends).split(outline, surfaces.epsilon);
        let half = |half: Convex| {
            let mean = mean_texture(surfaces, surface, &half)[1];
            (half, mean)
        };
        let halves = [half(left?), half(right?)];
        let difference = (halves[0].1 - halves[1].1).abs().max_element();
        Some((difference, halves))
    };
    let both = [DVec2::X, DVec2::Y].into_iter().filter_map(along);
    let (difference, halves) = both.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    (difference > ALIKE).then_some(halves)
}
