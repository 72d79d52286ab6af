//! Light at the vertices of a mesh.

use std::collections::BTreeMap;

use super::Direct;
use crate::colour::Rgb;
use crate::mesh::{ElementId, VertexId};

/// Irradiance at the vertices of a mesh, as far as it is known: vertices that the mesh has got since have none.
#[derive(Clone, Debug, Default)]
pub struct VertexLight {
    direct: Vec<Option<Direct>>,
    indirect: Vec<Option<Rgb>>,
    /// Mean irradiance straight from emitters, W/m², of leaves on which it is too steep for their vertices to tell.
    pub steep: BTreeMap<ElementId, Rgb>,
}

impl VertexLight {
    /// Light straight from emitters, once evaluated.
    pub fn direct(&self, vertex: VertexId) -> Option<Direct> {
        self.direct.get(vertex.index()).copied().flatten()
    }

    /// Light straight from emitters at all vertices where it is known.
    pub fn all_direct(&self) -> impl Iterator<Item = Direct> {
        self.direct.iter().flatten().copied()
    }

    /// Irradiance straight from emitters, W/m²; none where it is not known.
    pub fn direct_irradiance(&self, vertex: VertexId) -> Rgb {
        self.direct(vertex).unwrap_or_default().irradiance
    }

    /// Irradiance by light reflected from other surfaces, W/m², once evaluated.
    pub fn indirect(&self, vertex: VertexId) -> Option<Rgb> {
        self.indirect.get(vertex.index()).copied().flatten()
    }

    /// Irradiance by all light known so far, W/m².
    pub fn irradiance(&self, vertex: VertexId) -> Rgb {
        self.direct_irradiance(vertex) + self.indirect(vertex).unwrap_or_default()
    }

    /// Sets the light straight from emitters at a vertex.
    pub fn set_direct(&mut self, vertex: VertexId, light: Direct) {
        *entry(&mut self.direct, vertex) = Some(light);
    }

    /// Sets the irradiance of a vertex by light reflected from other surfaces, W/m².
    pub fn set_indirect(&mut self, vertex: VertexId, irradiance: Rgb) {
        *entry(&mut self.indirect, vertex) = Some(irradiance);
    }

    /// Forgets the reflected light of those vertices of which `is_stale` says so.
    pub fn forget_indirect(&mut self, is_stale: impl Fn(VertexId) -> bool) {
        for (index, light) in self.indirect.iter_mut().enumerate() {
            if is_stale(VertexId(index as u32)) {
                *light = None;
            }
        }
    }
}

/// The entry of a vertex, made if there is none.
fn entry<T: Clone>(list: &mut Vec<Option<T>>, vertex: VertexId) -> &mut Option<T> {
    if list.len() <= vertex.index() {
        list.resize(vertex.index() + 1, None);
    }
    &mut list[vertex.index()]
}
