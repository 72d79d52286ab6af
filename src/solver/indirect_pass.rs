//! Indirect light over the mesh: gathered where it varies, interpolated elsewhere.

use super::direct_pass::reflects;
use super::gather::Gatherer;
use super::groups::Groups;
use super::{Observer, Phase};
use crate::colour::Rgb;
use crate::mesh::{ElementId, Mesh, Middle, Split, Vertex, VertexId};
use crate::refine::Oracle;
use crate::settings::Settings;
use crate::surface::polygon::distance;

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
        oracle.judge((mesh, element), middle, shown, 0.0).map(|split| (element, split))
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

/// Gives vertices that were not gathered what their parents' corners say, from the patches downwards.
pub(super) fn interpolate(mesh: &mut Mesh) {
    for index in 0..mesh.elements.len() {
        let element = ElementId(index as u32);
        let Some(middle) = mesh.find_middle(element) else { continue };
        let corners = mesh[element].corners.clone();
        let at = |mesh: &Mesh, v: VertexId| mesh[v].indirect.unwrap_or(Rgb::ZERO);
        for (k, &vertex) in middle.edges.iter().enumerate() {
            let mean = (at(mesh, corners[k]) + at(mesh, corners[(k + 1) % corners.len()])) * 0.5;
            mesh.vertices[vertex.index()].indirect.get_or_insert(mean);
        }
        let mean = corners.iter().map(|&v| at(mesh, v)).sum::<Rgb>() / corners.len() as f64;
        mesh.vertices[middle.centre.index()].indirect.get_or_insert(mean);
        for vertex in ends_of_cut(mesh, element) {
            let light = along_edges(mesh, &corners, &middle.edges, vertex);
            mesh.vertices[vertex.index()].indirect.get_or_insert(light);
        }
    }
}

/// Corners of an element's parts that lack light.
fn ends_of_cut(mesh: &Mesh, element: ElementId) -> Vec<VertexId> {
    let parts = mesh[element].children.iter();
    let corners = parts.flat_map(|&part| mesh[part].corners.iter().copied());
    corners.filter(|&v| mesh[v].indirect.is_none()).collect()
}

/// Light at a vertex on the border of an element, from the corners and midpoints of the nearest edge.
fn along_edges(mesh: &Mesh, corners: &[VertexId], middles: &[VertexId], vertex: VertexId) -> Rgb {
    let at = |v: VertexId| (mesh[v].position, mesh[v].indirect.unwrap_or(Rgb::ZERO));
    let place = mesh[vertex].position;
    let n = corners.len();
    let halves =
        (0..n).flat_map(|k| [[corners[k], middles[k]], [middles[k], corners[(k + 1) % n]]]);
    let gap = |half: &[VertexId; 2]| distance(half.map(|v| at(v).0), place);
    let nearest = halves.min_by(|a, b| gap(a).total_cmp(&gap(b)));
    let [(a, from), (b, to)] = nearest.unwrap_or([corners[0]; 2]).map(at);
    // Ends that were welded are at no distance.
    from.lerp(to, (a.distance(place) / a.distance(b).max(f64::MIN_POSITIVE)).min(1.0))
}
