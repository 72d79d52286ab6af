//! Clusters of facets as shooters, and as what a hemicube sees.

use std::collections::BTreeMap;

use glam::DVec3;
use smallvec::SmallVec;

use super::clusters::{Clusters, SubCluster, centre};
use super::links::{CLOSE, CLOSE_SHARE, Link, NEAR, Row};
use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::{Hemicube, PatchCoverage, VisiblePatch, turn};
use crate::mesh::{ElementId, Mesh, Patch, PatchId};
use crate::visibility::SurfacePoint;

/// How often a cluster is halved at most where something is close: sixteen parts look for themselves.
const HALVINGS: u32 = 4;

/// The row of a cluster: what its representative sends, for all of its area.
///
/// Where something is so close that the representative cannot see for all, halves have representatives of their own.
pub(super) fn row(
    mesh: &Mesh,
    clusters: &Clusters,
    hemicube: &mut Hemicube<'_>,
    members: &[PatchId],
) -> Row {
    let whole = SubCluster::new(mesh, members.to_vec());
    let all = whole.area;
    let mut row = Row::default();
    let mut open = vec![(whole, 0)];
    while let Some((part, depth)) = open.pop() {
        let representative = &mesh[part.representative];
        let centre = mesh.centre(representative.root, mesh.plane(part.representative));
        let eye = SurfacePoint::new(centre, representative.normal);
        let hemicube = hemicube.look(eye, turn(representative.root.index() as f64));
        let divisible = depth < HALVINGS && part.members.len() > 1;
        if divisible && hemicube.share_within(CLOSE * part.size) > CLOSE_SHARE {
            open.extend(part.halves(mesh).map(|half| (half, depth + 1)));
            continue;
        }
        Shot { mesh, clusters, hemicube, eye, part: &part, share: part.area / all }
            .deliver(&mut row);
    }
    row
}

/// What one representative sends.
struct Shot<'a, 'b> {
    mesh: &'a Mesh,
    clusters: &'a Clusters,
    hemicube: &'a Hemicube<'b>,
    eye: SurfacePoint,
    part: &'a SubCluster,
    /// Share of the cluster's area that it speaks for.
    share: f64,
}

impl Shot<'_, '_> {
    fn deliver(&self, row: &mut Row) {
        let Self { mesh, clusters, hemicube, share, .. } = *self;
        row.escaped += hemicube.escaping() * share;
        for sight in hemicube.visible_patches_of(|patch| !clusters.holds(patch)) {
            if sight.front {
                self.link(&sight, row);
            } else {
                row.on_backs += sight.delta * share;
            }
        }
        let facets = SeenFacets::new(clusters, hemicube);
        row.on_backs += facets.on_backs * share;
        for (cluster, cover) in facets.fronts {
            self.add(clusters.receiver(mesh, cluster), cover.kept, row);
        }
    }

    /// Links the representative with the elements of a patch, fine enough for their distance.
    fn link(&self, sight: &VisiblePatch, row: &mut Row) {
        let mesh = self.mesh;
        let plane = mesh.plane(sight.patch);
        let root = mesh[sight.patch].root;
        let mut open: SmallVec<[ElementId; 32]> = SmallVec::new();
        open.push(root);
        while let Some(receiver) = open.pop() {
            let corners: SmallVec<[DVec3; 8]> =
                mesh.outline(receiver).iter().map(|&p| plane.lift(p)).collect();
            let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
            let sizes = self.part.size + mesh[receiver].area.sqrt();
            let parts = &mesh[receiver].children;
            if !parts.is_empty() && centre.distance(self.eye.position) < NEAR * sizes {
                open.extend_from_slice(parts);
                continue;
            }
            let part = (receiver != root).then_some(&corners[..]);
            let visible = self.hemicube.visible_share(sight, part);
            let factor = point_to_polygon(self.eye.position, self.eye.normal, &corners);
            row.factors += 1;
            self.add(receiver, factor * visible, row);
        }
    }

    fn add(&self, receiver: ElementId, factor: f64, row: &mut Row) {
        if factor > 0.0 && self.mesh[receiver].area > 0.0 {
            let source = self.mesh[self.part.representative].root;
            row.links.push(Link { source, receiver, exchange_area: factor * self.part.area });
        }
    }
}

/// The facets that a hemicube sees, by cluster: each may be smaller than its cells.
#[derive(Debug, Default)]
pub(super) struct SeenFacets {
    /// By cluster, what is seen of its fronts.
    pub(super) fronts: BTreeMap<usize, PatchCoverage>,
    /// Share of the view that their backs fill.
    pub(super) on_backs: f64,
}

impl SeenFacets {
    pub(super) fn new(clusters: &Clusters, hemicube: &Hemicube<'_>) -> Self {
        let mut facets = Self::default();
        for cover in hemicube.coverage_of(|patch| clusters.holds(patch)) {
            if cover.front {
                let none = PatchCoverage { covered: 0.0, kept: 0.0, ..cover };
                let sum = facets.fronts.entry(clusters.of(cover.patch)).or_insert(none);
                sum.covered += cover.covered;
                sum.kept += cover.kept;
            } else {
                facets.on_backs += cover.kept;
            }
        }
        facets.fronts.retain(|_, cover| cover.kept > 0.0);
        facets
    }
}

/// Form factor times area, m², from a polygon to a cluster near it, of which a hemicube over the polygon has seen
/// this; by reciprocity the sum of those from the facets.
pub(super) fn exchange_nearby(
    mesh: &Mesh,
    polygon: &[DVec3],
    members: &[PatchId],
    cover: PatchCoverage,
) -> f64 {
    let factor = |facet: &Patch| {
        let centre = centre(facet);
        point_to_polygon(centre, facet.normal, polygon) * facet.area
    };
    let visible = if cover.covered > 0.0 { (cover.kept / cover.covered).min(1.0) } else { 0.0 };
    visible * members.iter().map(|&member| factor(&mesh[member])).sum::<f64>()
}
