//! Faces whose pictures have holes: what is there of them becomes their outline, so that light goes through the rest.

mod simplify;
mod trace;

use std::collections::BTreeMap;

use glam::{DAffine2, DMat2, DVec2, DVec3};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use rayon::prelude::*;

use super::merge::PlanarRegion;
use super::model::EPSILON;
use super::partial_overlap::{plain, rings_of};
use super::tint::Widest;
use crate::geometry::polygon::{Ring, area, bounds};
use crate::scene::{Face, Material, Scene, Texture, counted, note_count};
use simplify::{Limits, simplified};
use trace::{Lattice, Opaque, outline};

/// Outlines are true to about this share of a scene,
const DETAIL_OF_SCENE: f64 = 1.0 / 2000.0;

/// but to no less and no more than these shares of a face, or of a picture that is repeated on it.
const DETAIL_OF_FACE: [f64; 2] = [1.0 / 128.0, 1.0 / 32.0];

/// Corners of all outlines of a scene together, about: half of them are shared out evenly, half by area, so that a
/// tree of 10 000 leaves has six for each, and a fence beside it hundreds.
const MOST_CORNERS: usize = 40_000;

/// Least and most corners of the outlines on a face, whatever their number.
const CORNERS_OF_ONE: [usize; 2] = [6, 4000];

/// Faces with less area than this are nothing, in epsilons times their length.
const NARROW: f64 = 10.0;

/// A region whose picture has holes.
struct CutOut<'a> {
    /// Index into the regions.
    region: usize,
    /// Of the picture.
    number: u32,
    texture: &'a Texture,
    cutoff: f64,
    /// From plane coordinates to texels; `None` if the picture has no place on it.
    texels: Option<DAffine2>,
    /// Of the region, m².
    area: f64,
}

/// What outlines depend on: the picture and the bits of the cutoff, the bits of the detail and the most corners, and
/// where the picture is looked at.
type Key = ([u64; 2], (u64, usize), Lattice);

/// Regions of cut-outs reduced to what is there of them; what was done is told in `notes`.
///
/// Outlines have few corners, since each is a corner of what light falls on and is held back by, but the area that the
/// picture covers. What is seen of them has the picture's holes besides.
pub(super) fn cut(
    scene: &Scene,
    regions: Vec<PlanarRegion>,
    notes: &mut Vec<String>,
) -> Vec<PlanarRegion> {
    let cut_outs: Vec<CutOut> =
        (0..regions.len()).filter_map(|region| CutOut::new(scene, &regions, region)).collect();
    if cut_outs.is_empty() {
        return regions;
    }
    let area: f64 = cut_outs.iter().map(|one| one.area).sum();
    let corners = |one: &CutOut| {
        let share = (1.0 / cut_outs.len() as f64 + one.area / area) / 2.0;
        let [least, most] = CORNERS_OF_ONE;
        ((share * MOST_CORNERS as f64).round() as usize).clamp(least, most)
    };
    let detail = DETAIL_OF_SCENE * scene.extent();
    let keys: Vec<Option<Key>> =
        cut_outs.iter().map(|one| one.key(&regions, corners(one), detail)).collect();
    let by_key: BTreeMap<Key, &CutOut> =
        keys.iter().zip(&cut_outs).filter_map(|(key, one)| Some(((*key)?, one))).collect();
    let outlined = |(key, one): (Key, &CutOut)| (key, one.outline(key));
    let outlines: BTreeMap<Key, Opaque> = by_key.into_par_iter().map(outlined).collect();
    let epsilon = EPSILON * scene.extent();
    let left = |(one, key): (&CutOut, &Option<Key>)| {
        one.left(&regions[one.region], key.map(|key| &outlines[&key]), epsilon)
    };
    let left: Vec<Left> = cut_outs.par_iter().zip(&keys).map(left).collect();
    tell(&cut_outs, &regions, &left, notes);
    let mut left: BTreeMap<usize, Left> = cut_outs.iter().map(|one| one.region).zip(left).collect();
    let pieces = |(number, region): (usize, PlanarRegion)| match left.remove(&number) {
        None | Some(Left::All) => vec![region],
        Some(Left::Nothing) => Vec::new(),
        Some(Left::Pieces(pieces)) => split(scene, &region, pieces),
    };
    regions.into_iter().enumerate().flat_map(pieces).collect()
}

/// What is left of a region.
enum Left {
    All,
    Nothing,
    Pieces(Vec<Vec<Ring>>),
}

impl<'a> CutOut<'a> {
    fn new(scene: &'a Scene, regions: &[PlanarRegion], region: usize) -> Option<Self> {
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
    fn key(&self, regions: &[PlanarRegion], corners: usize, detail: f64) -> Option<Key> {
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

    fn outline(&self, (_, (detail, corners), lattice): Key) -> Opaque {
        let limits = Limits { area: f64::from_bits(detail).powi(2), corners };
        match outline(self.texture, self.cutoff, lattice) {
            Opaque::Whole => Opaque::Whole,
            Opaque::Within(rings) => Opaque::Within(simplified(&rings, limits)),
        }
    }

    /// What is left of its region.
    fn left(&self, region: &PlanarRegion, opaque: Option<&Opaque>, epsilon: f64) -> Left {
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

fn size(piece: &[Ring]) -> f64 {
    piece.iter().map(|ring| area(ring)).sum()
}

/// The pieces of a region, each a region of its own.
fn split(scene: &Scene, region: &PlanarRegion, pieces: Vec<Vec<Ring>>) -> Vec<PlanarRegion> {
    let face = &scene.faces[region.faces[0]];
    let slopes = (!region.normals.is_empty()).then(|| Normals::of(scene, region, face)).flatten();
    let piece = |rings: Vec<Ring>| {
        let outer = rings.first().into_iter().flatten();
        let normals = slopes.as_ref().map(|slopes| outer.map(|&p| slopes.at(p)).collect());
        let &PlanarRegion { plane, attributes, .. } = region;
        let (faces, normals) = (region.faces.clone(), normals.unwrap_or_default());
        PlanarRegion { plane, faces, rings, attributes, normals }
    };
    pieces.into_iter().map(piece).collect()
}

/// How the normals at a face's corners go on between them.
struct Normals {
    place: DVec2,
    normal: DVec3,
    slopes: [DVec3; 2],
}

impl Normals {
    fn of(scene: &Scene, region: &PlanarRegion, face: &Face) -> Option<Self> {
        let places: Vec<DVec2> =
            face.corners(&scene.positions).into_iter().map(|p| region.plane.flatten(p)).collect();
        let widest = Widest::of(&places)?;
        let normal = *region.normals.get(widest.corner)?;
        let [next, last] =
            widest.neighbours(region.normals.len()).map(|k| region.normals[k] - normal);
        let slopes = [0, 1].map(|axis| {
            let share = widest.inverse.col(axis);
            next * share.x + last * share.y
        });
        Some(Self { place: places[widest.corner], normal, slopes })
    }

    fn at(&self, place: DVec2) -> DVec3 {
        let DVec2 { x, y } = place - self.place;
        (self.normal + self.slopes[0] * x + self.slopes[1] * y).normalize_or(self.normal)
    }
}

/// One line on what was cut, and one on what could not be.
fn tell(cut_outs: &[CutOut], regions: &[PlanarRegion], left: &[Left], notes: &mut Vec<String>) {
    let (mut faces, mut pieces, mut unplaced) = (0, 0, 0);
    let (mut covered, mut whole) = (0.0, 0.0);
    for (one, left) in cut_outs.iter().zip(left) {
        let region = &regions[one.region];
        if one.texels.is_none() {
            unplaced += region.faces.len();
            continue;
        }
        let own = one.area;
        whole += own;
        covered += match left {
            Left::All => own,
            Left::Nothing => 0.0,
            Left::Pieces(pieces) => pieces.iter().map(|piece| size(piece)).sum(),
        };
        faces += region.faces.len();
        pieces += match left {
            Left::All => 1,
            Left::Nothing => 0,
            Left::Pieces(pieces) => pieces.len(),
        };
    }
    if faces > 0 {
        let (faces, pieces) = (counted(faces, "face"), counted(pieces, "piece"));
        notes.push(format!(
            "cut-outs: {faces} cut along their masks into {pieces} (coverage {:.2})",
            covered / whole.max(f64::MIN_POSITIVE)
        ));
    }
    let rest = "whose cut-out has no place on them, left out if most of it is a hole";
    note_count(notes, unplaced, "face", rest);
}
