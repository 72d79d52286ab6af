//! Dividing an element: in quarters, or along a line in halves.
//!
//! New vertices are always midpoints of edges or the mean of the corners, so that neighbours that share
//! an edge find the same vertices on it.

use glam::DVec2;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::ids::{ElementId, VertexId};
use super::topology::{Corners, Element, Mesh, Reason};
use crate::geometry::polygon::{self, Convex};

/// A quadrilateral this much longer than wide is halved, not quartered.
const LONG: f64 = 1.8;

/// How to divide an element.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Split {
    /// A triangle or quadrilateral in four, any other polygon in one quadrilateral per corner.
    Quarters,
    /// A quadrilateral in two, along the line between the midpoints of its edges `k` and `k + 2`,
    /// `k` being 0 or 1.
    Halves(usize),
    /// Any polygon in two, from one place on its border to another.
    Along([Crossing; 2]),
}

/// A place on the border of an element.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Crossing {
    /// The edge, counted from that from the first to the second corner.
    pub edge: usize,
    /// How far along it, 0..1; 0 is the corner itself.
    pub share: f64,
}

/// The vertices at which an element is judged and divided.
#[derive(Clone, Debug)]
pub struct Middle {
    /// Midpoint of each edge, beginning with that from the first to the second corner.
    pub edges: Corners,
    /// Mean of the corners.
    pub centre: VertexId,
}

impl Mesh {
    /// Divides a leaf; its children are leaves one level below.
    pub fn split(&mut self, element: ElementId, split: Split, reason: Reason) {
        let parent = &self[element];
        assert!(parent.is_leaf(), "element {} is divided already", element.0);
        let (patch, level) = (parent.patch, parent.level + 1);
        let parts = self.parts(element, split).into_iter().filter_map(outlining);
        let parts: SmallVec<[Corners; 4]> = parts.collect();
        let first = self.elements.len() as u32;
        for corners in &parts {
            let area = self.area_of(corners);
            self.elements.push(Element {
                patch,
                corners: corners.clone(),
                children: SmallVec::new(),
                level,
                reason: None,
                area,
            });
        }
        let parent = &mut self.elements[element.index()];
        parent.children = (first..first + parts.len() as u32).map(ElementId).collect();
        parent.reason = Some(reason);
    }

    /// The vertices in the middle of an element and of its edges, made where there are none.
    pub fn middle(&mut self, element: ElementId) -> Middle {
        let patch = self[element].patch;
        let (edges, centre) = self.middle_places(element);
        let edges = edges.into_iter().map(|place| self.vertex(patch, place)).collect();
        Middle { edges, centre: self.vertex(patch, centre) }
    }

    /// The vertices in the middle of an element and of its edges, if all are there.
    pub fn find_middle(&self, element: ElementId) -> Option<Middle> {
        let patch = self[element].patch;
        let (edges, centre) = self.middle_places(element);
        let edges = edges.into_iter().map(|place| self.find_vertex(patch, place));
        let edges = edges.collect::<Option<Corners>>()?;
        Some(Middle { edges, centre: self.find_vertex(patch, centre)? })
    }

    /// Midpoints of an element's edges, and the mean of its corners, m.
    fn middle_places(&self, element: ElementId) -> (Convex, DVec2) {
        let corners = self.outline(element);
        let edges = polygon::edges(&corners).map(|[a, b]| (a + b) * 0.5).collect();
        (edges, corners.iter().sum::<DVec2>() / corners.len() as f64)
    }

    /// The division that keeps an element's parts as round as it can.
    pub fn round_split(&self, element: ElementId) -> Split {
        let [width, height] = self.sides(element);
        match self[element].corners.len() {
            4 if width > LONG * height => Split::Halves(0),
            4 if height > LONG * width => Split::Halves(1),
            _ => Split::Quarters,
        }
    }

    /// The parts to the right and to the left of a cut. A corner at which light depends on the direction,
    /// being on a contact line, becomes two: one for each part.
    fn parts_along(
        &mut self,
        element: ElementId,
        crossings: [Crossing; 2],
    ) -> SmallVec<[Corners; 4]> {
        let Element { patch, corners, .. } = self[element].clone();
        let n = corners.len();
        let outline = self.outline(element);
        let ends = crossings.map(|Crossing { edge, share }| {
            if share == 0.0 {
                return corners[edge];
            }
            let ends = [outline[edge], outline[(edge + 1) % n]];
            self.vertex_on(patch, ends, ends[0].lerp(ends[1], share))
        });
        let part = |from: usize, to: usize| {
            let (start, end) = (crossings[from], crossings[to]);
            let mut part = Corners::from_slice(&[ends[from]]);
            let mut k = (start.edge + 1) % n;
            let last = if end.share == 0.0 { end.edge } else { (end.edge + 1) % n };
            while k != last {
                part.push(corners[k]);
                k = (k + 1) % n;
            }
            part.push(ends[to]);
            part
        };
        let mut parts = [part(0, 1), part(1, 0)];
        for part in &mut parts {
            let outline: Convex = part.iter().map(|&v| self[v].position).collect();
            let inside = polygon::centroid(&outline);
            for corner in [0, part.len() - 1] {
                if self[part[corner]].on_contact && corners.contains(&part[corner]) {
                    part[corner] = self.copy_towards(patch, part[corner], inside);
                }
            }
        }
        parts.into_iter().collect()
    }

    fn parts(&mut self, element: ElementId, split: Split) -> SmallVec<[Corners; 4]> {
        match split {
            Split::Quarters => self.quarters(element),
            Split::Halves(k) => self.halves(element, k),
            Split::Along(crossings) => self.parts_along(element, crossings),
        }
    }

    fn halves(&mut self, element: ElementId, k: usize) -> SmallVec<[Corners; 4]> {
        let Middle { edges: m, .. } = self.middle(element);
        let c = &self[element].corners;
        assert_eq!(c.len(), 4, "only quadrilaterals are halved");
        let [a, b, d, e] = [k, k + 1, (k + 2) % 4, (k + 3) % 4];
        let halves = [[c[a], m[a], m[d], c[e]], [m[a], c[b], c[d], m[d]]];
        halves.into_iter().map(Corners::from).collect()
    }

    fn quarters(&mut self, element: ElementId) -> SmallVec<[Corners; 4]> {
        let Middle { edges: m, centre } = self.middle(element);
        let c = &self[element].corners;
        let n = c.len();
        if n > 3 {
            let quarter = |k: usize| [c[k], m[k], centre, m[(k + n - 1) % n]];
            return (0..n).map(|k| Corners::from(quarter(k))).collect();
        }
        let quarters =
            [[c[0], m[0], m[2]], [m[0], c[1], m[1]], [m[2], m[1], c[2]], [m[0], m[1], m[2]]];
        quarters.iter().map(|quarter| Corners::from_slice(quarter)).collect()
    }
}

/// The corners of a part, each once; nothing where they enclose nothing, as beside an edge that is too short to be
/// divided.
fn outlining(mut corners: Corners) -> Option<Corners> {
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    (corners.len() > 2).then_some(corners)
}
