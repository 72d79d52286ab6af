//! Indirect light over the mesh: gathered where it varies, interpolated elsewhere.

use super::gather::Gatherer;
use super::lit_mesh::LitMesh;
use super::{Observer, Phase};
use crate::colour::Rgb;
use crate::light::Optics;
use crate::mesh::{ElementId, Mesh, Middle, Split, VertexId};
use crate::refine::{Oracle, Sample, reason};
use crate::settings::Settings;

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
    if settings.uniform.is_some() {
        let leaves: Vec<ElementId> =
            lit.mesh.leaves().filter(|&e| optics.reflects(lit.mesh[e].patch)).collect();
        gatherer.light(lit, corners(lit.mesh, &leaves), observer);
        return;
    }
    let roots = lit.mesh.patches.iter().map(|patch| patch.root);
    let mut candidates: Vec<ElementId> =
        roots.filter(|&e| optics.reflects(lit.mesh[e].patch)).collect();
    gatherer.light(lit, corners(lit.mesh, &candidates), observer);
    for level in 0..settings.max_level {
        let share = (f64::from(level) + 1.0) / (f64::from(settings.max_level) + 1.0);
        if observer.tell(Phase::Gathering, share).is_break() {
            return;
        }
        candidates.retain(|&e| {
            (!lit.mesh[e].is_leaf() || oracle.may_divide(lit.mesh, e))
                && !(gatherer.groups().holds(lit.mesh[e].patch)
                    && oracle.is_even(&Sample::new(lit.mesh, e, shown(lit, optics, e))))
        });
        let middles: Vec<Middle> = candidates.iter().map(|&e| lit.mesh.middle(e)).collect();
        let mut places = corners(lit.mesh, &candidates);
        places.extend(middles.iter().flat_map(|m| m.edges.iter().copied().chain([m.centre])));
        gatherer.light(lit, places, observer);
        candidates = divide(oracle, optics, lit, &candidates, &middles);
    }
}

/// Radiosity by reflected light at a vertex of an element, W/m².
fn shown(
    LitMesh { mesh, light }: &LitMesh<'_>,
    optics: &Optics,
    element: ElementId,
) -> impl Fn(VertexId) -> Rgb {
    let reflectance = optics.of(&mesh[element]);
    move |v| reflectance * light.indirect(v).unwrap_or(Rgb::ZERO)
}

/// Divides the leaves among the candidates that interpolation does not do justice, and returns the
/// parts of all such; none if there is no room for them.
fn divide(
    oracle: &Oracle,
    optics: &Optics,
    lit: &mut LitMesh<'_>,
    candidates: &[ElementId],
    middles: &[Middle],
) -> Vec<ElementId> {
    let verdict = |(&element, middle): (&ElementId, &Middle)| {
        let shown = shown(lit, optics, element);
        let sample = Sample::new(lit.mesh, element, &shown);
        oracle.judge(&sample, middle, &shown, |_| false).map(|split| (element, split))
    };
    let verdicts: Vec<Option<(ElementId, Split)>> =
        candidates.iter().zip(middles).map(verdict).collect();
    let LitMesh { mesh, light } = lit;
    let divided = verdicts.iter().flatten().filter(|(e, _)| mesh[*e].is_leaf()).count();
    if !mesh.has_room_for(divided) {
        return Vec::new();
    }
    let mut parts = Vec::new();
    for (verdict, middle) in verdicts.into_iter().zip(middles) {
        let Some((element, split)) = verdict else { continue };
        if mesh[element].is_leaf() {
            let reason = reason(mesh, light, element, split, middle);
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
