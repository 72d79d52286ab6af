//! Direct light at vertices, and the mesh refined until it can be interpolated.

use glam::DVec2;
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use smallvec::SmallVec;

use super::arrival::steep_means;
use super::groups::Groups;
use super::lookout::{ONE_PLACE, neighbours};
use super::outlooks::Outlooks;
use super::unfinished::make_do;
use super::{Observer, Phase};
use crate::colour::Rgb;
use crate::direct::PatchLight;
use crate::mesh::{Direct, ElementId, Mesh, Middle, PatchId, Split, Vertex, VertexId};
use crate::refine::{self, Discontinuity, Oracle, cut, strength};
use crate::settings::Settings;
use crate::surface::Surfaces;
use crate::visibility::Occluders;
use crate::watch::Enough;

/// Probes along each axis of an element; together with edges and centre no gap is wider than a
/// quarter of a side.
const PROBES: usize = 4;

/// What light meets on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct World<'a> {
    pub(super) surfaces: &'a Surfaces,
    pub(super) occluders: &'a Occluders,
    pub(super) light: &'a PatchLight,
    /// What shoots as one.
    pub(super) groups: &'a Groups,
    /// Vertices of facets nearer to each other than this, m, are at one place.
    near: f64,
}

impl<'a> World<'a> {
    pub(super) fn new(surfaces: &'a Surfaces, light: &'a PatchLight, groups: &'a Groups) -> Self {
        let near = ONE_PLACE * surfaces.tolerance;
        Self { surfaces, occluders: light.occluders(), light, groups, near }
    }
}

/// Evaluates direct light at all vertices that lack it; of these, those in the middle of `elements` and on their
/// borders by what stands before each element.
///
/// Vertices of facets that are in one group and at one place see the same share of it.
fn light(
    outlooks: &Outlooks<'_>,
    mesh: &mut Mesh,
    elements: &[ElementId],
    observer: &mut Observer<'_>,
) {
    let world = outlooks.world;
    let (owned, others) = owners(world, mesh, elements);
    let sets = neighbours((mesh, world.groups), world.near, &others);
    let on_element = |(element, vertices): &(ElementId, SmallVec<[VertexId; 5]>)| {
        let outlook = outlooks.from(mesh, *element);
        vertices.iter().map(|&v| outlook.at(mesh[v].site)).collect::<SmallVec<[Direct; 1]>>()
    };
    let shine = |set: &SmallVec<_>| light_together(world, mesh, set);
    let mut lit = evaluate(world.light, &owned, on_element, observer);
    // Cut short, the second list would not begin where the first ends.
    if lit.len() == owned.len() {
        lit.extend(evaluate(world.light, &sets, shine, observer));
    }
    let vertices = owned.iter().flat_map(|(_, vertices)| vertices).chain(sets.iter().flatten());
    for (vertex, direct) in vertices.zip(lit.iter().flatten()) {
        mesh.vertices[vertex.index()].direct = Some(*direct);
    }
}

/// Elements and their vertices.
type Owned = Vec<(ElementId, SmallVec<[VertexId; 5]>)>;

/// The vertices that lack light: those of each element, but for facets, and the others. Each is in one list, once.
fn owners(world: World<'_>, mesh: &Mesh, elements: &[ElementId]) -> (Owned, Vec<VertexId>) {
    let mut is_dark: Vec<bool> =
        mesh.vertices.iter().map(|vertex| vertex.direct.is_none()).collect();
    let mut owned = Vec::new();
    for &element in elements.iter().filter(|&&e| !world.groups.holds(mesh[e].patch)) {
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
    let others = (0..mesh.vertices.len() as u32).map(VertexId).filter(|v| is_dark[v.index()]);
    (owned, others.collect())
}

/// What `work` makes of each item, in their order.
fn evaluate<T: Sync, R: Send + Serialize + DeserializeOwned>(
    light: &PatchLight,
    items: &[T],
    work: impl Fn(&T) -> R + Sync + Send,
    observer: &mut Observer<'_>,
) -> Vec<R> {
    let lamps = light.lamps();
    let mut counts = lamps.counts();
    let batches = observer.evaluate(items, |batch, enough| {
        let before = lamps.counts();
        let going_on = batch.par_iter().take_any_while(|_| !enough.is_said());
        let results: Vec<R> = going_on.map(&work).collect();
        let after = lamps.counts();
        (results, [0, 1].map(|k| after[k] - before[k]))
    });
    // What comes from a checkpoint has not been counted.
    for (_, [evaluations, rays]) in &batches {
        counts = [counts[0] + evaluations, counts[1] + rays];
    }
    lamps.count_from(counts);
    batches.into_iter().flat_map(|(results, _)| results).collect()
}

/// Direct light at vertices next to each other: what the one that it reaches best sees of it, all do.
fn light_together(
    World { light, .. }: World<'_>,
    mesh: &Mesh,
    vertices: &[VertexId],
) -> SmallVec<[Direct; 1]> {
    let at = |v: VertexId| light.at(mesh[v].patch, mesh[v].site);
    if let &[vertex] = vertices {
        return SmallVec::from_buf([at(vertex)]);
    }
    let open: SmallVec<[Rgb; 8]> =
        vertices.iter().map(|&v| light.unoccluded(mesh[v].patch, mesh[v].site)).collect();
    let most = |a: &usize, b: &usize| strength(open[*a]).total_cmp(&strength(open[*b]));
    let best = (0..open.len()).max_by(most).map_or_else(Direct::default, |k| at(vertices[k]));
    let reached = best.unoccluded.cmpgt(Rgb::ZERO);
    let share = Rgb::select(reached, best.irradiance / best.unoccluded, Rgb::ONE);
    let direct = |unoccluded| Direct { irradiance: unoccluded * share, unoccluded };
    open.into_iter().map(direct).collect()
}

/// Evaluates direct light at the corners of all leaves, and in their middle, as their means need.
pub(super) fn light_leaves(world: World<'_>, mesh: &mut Mesh, observer: &mut Observer<'_>) {
    // Facets are so small that their corners tell enough.
    let is_whole = |&leaf: &ElementId| !world.groups.holds(mesh[leaf].patch);
    let leaves: Vec<ElementId> = mesh.leaves().filter(is_whole).collect();
    for &leaf in &leaves {
        mesh.middle(leaf);
    }
    light(&Outlooks::new(world, mesh), mesh, &leaves, observer);
    if observer.flow.is_break() {
        make_do(world.light, mesh);
    } else {
        mesh.steep = steep_means(world, mesh, &leaves);
    }
}

/// True for small facets that are lit evenly, as their neighbours will be: no shadow edge is looked for that
/// would be hardly longer than the shortest side.
fn is_even_facet((groups, mesh): (&Groups, &Mesh), oracle: &Oracle, element: ElementId) -> bool {
    let patch = mesh[element].patch;
    let light =
        |vertex: &Vertex| mesh[patch].reflectance * vertex.direct.unwrap_or_default().irradiance;
    groups.holds(patch) && oracle.is_small(mesh, element) && oracle.is_even((mesh, element), light)
}

/// Refines the mesh until direct light can be interpolated; leaves a uniform mesh as it is.
pub(super) fn refine(
    world: World<'_>,
    settings: &Settings,
    mesh: &mut Mesh,
    observer: &mut Observer<'_>,
) {
    if observer.tell(Phase::Direct, 0.0).is_break() {
        return;
    }
    light(&Outlooks::new(world, mesh), mesh, &[], observer);
    if settings.uniform.is_some() || observer.flow.is_break() {
        return;
    }
    let oracle = Oracle::of_direct_light(settings, world.surfaces.extent, mesh);
    let may_be_divided = |mesh: &Mesh, element: ElementId| {
        oracle.may_divide(mesh, element)
            && reflects(mesh, element)
            && !is_even_facet((world.groups, mesh), &oracle, element)
    };
    let mut candidates: Vec<ElementId> =
        mesh.leaves().filter(|&e| may_be_divided(mesh, e)).collect();
    let lines = if settings.discontinuity_lines && settings.max_level > 0 {
        discontinuities(world, mesh, (&oracle, &candidates), observer)
    } else {
        vec![Vec::new(); mesh.patches.len()]
    };
    let (mut outlooks, mut before) = (Outlooks::new(world, mesh), Vec::new());
    for level in 0..settings.max_level {
        let share = f64::from(level) / f64::from(settings.max_level);
        if observer.tell(Phase::Direct, share).is_break() {
            return;
        }
        candidates.retain(|&e| may_be_divided(mesh, e));
        let middles: Vec<Middle> = candidates.iter().map(|&e| mesh.middle(e)).collect();
        light(&outlooks, mesh, &candidates, observer);
        let judged: Vec<(ElementId, &Middle)> = candidates.iter().copied().zip(&middles).collect();
        let judge = |&(element, middle): &(ElementId, &Middle)| {
            divide((&outlooks, mesh), (&oracle, &lines), element, middle)
        };
        let verdicts: Vec<Option<Split>> = evaluate(world.light, &judged, judge, observer);
        if !mesh.has_room_for(verdicts.iter().flatten().count()) {
            return;
        }
        let mut divided = Vec::new();
        for ((&element, middle), verdict) in candidates.iter().zip(&middles).zip(verdicts) {
            if let Some(split) = verdict {
                let reason = oracle.reason((mesh, element), split, middle);
                mesh.split(element, split, reason);
                divided.push(element);
            }
        }
        outlooks.extend(mesh, &divided);
        outlooks.forget(&before);
        let parts = divided.iter().flat_map(|&element| mesh[element].children.iter().copied());
        before = std::mem::replace(&mut candidates, parts.collect());
    }
}

/// Discontinuity lines by patch, of those patches whose elements may be divided.
fn discontinuities(
    world: World<'_>,
    mesh: &Mesh,
    (oracle, candidates): (&Oracle, &[ElementId]),
    observer: &mut Observer<'_>,
) -> Vec<Vec<Discontinuity>> {
    let mut wanted: Vec<PatchId> = candidates.iter().map(|&element| mesh[element].patch).collect();
    wanted.sort_unstable();
    wanted.dedup();
    // Where there has been enough, nothing will be divided.
    let _ = observer.begin(Phase::Lines, 0.0..1.0);
    let found = observer.map(&wanted, Enough::clone, |enough, &patch| {
        let enough = || enough.is_said();
        refine::discontinuities((world.surfaces, mesh), patch, (world.light, oracle), enough)
    });
    let mut lines = vec![Vec::new(); mesh.patches.len()];
    for (patch, found) in wanted.into_iter().zip(found) {
        lines[patch.index()] = found;
    }
    lines
}

/// Black surfaces show no light, so nothing is gained by dividing them.
pub(super) fn reflects(mesh: &Mesh, element: ElementId) -> bool {
    mesh[mesh[element].patch].reflectance.max_element() > 0.0
}

/// How to divide an element, if at all: along a discontinuity line, or as the oracle says.
fn divide(
    (outlooks, mesh): (&Outlooks<'_>, &Mesh),
    (oracle, lines): (&Oracle, &[Vec<Discontinuity>]),
    element: ElementId,
    middle: &Middle,
) -> Option<Split> {
    let lines = &lines[mesh[element].patch.index()];
    let cut = cut((mesh, element), lines, oracle, outlooks.world.surfaces.tolerance);
    cut.or_else(|| judge((outlooks, mesh), oracle, element, middle))
}

fn judge(
    (outlooks, mesh): (&Outlooks<'_>, &Mesh),
    oracle: &Oracle,
    element: ElementId,
    middle: &Middle,
) -> Option<Split> {
    let patch = mesh[element].patch;
    let direct = |vertex: &Vertex| vertex.direct.unwrap_or_default().irradiance;
    let light = |vertex: &Vertex| mesh[patch].reflectance * direct(vertex);
    oracle.judge((mesh, element), middle, light, |allowed| {
        let outlook = outlooks.from(mesh, element);
        // Between the middles of small elements is nothing to be found where nothing stands before lamps; in crowds,
        // shadows there are as small as what makes them: they blur.
        let is_plain =
            outlooks.world.groups.holds(patch) || outlook.is_clear() || outlook.is_crowded();
        if is_plain && oracle.is_small(mesh, element) {
            return false;
        }
        let plane = &outlooks.world.surfaces.list[mesh.surface_of(element)].plane;
        let corners: Vec<(DVec2, Rgb)> =
            mesh[element].corners.iter().map(|&v| (mesh[v].position, direct(&mesh[v]))).collect();
        probes(&corners).into_iter().any(|(position, expected)| {
            let Direct { irradiance, .. } = outlook.at(plane.lift(position));
            strength(mesh[patch].reflectance * (irradiance - expected)) > allowed
        })
    })
}

/// Places inside a quadrilateral or triangle off its midlines, with interpolated values.
fn probes(corners: &[(DVec2, Rgb)]) -> Vec<(DVec2, Rgb)> {
    let at = |k: usize| (k as f64 + 0.5) / PROBES as f64;
    let grid = (0..PROBES).flat_map(|i| (0..PROBES).map(move |j| (at(i), at(j))));
    let blend = |weights: &[f64]| {
        let sum = |(p, l): (DVec2, Rgb), ((position, light), w): (&(DVec2, Rgb), &f64)| {
            (p + *position * *w, l + *light * *w)
        };
        corners.iter().zip(weights).fold((DVec2::ZERO, Rgb::ZERO), sum)
    };
    match corners.len() {
        3 => grid.filter(|(s, t)| s + t < 1.0).map(|(s, t)| blend(&[1.0 - s - t, s, t])).collect(),
        4 => grid
            .map(|(s, t)| blend(&[(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t]))
            .collect(),
        _ => Vec::new(),
    }
}
