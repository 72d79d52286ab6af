//! Indirect light over the mesh: gathered where it varies, interpolated elsewhere.

use std::ops::ControlFlow;

use super::direct_pass::{World, light, reflects};
use super::gather::Gatherer;
use super::{ElementLight, Observer, Phase};
use crate::colour::Rgb;
use crate::mesh::{ElementId, Mesh, Middle, Vertex, VertexId};
use crate::refine::Oracle;
use crate::settings::Settings;

/// Gathers indirect light at the patches' corners, then, level by level, where interpolation fails,
/// dividing elements that direct light had left whole. Returns how many vertices gathered.
pub(super) fn refine(
    world: World<'_>,
    settings: &Settings,
    (gatherer, oracle): (&Gatherer<'_>, &Oracle),
    mesh: &mut Mesh,
    observer: &mut Observer<'_>,
) -> (usize, ControlFlow<()>) {
    let mut candidates: Vec<ElementId> =
        mesh.patches.iter().map(|patch| patch.root).filter(|&e| reflects(mesh, e)).collect();
    let corners: Vec<VertexId> = corners(mesh, &candidates);
    let mut gathered = gatherer.light(mesh, corners);
    let mut flow = ControlFlow::Continue(());
    for level in 0..settings.max_level {
        let share = (f64::from(level) + 1.0) / (f64::from(settings.max_level) + 1.0);
        flow = observer.tell(Phase::Gathering, share);
        if flow.is_break() {
            break;
        }
        candidates.retain(|&e| !mesh[e].is_leaf() || oracle.may_divide(mesh, e));
        let middles: Vec<Middle> = candidates.iter().map(|&e| mesh.middle(e)).collect();
        let places = middles.iter().flat_map(|m| m.edges.iter().copied().chain([m.centre]));
        gathered += gatherer.light(mesh, places);
        let mut next = Vec::new();
        for (&element, middle) in candidates.iter().zip(&middles) {
            let reflectance = mesh[mesh[element].patch].reflectance;
            let shown = |v: &Vertex| reflectance * v.indirect.unwrap_or(Rgb::ZERO);
            let Some(split) = oracle.judge((mesh, element), middle, shown, 0.0) else { continue };
            if mesh[element].is_leaf() {
                mesh.split(element, split, oracle.reason(mesh, element, middle));
            }
            next.extend_from_slice(&mesh[element].children);
        }
        eprintln!(
            "level {level}: {} candidates {} gathered, next {}",
            candidates.len(),
            gathered,
            next.len()
        );
        candidates = next;
    }
    light(world, mesh);
    (gathered, flow)
}

/// Corners of elements, without those of black surfaces.
fn corners(mesh: &Mesh, elements: &[ElementId]) -> Vec<VertexId> {
    elements.iter().flat_map(|&e| mesh[e].corners.iter().copied()).collect()
}

/// Gathers at all corners of leaves: what a uniform mesh is measured by.
pub(super) fn everywhere(gatherer: &Gatherer<'_>, mesh: &mut Mesh) -> usize {
    let leaves: Vec<ElementId> = mesh.leaves().filter(|&e| reflects(mesh, e)).collect();
    let corners = corners(mesh, &leaves);
    gatherer.light(mesh, corners)
}

/// Gives vertices that were not gathered what their parents' corners say, from the patches downwards.
pub(super) fn interpolate(mesh: &mut Mesh) {
    for index in 0..mesh.elements.len() {
        let element = ElementId(index as u32);
        if mesh[element].is_leaf() {
            continue;
        }
        let Some(middle) = mesh.find_middle(element) else { continue };
        let corners = mesh[element].corners.clone();
        let at = |mesh: &Mesh, v: VertexId| mesh[v].indirect.unwrap_or(Rgb::ZERO);
        for (k, &vertex) in middle.edges.iter().enumerate() {
            let mean = (at(mesh, corners[k]) + at(mesh, corners[(k + 1) % corners.len()])) * 0.5;
            mesh.vertices[vertex.index()].indirect.get_or_insert(mean);
        }
        let mean = corners.iter().map(|&v| at(mesh, v)).sum::<Rgb>() / corners.len() as f64;
        mesh.vertices[middle.centre.index()].indirect.get_or_insert(mean);
    }
}

/// Indirect light at vertices of an unfinished solution: the mean of the leaves around each, by area, and an
/// `ambient` irradiance, W/m², for the light still to come.
pub(super) fn average(mesh: &mut Mesh, light: &ElementLight, ambient: Rgb) {
    let mut sums = vec![(Rgb::ZERO, 0.0); mesh.vertices.len()];
    for leaf in mesh.leaves() {
        let element = &mesh[leaf];
        for corner in &element.corners {
            let (sum, area) = &mut sums[corner.index()];
            *sum += light.indirect[leaf.index()] * element.area;
            *area += element.area;
        }
    }
    for (vertex, (sum, area)) in mesh.vertices.iter_mut().zip(sums) {
        if area > 0.0 {
            vertex.indirect.get_or_insert(sum / area + ambient);
        }
    }
}
