//! What is seen of the lamps from elements, found when it is first asked for.

use std::sync::OnceLock;

use glam::DVec3;
use smallvec::SmallVec;

use super::direct_pass::World;
use crate::direct::Outlook;
use crate::mesh::{ElementId, Mesh};

/// The outlooks of a mesh's elements.
pub(super) struct Outlooks<'a> {
    pub(super) world: World<'a>,
    /// By element.
    of: Vec<OnceLock<Outlook<'a>>>,
}

impl<'a> Outlooks<'a> {
    /// None of the elements that the mesh has now has been looked from.
    pub(super) fn new(world: World<'a>, mesh: &Mesh) -> Self {
        Self { world, of: (0..mesh.elements.len()).map(|_| OnceLock::new()).collect() }
    }

    /// What is seen from an element of the mesh.
    pub(super) fn from(&self, mesh: &Mesh, element: ElementId) -> &Outlook<'a> {
        self.of[element.index()].get_or_init(|| {
            let plane = &self.world.surfaces.list[mesh.surface_of(element)].plane;
            let outline = mesh.outline(element);
            let corners: SmallVec<[DVec3; 8]> = outline.iter().map(|&p| plane.lift(p)).collect();
            self.world.light.on_part(mesh[element].patch, &corners)
        })
    }
}
