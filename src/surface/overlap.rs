//! Surfaces that lie in one place: a picture in the plane of its wall, a lamp in that of its ceiling.

use glam::DVec3;
use rayon::prelude::*;

use super::TOLERANCE;
use super::contact::inside;
use super::merge::Region;
use super::partly;
use super::polygon::{Ring, area, centroid, contains, edges};
use crate::colour::luminance;
use crate::scene::boxes::{self, Bounds, Tree, are_close};
use crate::scene::{Scene, note_count};

/// Regions of which none covers another: what lies in the plane of a larger one and faces the same way is cut
/// out of it; what reaches beyond it cuts it or is cut, as the one that glows, or else the smaller one, is left
/// whole. What was done is told in `notes`.
///
/// Without this, light would fall on both.
pub(super) fn without_overlaps(
    scene: &Scene,
    mut regions: Vec<Region>,
    notes: &mut Vec<String>,
) -> Vec<Region> {
    let tolerance = TOLERANCE * scene.extent();
    let ranks: Vec<Rank> =
        (0..regions.len()).into_par_iter().map(|k| Rank::new(scene, &regions, k)).collect();
    let mut within: Vec<Vec<usize>> = vec![Vec::new(); regions.len()];
    let mut beside = Vec::new();
    let pairs = level_pairs(&regions, tolerance);
    let covered = |&pair: &[usize; 2]| is_covered(&regions, pair, &ranks, tolerance);
    let covered: Vec<bool> = pairs.par_iter().map(covered).collect();
    for ([large, small], is_covered) in pairs.into_iter().zip(covered) {
        if is_covered {
            within[large].push(small);
        } else {
            beside.push((large, small));
        }
    }
    let mut inner: Vec<usize> = within.iter().flatten().copied().collect();
    inner.sort_unstable();
    inner.dedup();
    // What lies in one of these lies in all that it lies in: those without are cut first, and then are
    // what is to be seen of them.
    let mut order: Vec<usize> = (0..regions.len()).filter(|&k| !within[k].is_empty()).collect();
    order.sort_by_key(|&large| within[large].len());
    for large in order {
        let seen = within[large].iter().flat_map(|&small| seen_from(&regions, [large, small]));
        let seen: Vec<Ring> = seen.collect();
        regions[large].rings.extend(seen);
    }
    let cut = partly::cut(&mut regions, &beside, &ranks, tolerance);
    note_count(notes, inner.len(), "surface", "cut out of larger ones in whose planes they lie");
    note_count(notes, cut, "surface", "cut where another lies in its plane");
    regions
}

/// Ordered pairs of regions of which the second lies in the plane of the first, faces the same way and may touch it.
fn level_pairs(regions: &[Region], tolerance: f64) -> Vec<[usize; 2]> {
    let tree = Tree::new(regions.par_iter().map(bounds).collect());
    let of = |found: &mut Vec<u32>, outer: usize| {
        let plane = &regions[outer].plane;
        let meets = |(low, high): Bounds| {
            let around = (high - low).dot(plane.normal.abs()) / 2.0;
            are_close(tree.boxes()[outer], (low, high), tolerance)
                && plane.height(low.midpoint(high)).abs() <= around + 2.0 * tolerance
        };
        tree.find(meets, found);
        let others = found.iter().map(|&inner| inner as usize).filter(|&inner| inner != outer);
        let level = others.filter(|&k| are_level(&regions[outer], &regions[k], tolerance));
        level.map(|inner| [outer, inner]).collect::<Vec<_>>()
    };
    (0..regions.len()).into_par_iter().map_init(Vec::new, of).flatten_iter().collect()
}

/// Which of two regions in one place is meant: the greater.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct Rank {
    /// What glows is meant.
    glow: f64,
    /// Else what is smaller; m², negative.
    smallness: f64,
    /// Else what the file has first.
    place: std::cmp::Reverse<usize>,
}

impl Rank {
    fn new(scene: &Scene, regions: &[Region], place: usize) -> Self {
        let region = &regions[place];
        let face = &scene.faces[region.faces[0]];
        let glow = luminance(scene.materials[face.material as usize].emission);
        // To six digits, so that rounding does not decide.
        let size = size(region);
        let unit = 10f64.powf(size.max(f64::MIN_POSITIVE).log10().floor() - 6.0);
        let smallness = -(size / unit).round() * unit;
        Self { glow, smallness, place: std::cmp::Reverse(place) }
    }
}

fn size(region: &Region) -> f64 {
    region.rings.iter().map(|ring| area(ring)).sum()
}

fn bounds(region: &Region) -> Bounds {
    boxes::around(region.rings.iter().flatten().map(|&p| region.plane.lift(p)))
}

/// The rings of the second region as holes in the first.
fn seen_from(regions: &[Region], [large, small]: [usize; 2]) -> Vec<Ring> {
    let (outer, inner) = (&regions[large], &regions[small]);
    let flat = |&p| outer.plane.flatten(inner.plane.lift(p));
    inner.rings.iter().map(|ring| ring.iter().rev().map(flat).collect()).collect()
}

/// True if two regions lie in one plane and face the same way.
pub(super) fn are_level(outer: &Region, inner: &Region, tolerance: f64) -> bool {
    let level = |p: DVec3| outer.plane.height(p).abs() <= tolerance;
    let mut corners = inner.rings.iter().flatten().map(|&p| inner.plane.lift(p));
    inner.plane.normal.dot(outer.plane.normal) > 0.999 && corners.all(level)
}

/// True if the second of two regions in one plane lies in the first and is to be seen in its stead.
fn is_covered(
    regions: &[Region],
    [large, small]: [usize; 2],
    ranks: &[Rank],
    tolerance: f64,
) -> bool {
    let (outer, inner) = (&regions[large], &regions[small]);
    let sizes = [size(outer), size(inner)];
    let alike = (sizes[0] - sizes[1]).abs() <= 1e-6 * sizes[0];
    // Of two in one place, the one that glows is meant, or else the one that the file has first.
    let order = |k: usize| (ranks[k].glow, ranks[k].place);
    let is_meant = alike && order(large) >= order(small);
    (alike || sizes[0] > sizes[1])
        && !is_meant
        && is_within(&seen_from(regions, [large, small]), &outer.rings, tolerance)
}

/// True if what is inside `rings` is inside `others`, borders touching or not.
fn is_within(rings: &[Ring], others: &[Ring], tolerance: f64) -> bool {
    let outside = |segment| inside(rings, segment, tolerance).is_empty();
    let crossed = others.iter().flat_map(|ring| edges(ring)).any(|edge| !outside(edge));
    // No border of the others runs through it, so one place speaks for all, but may lie in a hole of its own.
    let middle = rings.first().map(inner_point);
    !crossed && middle.is_some_and(|middle| contains(rings, middle) && contains(others, middle))
}

/// A point inside a ring: its centroid, or, if that is outside, the centroid of one of its ears.
fn inner_point(ring: &Ring) -> glam::DVec2 {
    let centre = centroid(ring);
    let alone = std::slice::from_ref(ring);
    let n = ring.len();
    let ears = (0..n).map(|k| centroid(&[ring[k], ring[(k + 1) % n], ring[(k + 2) % n]]));
    std::iter::once(centre).chain(ears).find(|&p| contains(alone, p)).unwrap_or(centre)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Face, Material};
    use crate::surface::surfaces_of;

    const SQUARES: [[f64; 3]; 8] = [
        [0., 0., 0.],
        [4., 0., 0.],
        [4., 4., 0.],
        [0., 4., 0.],
        [1., 1., 0.],
        [2., 1., 0.],
        [2., 2., 0.],
        [1., 2., 0.],
    ];

    fn areas(faces: &[&[u32]], positions: &[[f64; 3]]) -> Vec<f64> {
        let face = |(index, vertices): (usize, &&[u32])| Face {
            vertices: (*vertices).into(),
            material: index as u32,
            ..Face::default()
        };
        let scene = Scene {
            positions: positions.iter().map(|&p| p.into()).collect(),
            faces: faces.iter().enumerate().map(face).collect(),
            materials: vec![Material::default(); faces.len()],
            ..Scene::default()
        };
        surfaces_of(&scene)
            .list
            .iter()
            .map(|surface| (1e9 * surface.area()).round() / 1e9)
            .collect()
    }

    #[test]
    fn what_lies_in_a_surface_is_cut_out_of_it() {
        assert_eq!(areas(&[&[0, 1, 2, 3], &[4, 5, 6, 7]], &SQUARES), [15.0, 1.0]);
        assert_eq!(areas(&[&[4, 5, 6, 7], &[0, 1, 2, 3]], &SQUARES), [1.0, 15.0]);
        let nested = [&[4, 5, 6][..], &[0, 1, 2, 3], &[4, 5, 6, 7]];
        assert_eq!(areas(&nested, &SQUARES), [0.5, 15.0, 0.5]);
    }

    #[test]
    fn what_faces_the_other_way_lies_beside_or_reaches_out_stays() {
        assert_eq!(areas(&[&[0, 1, 2, 3], &[7, 6, 5, 4]], &SQUARES), [16.0, 1.0]);
        assert_eq!(areas(&[&[0, 1, 2, 3], &[4, 5, 6, 7]], &moved(3.0)), [16.0, 1.0]);
    }

    /// The small square moved along the large one's edge.
    fn moved(by: f64) -> [[f64; 3]; 8] {
        let mut squares = SQUARES;
        squares[4..].iter_mut().for_each(|p| p[0] += by);
        squares
    }

    #[test]
    fn what_reaches_out_of_a_surface_cuts_it() {
        for by in [2.5, -1.75] {
            let common = if by > 0.0 { 0.5 } else { 0.25 };
            let found = areas(&[&[0, 1, 2, 3], &[4, 5, 6, 7]], &moved(by));
            assert_eq!(found, [16.0 - common, 1.0]);
            assert_eq!(areas(&[&[4, 5, 6, 7], &[0, 1, 2, 3]], &moved(by)), [1.0, 16.0 - common]);
        }
        // A strip across divides; of equals, the first is whole; what two cover is gone.
        let strip = [[-1., 1., 0.], [5., 1., 0.], [5., 2., 0.], [-1., 2., 0.]];
        let places = [&SQUARES[..4], &strip].concat();
        assert_eq!(areas(&[&[0, 1, 2, 3], &[4, 5, 6, 7]], &places), [4.0, 8.0, 6.0]);
        let shifted = [[2., 0., 0.], [6., 0., 0.], [6., 4., 0.], [2., 4., 0.]];
        let places = [&SQUARES[..4], &shifted].concat();
        assert_eq!(areas(&[&[0, 1, 2, 3], &[4, 5, 6, 7]], &places), [16.0, 8.0]);
        let halves = [[-1., -1., 0.], [2., -1., 0.], [2., 4., 0.], [-1., 4., 0.]];
        let rest = [[2., 0., 0.], [4., 0., 0.], [4., 5., 0.], [2., 5., 0.]];
        let places = [&SQUARES[..4], &halves, &rest].concat();
        let faces: [&[u32]; 3] = [&[0, 1, 2, 3], &[4, 5, 6, 7], &[8, 9, 10, 11]];
        assert_eq!(areas(&faces, &places), [15.0, 10.0]);
    }

    #[test]
    fn of_two_in_the_same_place_one_is_left() {
        assert_eq!(areas(&[&[0, 1, 2, 3], &[0, 1, 2], &[0, 2, 3]], &SQUARES), [0.0, 8.0, 8.0]);
    }
}
