//! Faces whose pictures have holes: what is there of them becomes their outline, so that light goes through the rest.

mod simplify;
mod trace;

mod cut_out;
mod pieces;

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::merge::PlanarRegion;
use super::model::EPSILON;
use crate::scene::{Scene, counted, note_count};
use cut_out::{CutOut, Key, Left, size};
use pieces::split;
use trace::Opaque;

/// Outlines are true to about this share of a scene.
const DETAIL_OF_SCENE: f64 = 1.0 / 2000.0;

/// Corners of all outlines of a scene together, about: half of them are shared out evenly, half by area, so that a
/// tree of 10 000 leaves has six for each, and a fence beside it hundreds.
const MOST_CORNERS: usize = 40_000;

/// Least and most corners of the outlines on a face, whatever their number.
const CORNERS_OF_ONE: [usize; 2] = [6, 4000];

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
