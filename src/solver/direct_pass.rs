//! Direct light at vertices, and the mesh refined until it can be interpolated.

use glam::DVec2;
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use smallvec::SmallVec;

use super::arrival::steep_means;
use super::context::Context;
use super::gather_points::neighbours;
use super::lit_mesh::LitMesh;
use super::observer::Observer;
use super::outlooks::Outlooks;
use super::solution::Phase;
use super::unfinished::make_do;
use crate::colour::{Rgb, strength};
use crate::direct::PatchLight;
use crate::light::{Direct, Optics, VertexLight};
use crate::mesh::{Element, ElementId, Mesh, Middle, PatchId, Split, VertexId};
use crate::refine::{Discontinuity, LineSearch, Oracle, Sample, cut, reason};
use crate::settings::Settings;
use crate::watch::Enough;

/// Probes along each axis of an element; together with edges and centre no gap is wider than a
/// quarter of a side.
const PROBES: usize = 4;

/// Evaluates direct light at all vertices that lack it; of these, those in the middle of `elements` and on their
/// borders by what stands before each element.
///
/// Vertices of facets that are in one group and at one place see the same share of it.
fn light(
    outlooks: &Outlooks<'_>,
    LitMesh { mesh, light }: &mut LitMesh<'_>,
    elements: &[ElementId],
    observer: &mut Observer<'_>,
) {
    let (mesh, context) = (&**mesh, outlooks.context);
    let (owned, others) = owners(context, mesh, light, elements);
    let sets = neighbours(mesh, context.groups, context.near, &others);
    let on_element = |(element, vertices): &(ElementId, SmallVec<[VertexId; 5]>)| {
        let outlook = outlooks.from(mesh, *element);
        vertices.iter().map(|&v| outlook.at(mesh[v].site)).collect::<SmallVec<[Direct; 1]>>()
    };
    let shine = |set: &SmallVec<_>| light_together(context.light, mesh, set);
    let mut lit = evaluate(context.light, &owned, on_element, observer);
    // Cut short, the second list would not begin where the first ends.
    if lit.len() == owned.len() {
        lit.extend(evaluate(context.light, &sets, shine, observer));
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
    let vertices = || (0..mesh.vertices.len() as u32).map(VertexId);
    let mut is_dark: Vec<bool> = vertices().map(|v| light.direct(v).is_none()).collect();
    let mut owned = Vec::new();
    for &element in elements.iter().filter(|&&e| !context.groups.holds(mesh[e].patch)) {
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
fn light_together(light: &PatchLight, mesh: &Mesh, vertices: &[VertexId]) -> SmallVec<[Direct; 1]> {
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
pub(super) fn light_leaves(
    context: Context<'_>,
    lit: &mut LitMesh<'_>,
    observer: &mut Observer<'_>,
) {
    // Facets are so small that their corners tell enough.
    let is_whole = |&leaf: &ElementId| !context.groups.holds(lit.mesh[leaf].patch);
    let leaves: Vec<ElementId> = lit.mesh.leaves().filter(is_whole).collect();
    for &leaf in &leaves {
        lit.mesh.middle(leaf);
    }
    light(&Outlooks::new(context, lit.mesh), lit, &leaves, observer);
    if observer.flow.is_break() {
        make_do(context.light, lit.mesh, lit.light);
    } else {
        lit.light.steep = steep_means(context, lit.mesh, lit.light, &leaves);
    }
}

/// Radiosity by direct light at a vertex of an element, W/m².
fn shown(optics: &Optics, light: &VertexLight, element: &Element) -> impl Fn(VertexId) -> Rgb {
    let reflectance = optics.of(element);
    move |v| reflectance * light.direct_irradiance(v)
}

/// What direct light is judged by.
struct DirectJudge<'a> {
    context: Context<'a>,
    oracle: Oracle,
    /// By patch.
    lines: Vec<Vec<Discontinuity>>,
}

/// Refines the mesh until direct light can be interpolated; leaves a uniform mesh as it is.
pub(super) fn refine(
    context: Context<'_>,
    settings: &Settings,
    lit: &mut LitMesh<'_>,
    observer: &mut Observer<'_>,
) {
    if observer.tell(Phase::Direct, 0.0).is_break() {
        return;
    }
    light(&Outlooks::new(context, lit.mesh), lit, &[], observer);
    if settings.uniform.is_some() || observer.flow.is_break() {
        return;
    }
    let oracle = Oracle::of_direct_light(
        settings,
        context.surfaces.extent,
        lit.mesh,
        context.optics,
        lit.light,
    );
    let mut judge =
        DirectJudge { context, oracle, lines: vec![Vec::new(); lit.mesh.patches.len()] };
    let mut candidates: Vec<ElementId> =
        lit.mesh.leaves().filter(|&e| judge.may_divide(lit.mesh, lit.light, e)).collect();
    if settings.discontinuity_lines && settings.max_level > 0 {
        judge.find_lines(lit.mesh, &candidates, observer);
    }
    let (mut outlooks, mut before) = (Outlooks::new(context, lit.mesh), Vec::new());
    for level in 0..settings.max_level {
        let share = f64::from(level) / f64::from(settings.max_level);
        if observer.tell(Phase::Direct, share).is_break() {
            return;
        }
        candidates.retain(|&e| judge.may_divide(lit.mesh, lit.light, e));
        let middles: Vec<Middle> = candidates.iter().map(|&e| lit.mesh.middle(e)).collect();
        light(&outlooks, lit, &candidates, observer);
        let judged: Vec<(ElementId, &Middle)> = candidates.iter().copied().zip(&middles).collect();
        let LitMesh { mesh, light } = &mut *lit;
        let round = LevelJudge { judge: &judge, outlooks: &outlooks, mesh, light };
        let verdict = |&(element, middle): &(ElementId, &Middle)| round.divide(element, middle);
        let verdicts: Vec<Option<Split>> = evaluate(context.light, &judged, verdict, observer);
        if !mesh.has_room_for(verdicts.iter().flatten().count()) {
            return;
        }
        let mut divided = Vec::new();
        for ((&element, middle), verdict) in candidates.iter().zip(&middles).zip(verdicts) {
            if let Some(split) = verdict {
                let reason = reason(mesh, light, element, split, middle);
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

impl DirectJudge<'_> {
    fn may_divide(&self, mesh: &Mesh, light: &VertexLight, element: ElementId) -> bool {
        self.oracle.may_divide(mesh, element)
            && self.context.optics.reflects(mesh[element].patch)
            && !self.is_even_facet(mesh, light, element)
    }

    /// True for small facets that are lit evenly, as their neighbours will be: no shadow edge is looked for that
    /// would be hardly longer than the shortest side.
    fn is_even_facet(&self, mesh: &Mesh, light: &VertexLight, element: ElementId) -> bool {
        let sample =
            || Sample::new(mesh, element, shown(self.context.optics, light, &mesh[element]));
        self.context.groups.holds(mesh[element].patch)
            && self.oracle.is_small(mesh, element)
            && self.oracle.is_even(&sample())
    }

    /// Finds the discontinuity lines of those patches whose elements may be divided.
    fn find_lines(&mut self, mesh: &Mesh, candidates: &[ElementId], observer: &mut Observer<'_>) {
        let mut wanted: Vec<PatchId> =
            candidates.iter().map(|&element| mesh[element].patch).collect();
        wanted.sort_unstable();
        wanted.dedup();
        // Where there has been enough, nothing will be divided.
        let _ = observer.begin(Phase::Lines, 0.0..1.0);
        let Context { optics, light, .. } = self.context;
        let search = LineSearch { mesh, optics, light, oracle: &self.oracle };
        let found = observer
            .map(&wanted, Enough::clone, |enough, &patch| search.on(patch, || enough.is_said()));
        for (patch, found) in wanted.into_iter().zip(found) {
            self.lines[patch.index()] = found;
        }
    }
}

/// A level of elements and what is known about them.
struct LevelJudge<'r, 'a> {
    judge: &'r DirectJudge<'a>,
    outlooks: &'r Outlooks<'a>,
    mesh: &'r Mesh,
    light: &'r VertexLight,
}

impl LevelJudge<'_, '_> {
    /// How to divide an element, if at all: along a discontinuity line, or as the oracle says.
    fn divide(&self, element: ElementId, middle: &Middle) -> Option<Split> {
        let Self { judge: DirectJudge { context, oracle, lines }, mesh, light, .. } = self;
        let shown = shown(context.optics, light, &mesh[element]);
        let sample = Sample::new(mesh, element, &shown);
        let lines = &lines[mesh[element].patch.index()];
        let along_line = if lines.is_empty() {
            None
        } else {
            cut(&mesh.outline(element), lines, oracle.allowed(&sample), mesh.tolerance())
        };
        let is_off = |allowed| self.is_off(element, allowed);
        along_line.or_else(|| oracle.judge(&sample, middle, &shown, is_off))
    }

    /// True if light somewhere inside an element is off by more than is allowed, W/m².
    fn is_off(&self, element: ElementId, allowed: f64) -> bool {
        let Self { judge: DirectJudge { context, oracle, .. }, outlooks, mesh, light } = self;
        let patch = mesh[element].patch;
        let outlook = outlooks.from(mesh, element);
        // Between the middles of small elements is nothing to be found where nothing stands before lamps; in crowds,
        // shadows there are as small as what makes them: they blur.
        let is_plain = context.groups.holds(patch) || outlook.is_clear() || outlook.is_crowded();
        if is_plain && oracle.is_small(mesh, element) {
            return false;
        }
        let (plane, reflectance) = (mesh.plane(patch), context.optics.reflectance[patch.index()]);
        let corners = mesh[element].corners.iter();
        let corners: Vec<Probe> = corners
            .map(|&v| Probe { position: mesh[v].position, irradiance: light.direct_irradiance(v) })
            .collect();
        probes(&corners).into_iter().any(|probe| {
            let Direct { irradiance, .. } = outlook.at(plane.lift(probe.position));
            strength(reflectance * (irradiance - probe.irradiance)) > allowed
        })
    }
}

/// A place on an element, and the irradiance there, W/m².
#[derive(Clone, Copy, Default)]
struct Probe {
    position: DVec2,
    irradiance: Rgb,
}

/// Places inside a quadrilateral or triangle off its midlines, with interpolated values.
fn probes(corners: &[Probe]) -> Vec<Probe> {
    let at = |k: usize| (k as f64 + 0.5) / PROBES as f64;
    let grid = (0..PROBES).flat_map(|i| (0..PROBES).map(move |j| (at(i), at(j))));
    let blend = |weights: &[f64]| {
        let sum = |sum: Probe, (corner, weight): (&Probe, &f64)| Probe {
            position: sum.position + corner.position * *weight,
            irradiance: sum.irradiance + corner.irradiance * *weight,
        };
        corners.iter().zip(weights).fold(Probe::default(), sum)
    };
    match corners.len() {
        3 => grid.filter(|(s, t)| s + t < 1.0).map(|(s, t)| blend(&[1.0 - s - t, s, t])).collect(),
        4 => grid
            .map(|(s, t)| blend(&[(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t]))
            .collect(),
        _ => Vec::new(),
    }
}
