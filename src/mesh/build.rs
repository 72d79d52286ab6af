//! Patches of a scene's surfaces, and the vertices that their elements share.

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use smallvec::SmallVec;

use super::ids::{ElementId, PatchId, VertexId};
use super::topology::{Corners, Element, Mesh, Patch, Reason, Vertex};
use super::vertex_index::{SurfaceVertices, VertexIndex, apart};
use crate::geometry::boxes::{self, Tree, are_close};
use crate::geometry::cut::{Cuts, convex_pieces};
use crate::geometry::polygon::{self, Convex, Segment};
use crate::geometry::{Plane, cells_around};
use crate::settings::Settings;
use crate::surface::{Contact, Surface, SurfaceId, Surfaces};

/// How far inside a border light is evaluated, in epsilons: well beyond what counts as touching it.
const INSET: f64 = 50.0;

/// Ends of cuts nearer to a vertex on the same edge than this share of it are moved there: less would be slivers.
const CLOSE: f64 = 1.0 / 32.0;

/// Surfaces whose pieces are cut at a time: enough for all threads, few enough to forget.
const AT_ONCE: usize = 4096;

/// What a patch is made from.
struct PatchOutline {
    outline: Convex,
    /// Of the sheet, those near it.
    contacts: SmallVec<[u32; 4]>,
}

impl Mesh {
    /// Divides surfaces into patches of bounded size, cut along contact lines, with an element each.
    ///
    /// With [`Settings::uniform`], elements are divided until none is longer than that.
    pub fn new(surfaces: &Surfaces, settings: &Settings) -> Self {
        let mut mesh = Self {
            patches: Vec::new(),
            elements: Vec::new(),
            vertices: Vec::new(),
            index: VertexIndex::new(surfaces, settings),
            limit: settings.max_elements.unwrap_or(usize::MAX),
            is_full: false,
        };
        let ids: Vec<SurfaceId> = surfaces.ids().collect();
        for ids in ids.chunks(AT_ONCE) {
            let pieces = |&id: &SurfaceId| mesh.index.pieces(surfaces, id, settings);
            let pieces: Vec<Vec<PatchOutline>> = ids.par_iter().map(pieces).collect();
            for (&id, pieces) in ids.iter().zip(pieces) {
                pieces.into_iter().for_each(|piece| mesh.add_patch(surfaces, id, piece));
            }
        }
        if let Some(size) = settings.uniform {
            mesh.divide_uniformly(size);
        }
        mesh
    }

    /// Adds a patch with its element; none where the corners are so close together that they enclose nothing.
    fn add_patch(&mut self, surfaces: &Surfaces, id: SurfaceId, piece: PatchOutline) {
        let PatchOutline { outline, contacts } = piece;
        let surface = &surfaces[id];
        let outline = self.settled(id, &outline);
        if outline.len() < 3 || polygon::area(&outline) <= 0.0 {
            return;
        }
        let patch = PatchId(self.patches.len() as u32);
        let root = ElementId(self.elements.len() as u32);
        let area = polygon::area(&outline);
        self.patches.push(Patch {
            surface: id,
            root,
            corners: outline.iter().map(|&p| surface.plane.lift(p)).collect(),
            normal: surface.plane.normal,
            area,
            two_sided: surface.two_sided,
            contacts,
        });
        let corners: Corners = outline.iter().map(|&p| self.vertex(patch, p)).collect();
        let children = SmallVec::new();
        self.elements.push(Element { patch, corners, children, level: 0, reason: None, area });
    }

    /// An outline with its corners moved to vertices that are close to them, each passed once.
    fn settled(&self, surface: SurfaceId, outline: &[DVec2]) -> Convex {
        let apart = self.index.by_surface[surface.index()].apart;
        let mut settled = Convex::new();
        for &corner in outline {
            let corner = self.place(surface, corner).unwrap_or(corner);
            if settled.iter().all(|other| other.distance(corner) > apart) {
                settled.push(corner);
            }
        }
        settled
    }

    /// The vertex of a patch at a place on its surface's plane, made if there is none.
    pub(super) fn vertex(&mut self, patch: PatchId, position: DVec2) -> VertexId {
        let surface = self[patch].surface;
        let on_contact = self.on_contact(patch, position);
        let place = self.place(surface, position);
        let position = place.unwrap_or(position);
        if let Some(found) = place.and_then(|place| self.vertex_at(place, patch, on_contact)) {
            return found;
        }
        let new = VertexId(self.vertices.len() as u32);
        self.index.cells.add(self.index.key(surface, position), new.0);
        let site = self.site(patch, position);
        self.vertices.push(Vertex { surface, patch, position, site, on_contact });
        new
    }

    /// The vertex of a patch at a place on its surface's plane, if there is one.
    pub fn find_vertex(&self, patch: PatchId, position: DVec2) -> Option<VertexId> {
        let place = self.place(self[patch].surface, position)?;
        self.vertex_at(place, patch, self.on_contact(patch, position))
    }

    /// Where on a surface the first vertex is that counts as being at a position.
    fn place(&self, surface: SurfaceId, position: DVec2) -> Option<DVec2> {
        let VertexIndex { cells, by_surface, .. } = &self.index;
        let apart = by_surface[surface.index()].apart;
        let keys = cells_around(surface.0, position.extend(0.0), apart);
        let vertices = keys.flat_map(|key| cells.of(key)).map(|number| &self[VertexId(number)]);
        let mut on_surface = vertices.filter(|vertex| vertex.surface == surface);
        let first = on_surface.find(|vertex| vertex.position.distance(position) <= apart);
        first.map(|vertex| vertex.position)
    }

    /// The vertex at exactly a place, that of the patch if a contact line runs through it.
    fn vertex_at(&self, place: DVec2, patch: PatchId, on_contact: bool) -> Option<VertexId> {
        let surface = self[patch].surface;
        let key = self.index.key(surface, place);
        let is_it = |&id: &VertexId| {
            let vertex = &self[id];
            vertex.surface == surface
                && vertex.position == place
                && vertex.on_contact == on_contact
                && (!on_contact || vertex.patch == patch)
        };
        self.index.cells.of(key).map(VertexId).find(is_it)
    }

    /// The vertex of a patch at a place on an edge; where one of any surface is close by on it, at that place.
    pub(super) fn vertex_on(&mut self, patch: PatchId, edge: Segment, position: DVec2) -> VertexId {
        self.mark();
        let SurfaceVertices { plane, .. } = &self.index.by_surface[self[patch].surface.index()];
        let reach = CLOSE * edge[0].distance(edge[1]);
        let flat = |place: DVec3| {
            let flat = plane.flatten(place);
            let aside = polygon::distance(edge, flat).max(plane.lift(flat).distance(place));
            (aside <= self.index.epsilon).then_some(flat)
        };
        let close = self.index.landmarks.within(reach, plane.lift(position)).filter_map(flat);
        let nearest = close
            .min_by(|a, b| a.distance_squared(position).total_cmp(&b.distance_squared(position)));
        self.vertex(patch, nearest.unwrap_or(position))
    }

    /// Makes landmarks of the vertices that are none yet.
    fn mark(&mut self) {
        let VertexIndex { by_surface, landmarks, .. } = &mut self.index;
        for vertex in &self.vertices[landmarks.marked..] {
            landmarks.add(by_surface[vertex.surface.index()].plane.lift(vertex.position));
        }
        landmarks.marked = self.vertices.len();
    }

    /// Another vertex at the same place, for the light there on the side of a place inside.
    pub(super) fn copy_towards(
        &mut self,
        patch: PatchId,
        vertex: VertexId,
        inside: DVec2,
    ) -> VertexId {
        let plane = self.plane(patch);
        let mut copy = self[vertex].clone();
        let inward = (inside - copy.position).normalize_or_zero();
        let reach = (2.0 * INSET * self.index.epsilon).min(0.2 * inside.distance(copy.position));
        copy.patch = patch;
        copy.site = plane.lift(copy.position + inward * reach);
        self.vertices.push(copy);
        VertexId(self.vertices.len() as u32 - 1)
    }

    /// The plane of a patch.
    pub fn plane(&self, patch: PatchId) -> &Plane {
        &self.index.by_surface[self[patch].surface.index()].plane
    }

    /// What is nearer than this, m, counts as one place on a surface.
    pub fn epsilon(&self) -> f64 {
        self.index.epsilon
    }

    fn on_contact(&self, patch: PatchId, position: DVec2) -> bool {
        self.contacts_at(patch, position).next().is_some()
    }

    /// The contact lines that run through a place on a patch.
    fn contacts_at(&self, patch: PatchId, position: DVec2) -> impl Iterator<Item = &Contact> {
        let Patch { surface, contacts, .. } = &self[patch];
        let SurfaceVertices { contacts: lines, apart, .. } =
            &self.index.by_surface[surface.index()];
        let lines = contacts.iter().map(|&line| &lines[line as usize]);
        lines.filter(move |line| polygon::distance(line.segment, position) <= *apart)
    }

    /// Where to evaluate light for a place on a patch: moved inwards until it is a hair away from
    /// every border, so that what stands along a border is seen from the patch's side.
    pub fn site(&self, patch: PatchId, position: DVec2) -> DVec3 {
        self.inside(patch, self.plane(patch).lift(position), INSET * self.index.epsilon)
    }

    /// Where to gather light from other surfaces for a vertex, m: its site; but under the edge of what hovers close
    /// over it, as far from there as makes interpolation across the smallest elements right.
    ///
    /// Across the edge of a wide plate at a gap g over a surface, light falls as (1 + x / √(x² + g²)) / 2. Across
    /// elements much smaller than the gap, it is interpolated well from what it is at the edge; for elements of a width
    /// w far larger than that, the edge is a step, and light is to be known well beside it. The place at 3 g exp(-3 g /
    /// w), a fit, is within 0.015 of the light in the middle of such an element for any w.
    pub fn viewpoint(&self, vertex: VertexId) -> DVec3 {
        let Vertex { patch, site, .. } = self[vertex];
        let gap = self.gap_over(vertex);
        let aside = 3.0 * gap * (-3.0 * gap / self.index.shortest).exp();
        self.inside(patch, site, aside)
    }

    /// How far over a vertex the edge of something hovers close, m; 0 where there is none.
    pub fn gap_over(&self, vertex: VertexId) -> f64 {
        let Vertex { patch, position, on_contact, .. } = self[vertex];
        let lines = on_contact.then(|| self.contacts_at(patch, position)).into_iter().flatten();
        lines.map(|line| line.gap).fold(0.0, f64::max)
    }

    /// A place on a patch, moved inwards until it is so far inside of every border, m, or in the middle of it.
    fn inside(&self, patch: PatchId, place: DVec3, inset: f64) -> DVec3 {
        let Patch { corners, normal, area, .. } = &self[patch];
        let edges = || corners.iter().zip(corners.iter().cycle().skip(1));
        let perimeter: f64 = edges().map(|(a, b)| a.distance(*b)).sum();
        let inset = inset.min(0.2 * area / perimeter);
        let mut site = place;
        for _ in 0..2 {
            for (&a, &b) in edges() {
                let inward = normal.cross(b - a).normalize_or_zero();
                site += inward * (inset - (site - a).dot(inward)).max(0.0);
            }
        }
        site
    }

    fn divide_uniformly(&mut self, size: f64) {
        let mut next = 0;
        while next < self.elements.len() {
            let element = ElementId(next as u32);
            let [width, height] = self.sides(element);
            if width.max(height) > size * (1.0 + 1e-9) {
                self.split(element, self.round_split(element), Reason::Uniform);
            }
            next += 1;
        }
    }
}

/// The outlines of the patches of a surface.
fn outlines(surfaces: &Surfaces, surface: &Surface, settings: &Settings) -> Vec<Convex> {
    let size = settings.patch_length(surfaces.extent.max(surface.extent()));
    let segments: Vec<Segment> = surface.contacts.iter().map(|line| line.segment).collect();
    let cuts = Cuts { segments: &segments, size, epsilon: apart(surfaces, surface) };
    convex_pieces(&surface.rings, &cuts)
}

/// How many patches each surface will be divided into: much quicker told than made.
pub fn patch_counts(surfaces: &Surfaces, settings: &Settings) -> Vec<usize> {
    let count = |surface| outlines(surfaces, surface, settings).len();
    surfaces.list.par_iter().map(count).collect()
}

impl VertexIndex {
    /// The pieces of a surface, in the order of its patches.
    fn pieces(&self, surfaces: &Surfaces, id: SurfaceId, settings: &Settings) -> Vec<PatchOutline> {
        let surface = &surfaces[id];
        let SurfaceVertices { contacts, apart, .. } = &self.by_surface[id.index()];
        let flat = |line: &Contact| boxes::around(line.segment.map(|p| p.extend(0.0)));
        let tree = Tree::new(contacts.iter().map(flat).collect());
        let piece = |outline: Convex| PatchOutline {
            contacts: touching(contacts, &tree, &outline, *apart),
            outline,
        };
        outlines(surfaces, surface, settings).into_iter().map(piece).collect()
    }
}

/// Indices of the lines, with a tree over them, that come near a convex polygon.
fn touching(lines: &[Contact], tree: &Tree, outline: &[DVec2], epsilon: f64) -> SmallVec<[u32; 4]> {
    let mut found = Vec::new();
    let around = boxes::around(outline.iter().map(|p| p.extend(0.0)));
    tree.find(|bounds| are_close(around, bounds, 2.0 * epsilon), &mut found);
    let borders = polygon::borders(outline);
    let near = |&k: &u32| {
        let [a, b] = lines[k as usize].segment;
        borders.iter().all(|line| line.side(a, 0.0).max(line.side(b, 0.0)) >= -2.0 * epsilon)
    };
    found.into_iter().filter(near).collect()
}
