//! Groups of facets as shooters, and as what a hemicube sees.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use glam::DVec3;
use smallvec::SmallVec;

use super::groups::{Groups, Part, centre};
use super::transport::{CLOSE, CLOSE_SHARE, Link, NEAR, Row};
use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::{Cover, Hemicube, Sight, turn};
use crate::mesh::{ElementId, Mesh, Patch, PatchId};
use crate::surface::Surfaces;

/// Facets farther away than this many of their radii are points.
const FAR: f64 = 8.0;

/// How often a group is halved at most where something is close: sixteen parts look for themselves.
const HALVINGS: u32 = 4;

/// The row of a group: what its speaker sends, for all of its area.
///
/// Where something is so close that the speaker cannot see for all, halves have speakers of their own.
pub(super) fn row(
    (surfaces, mesh, groups): (&Surfaces, &Mesh, &Groups),
    hemicube: &mut Hemicube<'_>,
    members: &[PatchId],
) -> Row {
    let whole = Part::new(mesh, members.to_vec());
    let all = whole.area;
    let mut row = Row::default();
    let mut open = vec![(whole, 0)];
    while let Some((part, depth)) = open.pop() {
        let speaker = &mesh[part.speaker];
        let plane = &surfaces.list[speaker.surface as usize].plane;
        let eye = (mesh.centre(speaker.root, plane), speaker.normal);
        let hemicube = hemicube.look(eye, turn(speaker.root.index() as f64));
        let divisible = depth < HALVINGS && part.members.len() > 1;
        if divisible && hemicube.share_within(CLOSE * part.size) > CLOSE_SHARE {
            open.extend(part.halves(mesh).map(|half| (half, depth + 1)));
            continue;
        }
        Shot { surfaces, mesh, groups, hemicube, eye, part: &part, share: part.area / all }
            .deliver(&mut row);
    }
    row
}

/// What one speaker sends.
struct Shot<'a, 'b> {
    surfaces: &'a Surfaces,
    mesh: &'a Mesh,
    groups: &'a Groups,
    hemicube: &'a Hemicube<'b>,
    eye: (DVec3, DVec3),
    part: &'a Part,
    /// Share of the group's area that it speaks for.
    share: f64,
}

impl Shot<'_, '_> {
    fn deliver(&self, row: &mut Row) {
        let Self { mesh, groups, hemicube, share, .. } = *self;
        row.escaped += hemicube.escaping() * share;
        for sight in hemicube.sights_of(|patch| !groups.holds(patch)) {
            if sight.front {
                self.link(sight, row);
            } else {
                row.on_backs += sight.delta * share;
            }
        }
        let facets = Facets::seen((mesh, groups), hemicube, self.eye);
        row.on_backs += facets.on_backs * share;
        for (patch, visible) in facets.fronts {
            let factor = facet_factor(self.eye, &mesh[patch]);
            row.factors += 1;
            self.add(mesh[patch].root, factor * visible, row);
        }
    }

    /// Links the speaker with the elements of a patch, fine enough for their distance.
    fn link(&self, Sight { patch, visible, .. }: Sight, row: &mut Row) {
        let mesh = self.mesh;
        let plane = &self.surfaces.list[mesh[patch].surface as usize].plane;
        let root = mesh[patch].root;
        let mut open: SmallVec<[ElementId; 32]> = SmallVec::new();
        open.push(root);
        while let Some(receiver) = open.pop() {
            let corners: SmallVec<[DVec3; 8]> =
                mesh.outline(receiver).iter().map(|&p| plane.lift(p)).collect();
            let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
            let sizes = self.part.size + mesh[receiver].area.sqrt();
            let parts = &mesh[receiver].children;
            if !parts.is_empty() && centre.distance(self.eye.0) < NEAR * sizes {
                open.extend_from_slice(parts);
                continue;
            }
            let visible = match visible {
                1.0 => 1.0,
                visible if receiver == root => visible,
                _ => self.hemicube.visible_share(patch, &corners),
            };
            let factor = point_to_polygon(self.eye.0, self.eye.1, &corners);
            row.factors += 1;
            self.add(receiver, factor * visible, row);
        }
    }

    fn add(&self, receiver: ElementId, factor: f64, row: &mut Row) {
        if factor > 0.0 && self.mesh[receiver].area > 0.0 {
            let source = self.mesh[self.part.speaker].root;
            row.links.push(Link { source, receiver, exchange: factor * self.part.area });
        }
    }
}

/// Form factor (0..=1) from a point with a unit normal to a facet that faces it, occlusion not included:
/// cos θ cos θ' A / (π d²) where it is far away, right to the square of its share of the distance.
fn facet_factor((point, normal): (DVec3, DVec3), facet: &Patch) -> f64 {
    let centre = centre(facet);
    let radius = facet.corners.iter().map(|c| c.distance_squared(centre)).fold(0.0, f64::max);
    let (towards, square) = (centre - point, point.distance_squared(centre));
    if square < FAR * FAR * radius {
        return point_to_polygon(point, normal, &facet.corners);
    }
    let cosines = towards.dot(normal).max(0.0) * (-towards).dot(facet.normal).max(0.0);
    cosines * facet.area / (PI * square * square)
}

/// The facets that a hemicube sees. They may be smaller than its cells: those of a group are visible in
/// the share that its cells have in all that it covers.
#[derive(Debug, Default)]
pub(super) struct Facets {
    /// Fronts, and the share of each that nothing hides.
    pub(super) fronts: Vec<(PatchId, f64)>,
    /// Share of the view that their backs fill.
    pub(super) on_backs: f64,
}

impl Facets {
    pub(super) fn seen(
        (mesh, groups): (&Mesh, &Groups),
        hemicube: &Hemicube<'_>,
        eye: (DVec3, DVec3),
    ) -> Self {
        let mut seen: BTreeMap<usize, Cover> = BTreeMap::new();
        let mut facets = Self::default();
        for cover in hemicube.prints_of(|patch| groups.holds(patch)) {
            if cover.front {
                let group = seen.entry(groups.of(cover.patch));
                let sum = group.or_insert(Cover { covered: 0.0, kept: 0.0, ..cover });
                sum.covered += cover.covered;
                sum.kept += cover.kept;
            } else {
                facets.on_backs += cover.kept;
            }
        }
        for (group, cover) in seen {
            let fronts = || {
                let faces = |&&p: &&PatchId| (eye.0 - mesh[p].corners[0]).dot(mesh[p].normal) > 0.0;
                groups.members(group).iter().filter(faces).copied()
            };
            let factor = |patch: PatchId| facet_factor(eye, &mesh[patch]);
            let covered =
                if hemicube.is_by_rays() { fronts().map(factor).sum() } else { cover.covered };
            let visible = if covered > 0.0 {
                (cover.kept / covered).min(1.0)
            } else {
                hemicube.visible_share(cover.patch, &mesh[cover.patch].corners)
            };
            if visible > 0.0 {
                facets.fronts.extend(fronts().map(|patch| (patch, visible)));
            }
        }
        facets
    }
}
