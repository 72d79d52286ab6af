//! Patches face to face in one plane, such as a floor and the bottom of a box on it.
//!
//! Where they lie is no different from where two faces lie back to back; what they see is: within a
//! solid there are mostly backs.

use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use rayon::prelude::*;

use super::row::SparseRow;
use crate::form_factor::hemicube::axes;
use crate::form_factor::rays::Sphere;
use crate::geometry::area_vector;
use crate::geometry::hierarchy::{hierarchy, overlapping};
use crate::geometry::{HalfSpace, Polygon};
use crate::mesh::Patch;
use crate::visibility::{Occluders, PatchHierarchy};

/// Rays that tell whether a place is within a solid.
const PROBES: usize = 64;

/// A patch of which other patches cover more than this share is covered: what is left is as narrow as
/// the precision with which patches are cut along those on them.
const COVERED: f64 = 0.999;

/// What patches touch.
#[derive(Debug)]
pub(super) struct Contacts {
    /// By patch: those face to face with it.
    face_to_face: Vec<Vec<TouchingPatch>>,
    /// By patch: true if its back is behind the front of another, or has a patch of its own.
    backed: Vec<bool>,
    /// By patch: true if those face to face with it leave nothing of it.
    covered: Vec<bool>,
}

/// A patch that lies on another.
#[derive(Debug)]
struct TouchingPatch {
    other: u32,
    normal: DVec3,
    /// Where both are.
    overlap: Polygon,
}

impl Contacts {
    pub(super) fn find(patches: &[Patch], occluders: &Occluders) -> Self {
        let epsilon = occluders.epsilon();
        let boxes = boxes(patches, epsilon);
        let tree = hierarchy(&boxes);
        let touching = |i: usize| -> Vec<TouchingPatch> {
            let near = overlapping(&tree, boxes[i]);
            let contact = |j: u32| TouchingPatch::of(&patches[i], &patches[j as usize], j, epsilon);
            near.into_iter().filter_map(contact).collect()
        };
        let mut all: Vec<Vec<TouchingPatch>> =
            (0..patches.len()).into_par_iter().map(touching).collect();
        let covered_share = |(patch, contacts): (&Patch, &Vec<TouchingPatch>)| {
            contacts.iter().map(TouchingPatch::area).sum::<f64>() / patch.area
        };
        let backed =
            |both: (&Patch, &Vec<TouchingPatch>)| both.0.two_sided || covered_share(both) > 0.5;
        let backed = patches.iter().zip(&all).map(backed).collect();
        if all.iter().any(|contacts| !contacts.is_empty()) {
            let (hierarchy, sphere) = (PatchHierarchy::new(patches), Sphere::new(PROBES));
            let is_buried = |place: DVec3, patch: &Patch| {
                let axes = axes(patch.normal, 0.0).transpose();
                let met = sphere.directions().filter_map(|d| hierarchy.first(place, axes * d));
                let backs = met.filter(|(met, _)| {
                    let met = &patches[met.index()];
                    (place - met.corners[0]).dot(met.normal) < 0.0
                });
                backs.count() > PROBES / 2
            };
            all.par_iter_mut().zip(patches).for_each(|(contacts, patch)| {
                contacts.retain(|contact| {
                    let middle =
                        contact.overlap.iter().sum::<DVec3>() / contact.overlap.len() as f64;
                    is_buried(middle, patch) || is_buried(middle, &patches[contact.other as usize])
                });
            });
        }
        let covered = patches.iter().zip(&all).map(|both| covered_share(both) > COVERED).collect();
        Self { face_to_face: all, backed, covered }
    }

    /// Exchanges, m², of patch `i` with those after it that it touches.
    pub(super) fn row(&self, i: usize) -> SparseRow {
        let after = self.face_to_face[i].iter().filter(|contact| contact.other as usize > i);
        after.map(|contact| (contact.other, contact.area())).collect()
    }

    /// True if patch `i` sees nothing but what it touches.
    pub(super) fn is_covered(&self, i: usize) -> bool {
        self.covered[i]
    }

    /// True if light cannot end on the black back of patch `i`.
    pub(super) fn is_backed(&self, i: usize) -> bool {
        self.backed[i]
    }

    /// The patch that lies on patch `i` at a point of it, if one does: nothing else is seen from there.
    pub(super) fn covering(&self, i: usize, point: DVec3) -> Option<u32> {
        let mut touching = self.face_to_face[i].iter();
        touching.find(|contact| contact.holds(point)).map(|contact| contact.other)
    }
}

impl TouchingPatch {
    fn of(patch: &Patch, other: &Patch, index: u32, epsilon: f64) -> Option<Self> {
        let height = (other.corners[0] - patch.corners[0]).dot(patch.normal).abs();
        let faces = height <= epsilon && other.normal.dot(patch.normal) < -1.0 + 1e-9;
        if !faces || (patch.two_sided && other.two_sided) {
            return None;
        }
        let sides = (0..other.corners.len()).map(|k| other.side(k));
        let clipped = |overlap: Polygon, side: HalfSpace| side.clip(&overlap);
        let overlap = sides.fold(Polygon::from_slice(&patch.corners), clipped);
        let contact = Self { other: index, normal: other.normal, overlap };
        let least = epsilon * patch.area.min(other.area).sqrt();
        (contact.overlap.len() > 2 && contact.area() > least).then_some(contact)
    }

    fn area(&self) -> f64 {
        area_vector(&self.overlap).length()
    }

    fn holds(&self, point: DVec3) -> bool {
        let corners = &self.overlap;
        // The overlap turns as the patch below it, against the other's normal.
        (0..corners.len()).all(|k| {
            let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
            (to - from).cross(point - from).dot(self.normal) <= 0.0
        })
    }
}

/// Boxes around patches, with all that may lie on them; in 32 bits, about the middle of all.
fn boxes(patches: &[Patch], epsilon: f64) -> Vec<Aabb> {
    /// Growth, as a share of all: more than rounding to 32 bits and than patches in one plane may
    /// turn away from each other.
    const GROWTH: f64 = 1e-4;
    let corners = || patches.iter().flat_map(|patch| patch.corners.iter().copied());
    let low = corners().fold(DVec3::INFINITY, DVec3::min);
    let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
    let (centre, margin) = (low.midpoint(high), epsilon + GROWTH * low.distance(high));
    let around = |patch: &Patch| {
        let mut tight = Aabb::INVALID;
        patch.corners.iter().for_each(|&corner| {
            tight.extend((corner - centre).as_vec3a());
        });
        let margin = Vec3A::splat(margin as f32);
        Aabb::new(tight.min - margin, tight.max + margin)
    };
    patches.iter().map(around).collect()
}

impl Patch {
    /// The inside of its `k`-th edge.
    fn side(&self, k: usize) -> HalfSpace {
        let (from, to) = (self.corners[k], self.corners[(k + 1) % self.corners.len()]);
        HalfSpace::new(from, self.normal.cross(to - from).normalize_or_zero())
    }
}
