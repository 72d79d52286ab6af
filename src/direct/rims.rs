//! Which edges and corners of occluders bound a shadow: on a closed surface of facets only the few of its rim.
//!
//! Seen from a place, two polygons that run on in each other over an edge cover both of its sides, unless one
//! shows its front and the other its back. Where neither lamp nor receiver sees such a fold, nothing begins
//! or ceases to be hidden.

use std::collections::BTreeMap;

use glam::DVec3;
use smallvec::SmallVec;

use crate::surface::Weld;
use crate::visibility::{HalfSpace, Occluders};

/// The neighbours of occluders.
#[derive(Debug)]
pub(super) struct Rims {
    /// By occluder.
    outlines: Vec<Outline>,
    /// By place: the planes of all polygons around it, if they close around it; else none.
    around: Vec<SmallVec<[HalfSpace; 6]>>,
    tolerance: f64,
}

#[derive(Debug)]
struct Outline {
    plane: HalfSpace,
    /// By corner.
    places: SmallVec<[u32; 4]>,
    /// By edge: the plane of the one polygon that runs on over it.
    beyond: SmallVec<[Option<HalfSpace>; 4]>,
}

impl Rims {
    pub(super) fn new(occluders: &Occluders) -> Self {
        let mut weld = Weld::new(occluders.tolerance());
        let mut outlines = Vec::new();
        let mut by_edge: BTreeMap<[u32; 2], SmallVec<[u32; 1]>> = BTreeMap::new();
        for number in 0..occluders.len() as u32 {
            let facet = occluders.facet(number);
            let places: SmallVec<[u32; 4]> =
                facet.corners.iter().map(|&corner| weld.number(corner)).collect();
            for edge in edges(&places) {
                by_edge.entry(edge).or_default().push(number);
            }
            outlines.push(Outline { plane: facet.plane, places, beyond: SmallVec::new() });
        }
        let planes: Vec<HalfSpace> = outlines.iter().map(|outline| outline.plane).collect();
        let beyond = |[from, to]: [u32; 2]| {
            let alone = by_edge[&[from, to]].len() == 1;
            let other = by_edge.get(&[to, from]).filter(|others| alone && others.len() == 1);
            other.map(|others| planes[others[0] as usize])
        };
        let mut around = vec![Some(SmallVec::new()); weld.places().len()];
        for Outline { plane, places, beyond: found } in &mut outlines {
            found.extend(edges(places).map(beyond));
            let n = places.len();
            for (k, &place) in places.iter().enumerate() {
                let is_closed = found[k].is_some() && found[(k + n - 1) % n].is_some();
                let planes: &mut Option<SmallVec<_>> = &mut around[place as usize];
                match planes {
                    Some(planes) if is_closed => planes.push(*plane),
                    open => *open = None,
                }
            }
        }
        let around = around.into_iter().map(Option::unwrap_or_default).collect();
        Self { outlines, around, tolerance: occluders.tolerance() }
    }

    /// True if an occluder's edge from this corner to the next may bound what an eye sees of it.
    pub(super) fn is_rim(&self, occluder: u32, corner: usize, eye: DVec3) -> bool {
        let Outline { plane, beyond, .. } = &self.outlines[occluder as usize];
        beyond[corner].is_none_or(|other| !self.agree(&[*plane, other], &[eye]))
    }

    /// True if an occluder's corner may be on the rim of what it is part of, seen from between two places.
    pub(super) fn is_peak(&self, occluder: u32, corner: usize, eyes: [DVec3; 2]) -> bool {
        let place = self.outlines[occluder as usize].places[corner];
        let planes = &self.around[place as usize];
        planes.is_empty() || !self.agree(planes, &eyes)
    }

    /// True if all eyes are clearly on the same side of all planes.
    fn agree(&self, planes: &[HalfSpace], eyes: &[DVec3]) -> bool {
        let depths = || planes.iter().flat_map(|plane| eyes.iter().map(|&eye| plane.depth(eye)));
        depths().all(|depth| depth > self.tolerance)
            || depths().all(|depth| depth < -self.tolerance)
    }
}

fn edges(places: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    let next = places.iter().cycle().skip(1);
    places.iter().zip(next).map(|(&from, &to)| [from, to])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An octahedron, and an eye from which its rim is the square around its middle.
    fn octahedron() -> (Occluders, Rims) {
        let [top, bottom] = [DVec3::Y, DVec3::NEG_Y];
        let belt = [DVec3::X, DVec3::NEG_Z, DVec3::NEG_X, DVec3::Z];
        let faces: Vec<[DVec3; 3]> = (0..4)
            .flat_map(|k| {
                let [a, b] = [belt[k], belt[(k + 1) % 4]];
                [[top, a, b], [bottom, b, a]]
            })
            .collect();
        let faces: Vec<&[DVec3]> = faces.iter().map(|face| face.as_slice()).collect();
        let occluders = Occluders::from_polygons(&faces, 1e-6);
        let rims = Rims::new(&occluders);
        (occluders, rims)
    }

    #[test]
    fn edges_of_the_rim_are_those_between_front_and_back() {
        let (occluders, rims) = octahedron();
        let eye = DVec3::Y * 9.0;
        for number in 0..occluders.len() as u32 {
            let corners = occluders.facet(number).corners;
            for (k, corner) in corners.iter().enumerate() {
                let next = corners[(k + 1) % corners.len()];
                let level = corner.y.abs() < 0.5 && next.y.abs() < 0.5;
                assert_eq!(rims.is_rim(number, k, eye), level, "{corner} to {next}");
                let is_peak = rims.is_peak(number, k, [eye, eye + DVec3::X]);
                assert_eq!(is_peak, corner.y.abs() < 0.5, "{corner}");
            }
        }
    }

    #[test]
    fn open_edges_bound_what_they_hide() {
        let wall = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let rims = Rims::new(&Occluders::from_polygons(&[&wall], 1e-6));
        for k in 0..3 {
            assert!(rims.is_rim(0, k, DVec3::Z) && rims.is_peak(0, k, [DVec3::Z, DVec3::ONE]));
        }
    }
}
