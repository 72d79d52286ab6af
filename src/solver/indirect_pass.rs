//! Indirect light over the mesh: gathered where it varies, interpolated elsewhere.

use std::ops::ControlFlow;

use super::gather::Gatherer;
use super::lit_mesh::LitMesh;
use super::{Observer, Phase};
use crate::colour::Rgb;
use crate::light::VertexLight;
use crate::mesh::{ElementId, Mesh, Middle, Split, VertexId};
use crate::refine::{Oracle, Refinement, Sample, refine as refine_mesh};
use crate::settings::Settings;

/// A mesh that is refined to reflected light.
struct ReflectedRefinement<'p, 'g, 'm, 'o> {
    oracle: &'p Oracle,
    gatherer: &'p mut Gatherer<'g>,
    lit: &'p mut LitMesh<'m>,
    observer: &'p mut Observer<'o>,
    levels: u32,
}

/// Gathers indirect light at the patches' corners, then, level by level, where interpolation fails,
/// dividing elements that direct light had left whole. A uniform mesh is gathered everywhere, and
/// left as it is.
pub(super) fn refine(
    settings: &Settings,
    oracle: &Oracle,
    gatherer: &mut Gatherer<'_>,
    lit: &mut LitMesh<'_>,
    observer: &mut Observer<'_>,
) {
    let optics = gatherer.optics();
    // What follows is gathered in any case: all else is interpolated from it.
    let _ = observer.tell(Phase::Gathering, 0.0);
    let reflects = |mesh: &Mesh, element: ElementId| optics.reflects(mesh[element].patch);
    if settings.uniform.is_some() {
        let leaves: Vec<ElementId> = lit.mesh.leaves().filter(|&e| reflects(lit.mesh, e)).collect();
        gatherer.light(lit, corners(lit.mesh, &leaves), observer);
        return;
    }
    let roots = lit.mesh.patches.iter().map(|patch| patch.root);
    let roots: Vec<ElementId> = roots.filter(|&e| reflects(lit.mesh, e)).collect();
    gatherer.light(lit, corners(lit.mesh, &roots), observer);
    let levels = settings.max_level;
    let mut refinement = ReflectedRefinement { oracle, gatherer, lit, observer, levels };
    refine_mesh(&mut refinement, roots, levels);
}

impl ReflectedRefinement<'_, '_, '_, '_> {
    /// Radiosity by reflected light at a vertex of an element, W/m².
    fn radiosity(&self, element: ElementId) -> impl Fn(VertexId) -> Rgb {
        let LitMesh { mesh, light, .. } = &*self.lit;
        let optics = self.gatherer.optics();
        optics.reflected(&mesh[element], |v| light.indirect(v).unwrap_or(Rgb::ZERO))
    }

    fn sample(&self, element: ElementId) -> Sample<'_> {
        Sample::new(self.lit.mesh, element, self.radiosity(element))
    }
}

impl Refinement for ReflectedRefinement<'_, '_, '_, '_> {
    fn begin(&mut self, level: u32) -> ControlFlow<()> {
        let share = (f64::from(level) + 1.0) / (f64::from(self.levels) + 1.0);
        self.observer.tell(Phase::Gathering, share)
    }

    fn lit(&mut self) -> (&mut Mesh, &VertexLight) {
        (self.lit.mesh, self.lit.light)
    }

    fn may_divide(&self, element: ElementId) -> bool {
        let mesh = &*self.lit.mesh;
        (!mesh[element].is_leaf() || self.oracle.may_divide(mesh, element))
            && !(self.gatherer.clusters().holds(mesh[element].patch)
                && self.oracle.is_even(&self.sample(element)))
    }

    fn estimate(&mut self, elements: &[ElementId], middles: &[Middle]) {
        let mut vertices = corners(self.lit.mesh, elements);
        vertices.extend(middles.iter().flat_map(|m| m.edges.iter().copied().chain([m.centre])));
        self.gatherer.light(self.lit, vertices, self.observer);
    }

    fn mark(&mut self, elements: &[ElementId], middles: &[Middle]) -> Vec<Option<Split>> {
        let split = |(&element, middle): (&ElementId, &Middle)| {
            self.oracle.judge(&self.sample(element), middle, self.radiosity(element), |_| false)
        };
        elements.iter().zip(middles).map(split).collect()
    }
}

/// Corners of elements.
fn corners(mesh: &Mesh, elements: &[ElementId]) -> Vec<VertexId> {
    elements.iter().flat_map(|&e| mesh[e].corners.iter().copied()).collect()
}
