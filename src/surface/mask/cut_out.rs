//! A region whose picture has holes, and what is left of it.

use glam::{DAffine2, DMat2, DVec2};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::simplify::{Limits, simplified};
use super::trace::{Lattice, Opaque, outline};
use crate::geometry::polygon::{Ring, area, bounds};
use crate::scene::{Material, Scene, Texture};
use crate::surface::merge::PlanarRegion;
use crate::surface::partial_overlap::{plain, rings_of};

/// Outlines are true to no less and no more than these shares of a face, or of a picture that is repeated on it.
const DETAIL_OF_FACE: [f64; 2] = [1.0 / 128.0, 1.0 / 32.0];

/// Faces with less area than this are nothing, in epsilons times their length.
const NARROW: f64 = 10.0;

/// A region whose picture has holes.
pub(super) struct CutOut<'a> {
    /// Index into the regions.
    pub(super) region: usize,
    /// Of the picture.
    number: u32,
    texture: &'a Texture,
    cutoff: f64,
    /// From plane coordinates to texels; `None` if the picture has no place on it.
    pub(super) texels: Option<DAffine2>,
    /// Of the region, m².
    pub(super) area: f64,
}

/// What outlines depend on: the picture and the bits of the cutoff, the bits of the detail and the most corners, and
/// where the picture is looked at.
pub(super) type Key = ([u64; 2], (u64, usize), Lattice);

/// What is left of a region.
pub(super) enum Left {
    All,
    Nothing,
    Pieces(Vec<Vec<Ring>>),
}

impl<'a> CutOut<'a> {
    pub(super) fn new(scene: &'a Scene, regions: &[PlanarRegion], region: usize) -> Option<Self> {
        let face = &scene.faces[regions[region].faces[0]];
        let Material { texture, cutoff, .. } = &scene[face.material];
        let (number, cutoff) = ((*texture)?, (*cutoff)?);
        let texture = &scene.textures[number as usize];
        if texture.alpha.is_empty() {
            return None;
        }
        let counts = DVec2::new(f64::from(texture.width), f64::from(texture.height));
        let texels = regions[region].attributes.uv.map(|uv| scaled(uv, counts)).filter(|texels| {
            let [first, second] = [texels.matrix2.x_axis, texels.matrix2.y_axis];
            // Texels much longer than wide come of a picture that is drawn out of a line of it.
            texels.inverse().is_finite()
                && first.perp_dot(second).abs() > 1e-6 * first.length().max(second.length()).powi(2)
        });
        let area = size(&regions[region].rings);
        Some(Self { region, number, texture, cutoff, texels, area })
    }

    /// What the outlines on the region depend on.
    pub(super) fn key(&self, regions: &[PlanarRegion], corners: usize, detail: f64) -> Option<Key> {
        let texels = self.texels?;
        let rings = &regions[self.region].rings;
        let places: Vec<DVec2> =
            rings.iter().flatten().map(|&p| texels.transform_point2(p)).collect();
        let [low, high] = bounds(&places);
        let period = f64::from(self.texture.width.max(self.texture.height));
        let [least, most] =
            DETAIL_OF_FACE.map(|share| share * (high - low).max_element().min(period));
        let detail = (detail * texels.matrix2.determinant().abs().sqrt()).clamp(least, most);
        // Rounded, so that faces laid out alike share their outline wherever they are.
        let detail = ((8.0 * detail.log2()).round() / 8.0).exp2();
        let lattice = Lattice::over([low, high], detail, self.texture);
        let picture = [u64::from(self.number), self.cutoff.to_bits()];
        (detail > 0.0).then_some((picture, (detail.to_bits(), corners), lattice))
    }

    pub(super) fn outline(&self, (_, (detail, corners), lattice): Key) -> Opaque {
        let limits = Limits { area: f64::from_bits(detail).powi(2), corners };
        match outline(self.texture, self.cutoff, lattice) {
            Opaque::Whole => Opaque::Whole,
            Opaque::Within(rings) => Opaque::Within(simplified(&rings, limits)),
        }
    }

    /// What is left of its region.
    pub(super) fn left(
        &self,
        region: &PlanarRegion,
        opaque: Option<&Opaque>,
        epsilon: f64,
    ) -> Left {
        match (opaque, self.texels) {
            (Some(Opaque::Whole), _) => Left::All,
            (Some(Opaque::Within(rings)), Some(texels)) => {
                let pieces = common(&region.rings, rings, texels);
                let pieces: Vec<Vec<Ring>> =
                    pieces.into_iter().filter(|piece| is_wide(piece, epsilon)).collect();
                if pieces.is_empty() { Left::Nothing } else { Left::Pieces(pieces) }
            }
            // Without a place for the picture, what most of it is.
            _ if self.coverage() >= 0.5 => Left::All,
            _ => Left::Nothing,
        }
    }

    /// Share of the picture that is there.
    fn coverage(&self) -> f64 {
        let alphas = self.texture.alpha.iter();
        let there = alphas.filter(|&&alpha| f64::from(alpha) / 255.0 >= self.cutoff).count();
        there as f64 / self.texture.alpha.len() as f64
    }
}

fn scaled(uv: DAffine2, counts: DVec2) -> DAffine2 {
    DAffine2::from_mat2(DMat2::from_diagonal(counts)) * uv
}

/// What rings on a plane have in common with rings in texels, on the plane: outlines with holes.
fn common(own: &[Ring], opaque: &[Ring], texels: DAffine2) -> Vec<Vec<Ring>> {
    let is_mirrored = texels.matrix2.determinant() < 0.0;
    let laid = |ring: &Ring, map: DAffine2| -> Ring {
        let mut laid: Ring = ring.iter().map(|&p| map.transform_point2(p)).collect();
        if is_mirrored {
            laid.reverse();
        }
        laid
    };
    let on_texels: Vec<Ring> = own.iter().map(|ring| laid(ring, texels)).collect();
    // Rings that overlap once they have fewer corners cover no less for that.
    let (own, opaque) = (plain(&on_texels), plain(opaque));
    let shared = own.overlay_as::<i64>(&opaque, OverlayRule::Intersect, FillRule::Positive);
    let back = texels.inverse();
    let piece = |piece: Vec<Ring>| piece.iter().map(|ring| laid(ring, back)).collect();
    rings_of(shared).into_iter().map(piece).collect()
}

/// Whether a piece is wide enough to be one.
fn is_wide(piece: &[Ring], epsilon: f64) -> bool {
    let [low, high] = bounds(piece.iter().flatten());
    size(piece) > NARROW * epsilon * low.distance(high)
}

pub(super) fn size(piece: &[Ring]) -> f64 {
    piece.iter().map(|ring| area(ring)).sum()
}
