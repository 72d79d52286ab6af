//! Direct light at vertices.

use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use smallvec::SmallVec;

use super::arrival::steep_means;
use super::context::Context;
use super::element_emitters::ElementEmitters;
use super::gather_points::neighbours;
use super::lit_mesh::LitMesh;
use super::observer::Observer;
use super::unfinished::make_do;
use crate::colour::{Rgb, strength};
use crate::direct::{DirectLight, Evaluated, WorkCounters};
use crate::light::{Direct, VertexLight};
use crate::mesh::{ElementId, Mesh, VertexId};

/// Evaluates direct light at all vertices that lack it; of these, those in the middle of `elements` and on their
/// borders by what stands before each element.
///
/// Vertices of facets that are in one cluster and at one place see the same share of it.
pub(super) fn light(
    element_emitters: &ElementEmitters<'_>,
    LitMesh { mesh, light, work }: &mut LitMesh<'_>,
    elements: &[ElementId],
    observer: &mut Observer<'_>,
) {
    let (mesh, context) = (&**mesh, element_emitters.context);
    let (owned, others) = owners(context, mesh, light, elements);
    let sets = neighbours(mesh, context.clusters, context.near, &others);
    let on_element = |(element, vertices): &(ElementId, SmallVec<[VertexId; 5]>)| {
        let potential = element_emitters.from(mesh, *element);
        counted(vertices.iter().map(|&v| potential.at(mesh[v].site)))
    };
    let shine = |set: &SmallVec<_>| light_together(context.light, mesh, set);
    let (mut lit, more) = evaluate(&owned, on_element, observer);
    **work += more;
    // Cut short, the second list would not begin where the first ends.
    if lit.len() == owned.len() {
        let (others, more) = evaluate(&sets, shine, observer);
        lit.extend(others);
        **work += more;
    }
    let vertices = owned.iter().flat_map(|(_, vertices)| vertices).chain(sets.iter().flatten());
    for (&vertex, &direct) in vertices.zip(lit.iter().flatten()) {
        light.set_direct(vertex, direct);
    }
}

/// Elements and their vertices.
type Owned = Vec<(ElementId, SmallVec<[VertexId; 5]>)>;

/// The vertices that lack light: those of each element, but for facets, and the others. Each is in one list, once.
fn owners(
    context: Context<'_>,
    mesh: &Mesh,
    light: &VertexLight,
    elements: &[ElementId],
) -> (Owned, Vec<VertexId>) {
    let vertices = || mesh.vertex_ids();
    let mut is_dark: Vec<bool> = vertices().map(|v| light.direct(v).is_none()).collect();
    let mut owned = Vec::new();
    for &element in elements.iter().filter(|&&e| !context.clusters.holds(mesh[e].patch)) {
        let middle = mesh.find_middle(element);
        let middle = middle.iter().flat_map(|m| m.edges.iter().chain([&m.centre]));
        let vertices = mesh[element].corners.iter().chain(middle).copied();
        // Light is evaluated for a vertex on its own patch.
        let dark = vertices.filter(|&v| {
            mesh[v].patch == mesh[element].patch && std::mem::take(&mut is_dark[v.index()])
        });
        let dark: SmallVec<[VertexId; 5]> = dark.collect();
        if !dark.is_empty() {
            owned.push((element, dark));
        }
    }
    let others = vertices().filter(|v| is_dark[v.index()]).collect();
    (owned, others)
}

/// What `work` makes of each item, in their order, and what that took.
pub(super) fn evaluate<T: Sync, R: Send + Serialize + DeserializeOwned>(
    items: &[T],
    work: impl Fn(&T) -> (R, WorkCounters) + Sync + Send,
    observer: &mut Observer<'_>,
) -> (Vec<R>, WorkCounters) {
    let batches = observer.evaluate(items, |batch, enough| {
        let going_on = batch.par_iter().take_any_while(|_| !enough.is_said());
        let (results, counts): (Vec<R>, Vec<WorkCounters>) = going_on.map(&work).unzip();
        (results, counts.into_iter().sum::<WorkCounters>())
    });
    let (results, counts): (Vec<Vec<R>>, Vec<WorkCounters>) = batches.into_iter().unzip();
    (results.into_iter().flatten().collect(), counts.into_iter().sum())
}

/// Light at some places, and what it took in all.
fn counted(evaluated: impl Iterator<Item = Evaluated>) -> (SmallVec<[Direct; 1]>, WorkCounters) {
    let mut work = WorkCounters::default();
    let count = |Evaluated { light, work: more }| {
        work += more;
        light
    };
    (evaluated.map(count).collect(), work)
}

/// Direct light at vertices next to each other: what the one that it reaches best sees of it, all do.
fn light_together(
    light: &DirectLight,
    mesh: &Mesh,
    vertices: &[VertexId],
) -> (SmallVec<[Direct; 1]>, WorkCounters) {
    let at = |v: VertexId| light.at(mesh[v].patch, mesh[v].site);
    if let &[vertex] = vertices {
        return counted([at(vertex)].into_iter());
    }
    let open: SmallVec<[Rgb; 8]> =
        vertices.iter().map(|&v| light.unoccluded(mesh[v].patch, mesh[v].site)).collect();
    let most = |a: &usize, b: &usize| strength(open[*a]).total_cmp(&strength(open[*b]));
    let brightest = (0..open.len()).max_by(most);
    let Evaluated { light: best, work } =
        brightest.map_or_else(Evaluated::default, |k| at(vertices[k]));
    let reached = best.unoccluded.cmpgt(Rgb::ZERO);
    let share = Rgb::select(reached, best.irradiance / best.unoccluded, Rgb::ONE);
    let direct = |unoccluded| Direct { irradiance: unoccluded * share, unoccluded };
    (open.into_iter().map(direct).collect(), work)
}

/// Evaluates direct light at the corners of all leaves, and in their middle, as their means need.
pub(super) fn light_leaves(
    context: Context<'_>,
    lit: &mut LitMesh<'_>,
    observer: &mut Observer<'_>,
) {
    // Facets are so small that their corners tell enough.
    let is_whole = |&leaf: &ElementId| !context.clusters.holds(lit.mesh[leaf].patch);
    let leaves: Vec<ElementId> = lit.mesh.leaves().filter(is_whole).collect();
    for &leaf in &leaves {
        lit.mesh.middle(leaf);
    }
    light(&ElementEmitters::new(context, lit.mesh), lit, &leaves, observer);
    if observer.is_over() {
        make_do(context.light, lit.mesh, lit.light);
    } else {
        let (steep, work) = steep_means(context, lit.mesh, lit.light, &leaves);
        lit.light.steep = steep;
        *lit.work += work;
    }
}
