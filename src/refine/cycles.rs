//! The loop of adaptive refinement, the same for all kinds of light: estimate, mark, divide.

use std::ops::ControlFlow;

use super::oracle::reason;
use crate::light::VertexLight;
use crate::mesh::{ElementId, Mesh, Middle, Split};

/// A mesh on its way to being fine enough for one kind of light.
pub trait Refinement {
    /// Begins a level of elements; breaks off when there has been enough.
    fn begin(&mut self, level: u32) -> ControlFlow<()>;

    /// The mesh, and the light at its vertices.
    fn lit(&mut self) -> (&mut Mesh, &VertexLight);

    /// Whether an element is looked at: all that are divided already may be.
    fn may_divide(&self, element: ElementId) -> bool;

    /// Evaluates light where it is not known yet: at the corners of elements and in their middles.
    fn estimate(&mut self, elements: &[ElementId], middles: &[Middle]);

    /// How to divide each of the elements, if at all; only of the first, when there has been enough.
    fn mark(&mut self, elements: &[ElementId], middles: &[Middle]) -> Vec<Option<Split>>;

    /// Learns which elements have parts now that will be looked at next.
    fn divided(&mut self, _elements: &[ElementId]) {}
}

/// Divides elements until interpolation does the light justice, at most so many `levels` deep, unless there has been
/// enough before or there is no room for more.
pub fn refine(refinement: &mut impl Refinement, mut elements: Vec<ElementId>, levels: u32) {
    for level in 0..levels {
        if refinement.begin(level).is_break() {
            return;
        }
        elements.retain(|&element| refinement.may_divide(element));
        let mesh = refinement.lit().0;
        let middles: Vec<Middle> = elements.iter().map(|&element| mesh.middle(element)).collect();
        refinement.estimate(&elements, &middles);
        let marks = refinement.mark(&elements, &middles);
        let (mesh, light) = refinement.lit();
        let marked = || elements.iter().zip(&middles).zip(&marks);
        let marked = || marked().filter_map(|((&e, middle), &split)| Some((e, middle, split?)));
        if !mesh.has_room_for(marked().filter(|&(element, ..)| mesh[element].is_leaf()).count()) {
            return;
        }
        let mut divided = Vec::new();
        for (element, middle, split) in marked() {
            if mesh[element].is_leaf() {
                mesh.split(element, split, reason(mesh, light, element, split, middle));
            }
            divided.push(element);
        }
        refinement.divided(&divided);
        let mesh = refinement.lit().0;
        elements = divided.iter().flat_map(|&e| mesh[e].children.iter().copied()).collect();
    }
}
