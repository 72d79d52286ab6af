//! Surfaces that lie in one place in part: of each two, one is cut where they do.

use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::coplanar::{Rank, are_level};
use super::merge::PlanarRegion;

use crate::geometry::polygon::{Ring, area, bounds};

/// What one polygon has in common with another is nothing if it is narrower than this many epsilons.
const NARROW: f64 = 10.0;

/// Cuts of each of these pairs the one that ranks lower, where both lie in one plane, face the same way and
/// overlap; tells how many were cut.
///
/// Where three overlap, the highest is what is left: what a region has lost, it has lost to a higher one,
/// which cuts the lower ones, too.
pub(super) fn cut(
    regions: &mut Vec<PlanarRegion>,
    pairs: &[[usize; 2]],
    ranks: &[Rank],
    epsilon: f64,
) -> usize {
    // What is left of those that were cut.
    let mut pieces: Vec<Option<Vec<Vec<Ring>>>> = vec![None; regions.len()];
    let mut count = 0;
    for &[low, high] in pairs.iter().filter(|&&[low, high]| ranks[low] < ranks[high]) {
        let (own, other) = (&regions[low], &regions[high]);
        if !are_level(own, other, epsilon) {
            continue;
        }
        let before = pieces[low].clone().unwrap_or_else(|| vec![own.rings.clone()]);
        let other: Vec<Ring> = other.rings.iter().map(|ring| seen(own, other, ring)).collect();
        if let Some(after) = without(&before, &other, epsilon) {
            count += usize::from(pieces[low].replace(after).is_none());
        }
    }
    if count > 0 {
        split(regions, pieces);
    }
    count
}

/// A ring of another region in the coordinates of this one.
fn seen(own: &PlanarRegion, other: &PlanarRegion, ring: &Ring) -> Ring {
    ring.iter().map(|&p| own.plane.flatten(other.plane.lift(p))).collect()
}

/// Polygons with holes, without what they have in common with another; `None` if that is nothing.
fn without(shapes: &[Vec<Ring>], other: &[Ring], epsilon: f64) -> Option<Vec<Vec<Ring>>> {
    let [low, high] = bounds(shapes.iter().flatten().flatten());
    let [other_low, other_high] = bounds(other.iter().flatten());
    let common = high.min(other_high) - low.max(other_low);
    if common.min_element() <= epsilon {
        return None;
    }
    let shapes: Vec<Vec<Vec<[f64; 2]>>> = shapes.iter().map(|shape| plain(shape)).collect();
    let other = plain(other);
    let shared =
        rings_of(shapes.overlay_as::<i64>(&other, OverlayRule::Intersect, FillRule::EvenOdd));
    let is_wide = |shape: &Vec<Ring>| {
        let length: f64 =
            shape.iter().flatten().map(|p| p.distance(shape[0][0])).fold(0.0, f64::max);
        size(shape) > NARROW * epsilon * length
    };
    if !shared.iter().any(is_wide) {
        return None;
    }
    let rest = shapes.overlay_as::<i64>(&other, OverlayRule::Difference, FillRule::EvenOdd);
    Some(rings_of(rest).into_iter().filter(is_wide).collect())
}

fn size(shape: &[Ring]) -> f64 {
    shape.iter().map(|ring| area(ring)).sum()
}

pub(super) fn plain(rings: &[Ring]) -> Vec<Vec<[f64; 2]>> {
    rings.iter().map(|ring| ring.iter().map(DVec2::to_array).collect()).collect()
}

pub(super) fn rings_of(shapes: Vec<Vec<Vec<[f64; 2]>>>) -> Vec<Vec<Ring>> {
    let ring = |ring: Vec<[f64; 2]>| ring.into_iter().map(DVec2::from).collect();
    shapes.into_iter().map(|shape| shape.into_iter().map(ring).collect()).collect()
}

/// Gives the regions what is left of them, each piece a region of its own.
fn split(regions: &mut Vec<PlanarRegion>, pieces: Vec<Option<Vec<Vec<Ring>>>>) {
    let old = std::mem::take(regions);
    for (region, pieces) in old.into_iter().zip(pieces) {
        let Some(pieces) = pieces else {
            regions.push(region);
            continue;
        };
        for rings in pieces {
            let PlanarRegion { plane, ref faces, attributes, .. } = region;
            // Those of its old corners are not those of its new ones.
            let normals = Vec::new();
            regions.push(PlanarRegion { plane, faces: faces.clone(), rings, attributes, normals });
        }
    }
}
