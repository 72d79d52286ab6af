//! Which emitters can shine on which patches, and what may stand in between: found for regions, from all patches down
//! to few, each from what holds for the one around it.
//!
//! So an emitter behind a wall is dropped once for all behind that wall, and what a patch must look at is a part of
//! what its surroundings had to.

use std::ops::ControlFlow;

use glam::DVec3;
use obvhs::bvh2::Bvh2;

use super::emitter::Emitter;
use super::emitters::Emitters;
use super::ids::EmitterId;
use crate::geometry::PlanarPolygon;
use crate::geometry::hierarchy::hierarchy;
use crate::mesh::{Mesh, Patch, PatchId};
use crate::visibility::{Blockers, ConvexBody, Occluders};
use crate::watch::in_batches;

/// Patches longer than this share of the longest are regions of their own.
const LARGE: f64 = 0.25;

/// Most patches that have their candidates in common.
const TOGETHER: usize = 16;

/// Patches whose candidates are looked for between two questions whether to go on.
const AT_ONCE: usize = 64;

/// An emitter that can shine on a region.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) emitter: EmitterId,
    pub(super) blockers: Blockers,
    /// No place in the region gets more from it, mean of the channels, W/m².
    pub(super) most: f64,
}

/// The candidates of all patches.
#[derive(Debug)]
pub(super) struct Candidates {
    regions: Vec<Vec<Candidate>>,
    /// By patch: its region.
    of: Vec<u32>,
}

impl Candidates {
    /// Looks until `observe`, told the share done, breaks off; what is then left has what holds around it.
    pub(super) fn new(
        emitters: &Emitters,
        occluders: &Occluders,
        mesh: &Mesh,
        mut observe: impl FnMut(f64) -> ControlFlow<()>,
    ) -> Self {
        let sizes = mesh.patches.iter().map(|patch| bounds(&[patch]));
        let longest = sizes.map(|(low, high)| low.distance(high)).fold(0.0, f64::max);
        let boxes: Vec<_> = mesh.patches.iter().map(boxed).collect();
        let tree = hierarchy(&boxes);
        let finder = Finder { emitters, occluders, mesh, tree: &tree, large: LARGE * longest };
        let all = (0..emitters.list.len() as u32)
            .map(|emitter| Candidate {
                emitter: EmitterId(emitter),
                blockers: occluders.all(),
                most: f64::INFINITY,
            })
            .collect();
        let mut parts = Vec::new();
        if !mesh.patches.is_empty() {
            match observe(0.0) {
                ControlFlow::Continue(()) => finder.divide(0, all, &mut parts),
                ControlFlow::Break(()) => parts.push((0, all)),
            }
        }
        let descend = |(): &mut (), (node, around): &Subtree| finder.descend(*node, around);
        let mut found: Vec<Vec<Region>> = in_batches(&parts, |_| (), descend, observe);
        let rest = parts.drain(found.len()..);
        found.extend(rest.map(|(node, around)| vec![(finder.patches_under(node), around)]));
        let mut of = vec![0; mesh.patches.len()];
        let mut regions = Vec::new();
        for (patches, candidates) in found.into_iter().flatten() {
            patches.iter().for_each(|patch| of[patch.index()] = regions.len() as u32);
            regions.push(candidates);
        }
        Self { regions, of }
    }

    /// The emitters that can shine on a patch, in their order.
    pub(super) fn of(&self, patch: PatchId) -> &[Candidate] {
        self.regions.get(self.of[patch.index()] as usize).map_or(&[], Vec::as_slice)
    }
}

/// A node of the patches' tree, and the candidates of what is around it.
type Subtree = (u32, Vec<Candidate>);

/// Patches that have their candidates in common, and these.
type Region = (Vec<PatchId>, Vec<Candidate>);

struct Finder<'a> {
    emitters: &'a Emitters,
    occluders: &'a Occluders,
    mesh: &'a Mesh,
    tree: &'a Bvh2,
    /// Patches longer than this, m, are regions of their own.
    large: f64,
}

impl Finder<'_> {
    /// The candidates of parts of the tree under a node, from those of the node around it.
    fn divide(&self, node: u32, around: Vec<Candidate>, parts: &mut Vec<Subtree>) {
        let own = &self.tree.nodes[node as usize];
        let patches = self.patches_under(node);
        if own.is_leaf() || patches.len() <= AT_ONCE {
            return parts.push((node, around));
        }
        let here = self.narrowed(&around, &patches);
        self.divide(own.first_index, here.clone(), parts);
        self.divide(own.first_index + 1, here, parts);
    }

    /// The regions under a node of the patches' tree, from the candidates of the node around it.
    fn descend(&self, node: u32, around: &[Candidate]) -> Vec<Region> {
        let patches = self.patches_under(node);
        let own = &self.tree.nodes[node as usize];
        let (low, high) = self.bounds(&patches);
        let is_small = low.distance(high) <= 2.0 * self.large && patches.len() <= TOGETHER;
        if patches.len() > 1 && !own.is_leaf() && !is_small {
            let here = self.narrowed(around, &patches);
            let mut regions = self.descend(own.first_index, &here);
            regions.extend(self.descend(own.first_index + 1, &here));
            return regions;
        }
        let (large, small): (Vec<PatchId>, Vec<PatchId>) =
            patches.into_iter().partition(|&patch| self.is_large(patch));
        let alone = |patch: PatchId| (vec![patch], self.of_patch(around, &self.mesh[patch]));
        let mut regions: Vec<Region> = large.into_iter().map(alone).collect();
        match small.as_slice() {
            [] => {}
            &[patch] => regions.push(alone(patch)),
            _ => {
                let candidates = self.narrowed(around, &small);
                regions.push((small, candidates));
            }
        }
        regions
    }

    fn bounds(&self, patches: &[PatchId]) -> (DVec3, DVec3) {
        let patches: Vec<&Patch> = patches.iter().map(|&patch| &self.mesh[patch]).collect();
        bounds(&patches)
    }

    fn is_large(&self, patch: PatchId) -> bool {
        let (low, high) = bounds(&[&self.mesh[patch]]);
        low.distance(high) > self.large
    }

    /// The candidates of a patch by itself, exact but for what is behind its borders.
    fn of_patch(&self, around: &[Candidate], patch: &Patch) -> Vec<Candidate> {
        let receiver = patch.polygon();
        self.narrowing().of_polygon(around.iter(), receiver, 0.0)
    }

    /// Of the candidates of what is around some patches, those of the patches together.
    fn narrowed(&self, around: &[Candidate], patches: &[PatchId]) -> Vec<Candidate> {
        let (low, high) = self.bounds(patches);
        let reaching = around.iter().filter(|candidate| {
            let emitter = &self.emitters.list[candidate.emitter.index()];
            let reaches = |patch: &Patch| emitter.may_reach(patch.polygon());
            patches.iter().any(|&patch| reaches(&self.mesh[patch]))
        });
        let body = ConvexBody::cuboid(low, high);
        self.narrowing().unhidden(reaching, &body, |emitter, _| emitter.body())
    }

    fn narrowing(&self) -> Narrowing<'_> {
        Narrowing { emitters: self.emitters, occluders: self.occluders }
    }

    fn patches_under(&self, node: u32) -> Vec<PatchId> {
        let (mut open, mut patches) = (vec![node], Vec::new());
        while let Some(index) = open.pop() {
            let node = &self.tree.nodes[index as usize];
            if node.is_leaf() {
                let slots = node.first_index..node.first_index + node.prim_count;
                patches
                    .extend(slots.map(|slot| PatchId(self.tree.primitive_indices[slot as usize])));
            } else {
                open.extend([node.first_index + 1, node.first_index]);
            }
        }
        patches
    }
}

/// What candidates are narrowed by.
#[derive(Clone, Copy)]
pub(super) struct Narrowing<'a> {
    pub(super) emitters: &'a Emitters,
    pub(super) occluders: &'a Occluders,
}

impl Narrowing<'_> {
    /// Of the candidates of what is around a polygon, those of the polygon itself; what stands before emitters of which
    /// less than `least` can arrive, W/m², is left as it is.
    pub(super) fn of_polygon<'c>(
        self,
        around: impl Iterator<Item = &'c Candidate>,
        receiver: PlanarPolygon<'_>,
        least: f64,
    ) -> Vec<Candidate> {
        let reaches = |candidate: &&Candidate| {
            self.emitters.list[candidate.emitter.index()].may_reach(receiver)
        };
        let (reaching, body) = (around.filter(reaches), ConvexBody::polygon(receiver));
        let source = |emitter: &Emitter, most: f64| {
            if most < least { None } else { emitter.body_above(receiver) }
        };
        self.unhidden(reaching, &body, source)
    }

    /// Candidates, with what may hide them from a receiver; those that one occluder hides are left out.
    fn unhidden<'c>(
        self,
        candidates: impl Iterator<Item = &'c Candidate>,
        receiver: &ConvexBody,
        source: impl Fn(&Emitter, f64) -> Option<ConvexBody>,
    ) -> Vec<Candidate> {
        let narrowed = |Candidate { emitter: number, blockers, .. }: &Candidate| {
            let emitter = &self.emitters.list[number.index()];
            let most = emitter.most_on(receiver);
            let source = if blockers.is_clear() { None } else { source(emitter, most) };
            let ignored = |surface| emitter.is_part(surface);
            let blockers = match source {
                Some(source) => self.occluders.narrowed(blockers, &source, receiver, ignored),
                None => blockers.clone(),
            };
            (blockers != Blockers::Opaque).then_some(Candidate { emitter: *number, blockers, most })
        };
        candidates.filter_map(narrowed).collect()
    }
}

/// Opposite corners of the box around patches, m.
fn bounds(patches: &[&Patch]) -> (DVec3, DVec3) {
    let corners = || patches.iter().flat_map(|patch| patch.corners.iter().copied());
    (corners().fold(DVec3::INFINITY, DVec3::min), corners().fold(DVec3::NEG_INFINITY, DVec3::max))
}

fn boxed(patch: &Patch) -> obvhs::aabb::Aabb {
    let (low, high) = bounds(&[patch]);
    obvhs::aabb::Aabb::new(low.as_vec3a(), high.as_vec3a())
}
