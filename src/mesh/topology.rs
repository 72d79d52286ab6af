//! Patches, elements and vertices, and how they hang together.

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::ids::{ElementId, PatchId, VertexId};
use super::vertex_index::VertexIndex;
use crate::geometry::PlanarPolygon;
use crate::geometry::Plane;
use crate::geometry::polygon::{self, Convex};
use crate::surface::SurfaceId;

/// Parts of an element that is divided, at most.
const MOST_PARTS: usize = 4;

/// Corners of an element, counter-clockwise.
pub type Corners = SmallVec<[VertexId; 4]>;

/// The surfaces of a scene, divided.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// The coarse pieces, surface by surface.
    pub patches: Vec<Patch>,
    /// The nodes of all trees; parents come before their children.
    pub elements: Vec<Element>,
    /// The corners of elements, and the places where light is evaluated to judge them.
    pub vertices: Vec<Vertex>,
    pub(super) index: VertexIndex,
    /// Most elements, see [`Settings::max_elements`](crate::settings::Settings::max_elements).
    pub(super) limit: usize,
    pub(super) is_full: bool,
}

/// A coarse piece of a surface: it shoots.
#[derive(Clone, Debug)]
pub struct Patch {
    /// The surface that it is a piece of.
    pub surface: SurfaceId,
    /// The element that covers it.
    pub root: ElementId,
    /// Its corners in space, m.
    pub corners: SmallVec<[DVec3; 4]>,
    /// Unit normal.
    pub normal: DVec3,
    /// Area, m².
    pub area: f64,
    /// True if a patch on the other side of a double-sided polygon covers the same place.
    pub two_sided: bool,
    /// Contact lines and inner corners of its surface that touch it.
    pub(super) contacts: SmallVec<[u32; 4]>,
}

impl Patch {
    /// Its outline, and the plane that it lies in.
    pub fn polygon(&self) -> PlanarPolygon<'_> {
        PlanarPolygon::new(&self.corners, self.normal)
    }
}

/// A convex polygon on a patch, at one level of its tree: it receives.
#[derive(Clone, Debug)]
pub struct Element {
    /// The patch it is part of.
    pub patch: PatchId,
    /// Its corners.
    pub corners: Corners,
    /// Its parts, once divided.
    pub children: SmallVec<[ElementId; 4]>,
    /// Depth below the patch, whose own element has level 0.
    pub level: u32,
    /// Why it was divided.
    pub reason: Option<Reason>,
    /// Area, m².
    pub area: f64,
}

/// Why an element was divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
    /// A uniform mesh was asked for.
    Uniform,
    /// Light varies more across it than interpolation can follow.
    Gradient,
    /// A light is seen from one part of it and not, or less, from another.
    ShadowEdge,
    /// A contact line runs along its border and light rises steeply beside it.
    Contact,
    /// A line on which direct light has a kink or a bend runs through it: it was cut along that.
    Discontinuity,
}

/// A place on a surface at which light may be known.
#[derive(Clone, Debug)]
pub struct Vertex {
    /// The surface that it is on.
    pub surface: SurfaceId,
    /// The patch, of perhaps several, on which light is evaluated for it.
    pub patch: PatchId,
    /// Coordinates on the surface's plane, m.
    pub position: DVec2,
    /// Where in space light is evaluated for it, m: moved a hair from the border into the patch.
    pub site: DVec3,
    /// True if a contact line runs through it, or it is at an inner corner of its surface's outline: its
    /// light holds on this patch's side only.
    pub on_contact: bool,
}

impl Element {
    /// True if it has not been divided.
    pub fn is_leaf(&self) -> bool {
        self.children.is_empty()
    }
}

impl Mesh {
    /// Whether so many elements more may be divided; if not, the mesh is full.
    pub fn has_room_for(&mut self, divisions: usize) -> bool {
        let parts = divisions.saturating_mul(MOST_PARTS);
        let fits = self.elements.len().saturating_add(parts) <= self.limit;
        self.is_full |= !fits;
        fits
    }

    /// True if elements were left whole because there would have been too many.
    pub fn is_full(&self) -> bool {
        self.is_full
    }

    /// What names the patches, in their order.
    pub fn patch_ids(&self) -> impl ExactSizeIterator<Item = PatchId> + Clone + use<> {
        (0..self.patches.len() as u32).map(PatchId)
    }

    /// What names the elements, parents before their children.
    pub fn element_ids(&self) -> impl ExactSizeIterator<Item = ElementId> + Clone + use<> {
        (0..self.elements.len() as u32).map(ElementId)
    }

    /// What names the vertices, in the order in which they were made.
    pub fn vertex_ids(&self) -> impl ExactSizeIterator<Item = VertexId> + Clone + use<> {
        (0..self.vertices.len() as u32).map(VertexId)
    }

    /// The elements that have not been divided, in the order in which they were made.
    pub fn leaves(&self) -> impl Iterator<Item = ElementId> + '_ {
        self.element_ids().filter(|&e| self[e].is_leaf())
    }

    /// The elements of each patch, parents before their children.
    pub fn trees(&self) -> Vec<Vec<ElementId>> {
        let mut trees = vec![Vec::new(); self.patches.len()];
        for (index, element) in self.elements.iter().enumerate() {
            trees[element.patch.index()].push(ElementId(index as u32));
        }
        trees
    }

    /// The surface an element lies on.
    pub fn surface_of(&self, element: ElementId) -> SurfaceId {
        self[self[element].patch].surface
    }

    /// An element's corners on its surface's plane, m.
    pub fn outline(&self, element: ElementId) -> Convex {
        self[element].corners.iter().map(|&v| self[v].position).collect()
    }

    /// An element's centre of gravity in space, m, on its surface's `plane`.
    pub fn centre(&self, element: ElementId, plane: &Plane) -> DVec3 {
        plane.lift(polygon::centroid(&self.outline(element)))
    }

    /// Mean lengths of a quadrilateral's edges 0 and 2, and of its edges 1 and 3, m;
    /// of any other polygon, its longest edge twice.
    pub fn sides(&self, element: ElementId) -> [f64; 2] {
        let outline = self.outline(element);
        let lengths: SmallVec<[f64; 8]> =
            polygon::edges(&outline).map(|[a, b]| a.distance(b)).collect();
        match lengths.as_slice() {
            &[a, b, c, d] => [(a + c) / 2.0, (b + d) / 2.0],
            lengths => [lengths.iter().copied().fold(0.0, f64::max); 2],
        }
    }

    pub(super) fn area_of(&self, corners: &[VertexId]) -> f64 {
        let outline: Convex = corners.iter().map(|&v| self[v].position).collect();
        polygon::area(&outline)
    }
}
