//! Surfaces that lie in one place: a picture in the plane of its wall, a lamp in that of its ceiling.

use rayon::prelude::*;

use super::contact::inside;
use super::coplanar::{Rank, are_level, size};
use super::merge::PlanarRegion;
use super::model::EPSILON;
use super::partial_overlap;
use crate::geometry::boxes::{self, Aabb, Tree, are_close};
use crate::geometry::polygon::{Ring, centroid, contains, edges};
use crate::scene::{Scene, note_count};

/// Regions of which none covers another: what lies in the plane of a larger one and faces the same way is cut
/// out of it; what reaches beyond it cuts it or is cut, as the one that glows, or else the smaller one, is left
/// whole. What was done is told in `notes`.
///
/// Without this, light would fall on both.
pub(super) fn without_overlaps(
    scene: &Scene,
    mut regions: Vec<PlanarRegion>,
    notes: &mut Vec<String>,
) -> Vec<PlanarRegion> {
    let epsilon = EPSILON * scene.extent();
    let ranks: Vec<Rank> =
        (0..regions.len()).into_par_iter().map(|k| Rank::new(scene, &regions, k)).collect();
    let mut within: Vec<Vec<usize>> = vec![Vec::new(); regions.len()];
    let mut beside = Vec::new();
    let pairs = level_pairs(&regions, epsilon);
    let covered = |&pair: &[usize; 2]| is_covered(&regions, pair, &ranks, epsilon);
    let covered: Vec<bool> = pairs.par_iter().map(covered).collect();
    for ([large, small], is_covered) in pairs.into_iter().zip(covered) {
        if is_covered {
            within[large].push(small);
        } else {
            beside.push([large, small]);
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
    let cut = partial_overlap::cut(&mut regions, &beside, &ranks, epsilon);
    note_count(notes, inner.len(), "surface", "cut out of larger ones in whose planes they lie");
    note_count(notes, cut, "surface", "cut where another lies in its plane");
    regions
}

/// Ordered pairs of regions of which the second lies in the plane of the first, faces the same way and may touch it.
fn level_pairs(regions: &[PlanarRegion], epsilon: f64) -> Vec<[usize; 2]> {
    let tree = Tree::new(regions.par_iter().map(bounds).collect());
    let of = |found: &mut Vec<u32>, outer: usize| {
        let plane = &regions[outer].plane;
        let meets = |other: Aabb| {
            let around = other.half_extent(plane.normal);
            are_close(tree.boxes()[outer], other, epsilon)
                && plane.height(other.middle()).abs() <= around + 2.0 * epsilon
        };
        tree.find(meets, found);
        let others = found.iter().map(|&inner| inner as usize).filter(|&inner| inner != outer);
        let level = others.filter(|&k| are_level(&regions[outer], &regions[k], epsilon));
        level.map(|inner| [outer, inner]).collect::<Vec<_>>()
    };
    (0..regions.len()).into_par_iter().map_init(Vec::new, of).flatten_iter().collect()
}

fn bounds(region: &PlanarRegion) -> Aabb {
    boxes::around(region.rings.iter().flatten().map(|&p| region.plane.lift(p)))
}

/// The rings of the second region as holes in the first.
fn seen_from(regions: &[PlanarRegion], [large, small]: [usize; 2]) -> Vec<Ring> {
    let (outer, inner) = (&regions[large], &regions[small]);
    let flat = |&p| outer.plane.flatten(inner.plane.lift(p));
    inner.rings.iter().map(|ring| ring.iter().rev().map(flat).collect()).collect()
}

/// True if the second of two regions in one plane lies in the first and is to be seen in its stead.
fn is_covered(
    regions: &[PlanarRegion],
    [large, small]: [usize; 2],
    ranks: &[Rank],
    epsilon: f64,
) -> bool {
    let (outer, inner) = (&regions[large], &regions[small]);
    let sizes = [size(outer), size(inner)];
    let alike = (sizes[0] - sizes[1]).abs() <= 1e-6 * sizes[0];
    let is_meant = alike && ranks[large].of_equals() >= ranks[small].of_equals();
    (alike || sizes[0] > sizes[1])
        && !is_meant
        && is_within(&seen_from(regions, [large, small]), &outer.rings, epsilon)
}

/// True if what is inside `rings` is inside `others`, borders touching or not.
fn is_within(rings: &[Ring], others: &[Ring], epsilon: f64) -> bool {
    let outside = |segment| inside(rings, segment, epsilon).is_empty();
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
    use crate::scene::{Face, Material, MaterialId};
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
            material: MaterialId(index as u32),
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
