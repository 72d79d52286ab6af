//! Indirect light over the mesh: gathered where it varies, interpolated elsewhere.

use super::direct_pass::reflects;
use super::gather::Gatherer;
use super::groups::Groups;
use super::{Observer, Phase};
use crate::colour::Rgb;
use crate::mesh::{ElementId, Mesh, Middle, Split, Vertex, VertexId};
use crate::refine::Oracle;
use crate::settings::Settings;

/// Gathers indirect light at the patches' corners, then, level by level, where interpolation fails,
/// dividing elements that direct light had left whole. A uniform mesh is gathered everywhere, and
/// left as it is.
pub(super) fn refine(
    (settings, oracle): (&Settings, &Oracle),
    gatherer: &mut Gatherer<'_>,
    mesh: &mut Mesh,
    observer: &mut Observer<'_>,
) {
    // What follows is gathered in any case: all else is interpolated from it.
    let _ = observer.tell(Phase::Gathering, 0.0);
    if settings.uniform.is_some() {
        let leaves: Vec<ElementId> = mesh.leaves().filter(|&e| reflects(mesh, e)).collect();
        gatherer.light(mesh, corners(mesh, &leaves), observer);
        return;
    }
    let roots = mesh.patches.iter().map(|patch| patch.root);
    let mut candidates: Vec<ElementId> = roots.filter(|&e| reflects(mesh, e)).collect();
    gatherer.light(mesh, corners(mesh, &candidates), observer);
    for level in 0..settings.max_level {
        let share = (f64::from(level) + 1.0) / (f64::from(settings.max_level) + 1.0);
        if observer.tell(Phase::Gathering, share).is_break() {
            return;
        }
        candidates.retain(|&e| {
            (!mesh[e].is_leaf() || oracle.may_divide(mesh, e))
                && !is_even_facet((gatherer.groups(), mesh), oracle, e)
        });
        let middles: Vec<Middle> = candidates.iter().map(|&e| mesh.middle(e)).collect();
        let mut places = corners(mesh, &candidates);
        places.extend(middles.iter().flat_map(|m| m.edges.iter().copied().chain([m.centre])));
        gatherer.light(mesh, places, observer);
        candidates = divide(oracle, mesh, &candidates, &middles);
    }
}

/// True for facets over which indirect light is even: what is between their corners need not be looked at.
fn is_even_facet((groups, mesh): (&Groups, &Mesh), oracle: &Oracle, element: ElementId) -> bool {
    let patch = mesh[element].patch;
    let light = |vertex: &Vertex| mesh[patch].reflectance * vertex.indirect.unwrap_or(Rgb::ZERO);
    groups.holds(patch) && oracle.is_even((mesh, element), light)
}

/// Divides the leaves among the candidates that interpolation does not do justice, and returns the
/// parts of all such; none if there is no room for them.
fn divide(
    oracle: &Oracle,
    mesh: &mut Mesh,
    candidates: &[ElementId],
    middles: &[Middle],
) -> Vec<ElementId> {
    let verdict = |(&element, middle): (&ElementId, &Middle)| {
        let reflectance = mesh[mesh[element].patch].reflectance;
        let shown = |v: &Vertex| reflectance * v.indirect.unwrap_or(Rgb::ZERO);
        oracle.judge((mesh, element), middle, shown, |_| false).map(|split| (element, split))
    };
    let verdicts: Vec<Option<(ElementId, Split)>> =
        candidates.iter().zip(middles).map(verdict).collect();
    let divided = verdicts.iter().flatten().filter(|(e, _)| mesh[*e].is_leaf()).count();
    if !mesh.has_room_for(divided) {
        return Vec::new();
    }
    let mut parts = Vec::new();
    for (verdict, middle) in verdicts.into_iter().zip(middles) {
        let Some((element, split)) = verdict else { continue };
        if mesh[element].is_leaf() {
            let reason = oracle.reason((mesh, element), split, middle);
            mesh.split(element, split, reason);
        }
        parts.extend_from_slice(&mesh[element].children);
    }
    parts
}

/// Corners of elements, without those of black surfaces.
fn corners(mesh: &Mesh, elements: &[ElementId]) -> Vec<VertexId> {
    elements.iter().flat_map(|&e| mesh[e].corners.iter().copied()).collect()
}
