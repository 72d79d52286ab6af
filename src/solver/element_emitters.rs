//! What is seen of the emitters from elements, found when it is first asked for.

use std::sync::OnceLock;

use glam::DVec3;
use smallvec::SmallVec;

use super::context::Context;
use crate::direct::PotentialEmitters;
use crate::mesh::{ElementId, Mesh};

/// What may shine on the elements of a mesh: of each, a part of what may on the element around it.
pub(super) struct ElementEmitters<'a> {
    pub(super) context: Context<'a>,
    /// By element.
    of: Vec<OnceLock<PotentialEmitters<'a>>>,
    /// By element: that of which it is a part, if that is known.
    around: Vec<Option<ElementId>>,
}

impl<'a> ElementEmitters<'a> {
    /// Of the elements that the mesh has now, none of which has been looked from.
    pub(super) fn new(context: Context<'a>, mesh: &Mesh) -> Self {
        let mut element_emitters = Self { context, of: Vec::new(), around: Vec::new() };
        element_emitters.extend(mesh, &[]);
        element_emitters
    }

    /// Takes in the elements that the mesh has got since, parts of some that were divided.
    pub(super) fn extend(&mut self, mesh: &Mesh, divided: &[ElementId]) {
        self.of.resize_with(mesh.elements.len(), OnceLock::new);
        self.around.resize(mesh.elements.len(), None);
        for &element in divided {
            for part in &mesh[element].children {
                self.around[part.index()] = Some(element);
            }
        }
    }

    /// What is seen from an element of the mesh.
    pub(super) fn from(&self, mesh: &Mesh, element: ElementId) -> &PotentialEmitters<'a> {
        self.of[element.index()].get_or_init(|| {
            let plane = mesh.plane(mesh[element].patch);
            let outline = mesh.outline(element);
            let corners: SmallVec<[DVec3; 8]> = outline.iter().map(|&p| plane.lift(p)).collect();
            match self.around[element.index()] {
                Some(around) => self.from(mesh, around).on_part(&corners),
                None => self.context.light.on(mesh[element].patch).on_part(&corners),
            }
        })
    }

    /// Forgets what may shine on elements; it is found anew if it is asked for.
    pub(super) fn forget(&mut self, elements: &[ElementId]) {
        elements.iter().for_each(|element| self.of[element.index()] = OnceLock::new());
    }
}
