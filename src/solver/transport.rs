//! How the light that a patch shoots arrives on the elements.
//!
//! A hemicube over the patch's centre tells what sees it and how much of each; the amounts are
//! exact form factors, from points of the smaller to the whole of the larger of two polygons. Far
//! apart, patches exchange light as wholes; near each other, their elements do, since light that
//! enters a narrow gap at its edge must not come out in its middle.

use glam::DVec3;
use smallvec::SmallVec;

use super::clusters::Clusters;
use super::links::{CLOSE, CLOSE_SHARE, Link, NEAR, Row};
use super::parts::{self, SeenFacets};
use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::{Hemicube, VisiblePatch, turn};
use crate::geometry::polygon::centroid;
use crate::mesh::{Element, ElementId, Mesh, PatchId};
use crate::visibility::SurfacePoint;

/// The same for elements that glare, whose centre may see little of what hides most of the light.
const CLOSE_TO_GLARE: f64 = 2.0;

/// And the share of their view.
const SHARE_OF_GLARE: f64 = 0.002;

/// Levels of a tree down to which elements look for themselves; below them it changed no result.
const LOOK_LEVELS: u32 = 2;

/// What light is exchanged between.
#[derive(Clone, Copy, Debug)]
pub(super) struct Transport<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) clusters: &'a Clusters,
    /// By element: whether the light that it shoots first varies so much over it that it glares.
    pub(super) glares: &'a [bool],
}

impl Transport<'_> {
    /// The row of a cluster of patches, most often a single one.
    pub(super) fn row(self, hemicube: &mut Hemicube<'_>, shooter: usize) -> Row {
        let Self { mesh, clusters, .. } = self;
        match clusters.members(shooter) {
            &[patch] => row_of_patch(self, hemicube, patch),
            members => parts::row(mesh, clusters, hemicube, members),
        }
    }

    /// True if an element's parts must look for themselves, since what is close to them is not so to its centre.
    ///
    /// Where light varies steeply, it is between them that it does, not between them and others alone.
    fn looks_by_parts(self, hemicube: &Hemicube<'_>, element: ElementId, size: f64) -> bool {
        let is_close = |sizes: f64, share: f64| hemicube.share_within(sizes * size) > share;
        let Element { level, children, .. } = &self.mesh[element];
        let is_whole = children.is_empty();
        !is_whole
            && (*level < LOOK_LEVELS && is_close(CLOSE, CLOSE_SHARE)
                || self.glares[element.index()] && is_close(CLOSE_TO_GLARE, SHARE_OF_GLARE))
    }
}

/// The row of one patch.
///
/// Where something is so close that the patch's centre cannot see for all of it, its parts look for
/// themselves.
fn row_of_patch(transport: Transport<'_>, hemicube: &mut Hemicube<'_>, shooter: PatchId) -> Row {
    let Transport { mesh, clusters, .. } = transport;
    let patch = &mesh[shooter];
    let mut row = Row::default();
    let mut open = vec![patch.root];
    while let Some(source) = open.pop() {
        let placed = PlacedElement::new(mesh, source);
        let eye = SurfacePoint::new(placed.centre, placed.normal);
        let hemicube = hemicube.look(eye, turn(source.index() as f64));
        if transport.looks_by_parts(hemicube, source, placed.size) {
            open.extend_from_slice(&mesh[source].children);
            continue;
        }
        let share = mesh[source].area / patch.area;
        row.escaped += hemicube.escaping() * share;
        for sight in hemicube.visible_patches_of(|patch| !clusters.holds(patch)) {
            if sight.front {
                Linking { mesh, hemicube, sight }.link(source, &mut row);
            } else {
                row.on_backs += sight.delta * share;
            }
        }
        let facets = SeenFacets::new(clusters, hemicube);
        row.on_backs += facets.on_backs * share;
        for (cluster, cover) in facets.fronts {
            let receiver = clusters.receiver(mesh, cluster);
            let gap = clusters.centre(cluster).distance(placed.centre);
            // Rays do not tell what a patch covers but its form factor; near ones, projection does.
            let exchange_area =
                if gap < NEAR * (placed.size + clusters.size(cluster)) && !hemicube.is_by_rays() {
                    parts::exchange_nearby(mesh, &placed.corners, clusters.members(cluster), cover)
                } else {
                    cover.kept * mesh[source].area
                };
            row.links.push(Link { source, receiver, exchange_area });
        }
    }
    row
}

/// Finds the links between a shooter and a patch that it sees.
struct Linking<'a, 'b> {
    mesh: &'a Mesh,
    hemicube: &'a Hemicube<'b>,
    sight: VisiblePatch,
}

/// An element in space.
struct PlacedElement {
    element: ElementId,
    corners: SmallVec<[DVec3; 8]>,
    centre: DVec3,
    normal: DVec3,
    size: f64,
}

impl Linking<'_, '_> {
    /// Links the elements of the patch in sight with those under `source`, fine enough for their distance.
    fn link(&self, source: ElementId, row: &mut Row) {
        let mut open: SmallVec<[(ElementId, ElementId); 32]> = SmallVec::new();
        open.push((source, self.mesh[self.sight.patch].root));
        while let Some((source, receiver)) = open.pop() {
            let (from, to) = (self.placed(source), self.placed(receiver));
            let near = from.centre.distance(to.centre) < NEAR * (from.size + to.size);
            let (sources, receivers) = (&self.mesh[source].children, &self.mesh[receiver].children);
            if near && !receivers.is_empty() && (to.size >= from.size || sources.is_empty()) {
                open.extend(receivers.iter().map(|&part| (source, part)));
            } else if near && !sources.is_empty() {
                open.extend(sources.iter().map(|&part| (part, receiver)));
            } else {
                let exchange_area = self.exchange_area(&from, &to, near, &mut row.factors);
                if exchange_area > 0.0 {
                    row.links.push(Link { source, receiver, exchange_area });
                }
            }
        }
    }

    /// Visible form factor times area, m²: by reciprocity the same from source to receiver and back.
    fn exchange_area(
        &self,
        source: &PlacedElement,
        receiver: &PlacedElement,
        near: bool,
        factors: &mut u64,
    ) -> f64 {
        let (small, large) =
            if source.size < receiver.size { (source, receiver) } else { (receiver, source) };
        let see = |point: &DVec3| {
            let in_front = (*point - large.corners[0]).dot(large.normal) > 0.0;
            if in_front { point_to_polygon(*point, small.normal, &large.corners) } else { 0.0 }
        };
        let points = if near { parts(small) } else { SmallVec::from_elem(small.centre, 1) };
        *factors += points.len() as u64;
        let factor = points.iter().map(see).sum::<f64>() / points.len() as f64;
        if factor == 0.0 {
            return 0.0;
        }
        let is_part = self.mesh[self.sight.patch].root != receiver.element;
        let part = is_part.then_some(&receiver.corners[..]);
        let visible = self.hemicube.visible_share(&self.sight, part);
        factor * visible * self.mesh[small.element].area
    }

    fn placed(&self, element: ElementId) -> PlacedElement {
        PlacedElement::new(self.mesh, element)
    }
}

impl PlacedElement {
    fn new(mesh: &Mesh, element: ElementId) -> Self {
        let plane = mesh.plane(mesh[element].patch);
        let outline = mesh.outline(element);
        Self {
            element,
            corners: outline.iter().map(|&p| plane.lift(p)).collect(),
            centre: plane.lift(centroid(&outline)),
            normal: plane.normal,
            size: mesh[element].area.sqrt(),
        }
    }
}

/// Points that stand for equal parts of an element: a 3 × 3 grid, or one for each corner.
fn parts(placed: &PlacedElement) -> SmallVec<[DVec3; 9]> {
    const AT: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
    if let &[a, b, c, d] = placed.corners.as_slice() {
        let at = |s: f64, t: f64| a.lerp(b, s).lerp(d.lerp(c, s), t);
        return AT.iter().flat_map(|&s| AT.iter().map(move |&t| at(s, t))).collect();
    }
    placed.corners.iter().map(|corner| corner.lerp(placed.centre, 0.5)).collect()
}
