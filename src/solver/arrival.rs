//! The direct light that arrives on patches and on leaves where their vertices cannot tell.
//!
//! Black patches are never divided, however unevenly they are lit; and light may fall off over less than the smallest
//! element, as beside an emitter that all but touches a ceiling. The books, and all that is reflected, need the right
//! mean.

use std::collections::BTreeMap;

use glam::DVec3;
use rayon::prelude::*;
use smallvec::SmallVec;

use super::context::Context;
use super::sources::{HOT, capped_power, quarters};
use crate::colour::{Rgb, strength};
use crate::direct::{Evaluated, PotentialEmitters, WorkCounters};
use crate::geometry::area_vector;
use crate::light::{ElementLight, VertexLight, mean};
use crate::mesh::{ElementId, Mesh, PatchId, VertexId};

/// A patch with an emitter nearer than this many of its sizes is lit unevenly.
const NEAR: f64 = 2.0;

/// As are those whose corners and middles differ by more than this share of the most.
const UNEVEN: f64 = 0.1;

/// Uneven parts are divided so often at least, so that no narrow beam is missed, and so often at most.
const LEVELS: [u32; 2] = [4, 9];

/// Parts are divided until their power changes by less than this share of all that arrives.
pub(super) const ERROR: f64 = 2e-5;

/// The least share of all that arrives that counts.
const LEAST: f64 = 0.1;

/// Direct light on each patch, W; right to within an `error` in each part that it takes to find it, W.
pub(super) fn arrival(
    context: Context<'_>,
    mesh: &Mesh,
    vertices: &VertexLight,
    light: &ElementLight,
    error: f64,
) -> (Vec<Rgb>, WorkCounters) {
    let numbers: Vec<PatchId> = mesh.patch_ids().collect();
    let on = |&patch: &PatchId| {
        let whole = &mesh[patch];
        let known = light.direct[whole.root.index()] * whole.area;
        let potential = context.light.on(patch);
        let is_even = || {
            let matters = strength(known) > error && is_uneven(mesh, vertices, patch);
            !matters && (error.is_infinite() || !potential.is_near(mesh, NEAR * whole.area.sqrt()))
        };
        if context.optics.reflects(patch) || context.clusters.holds(patch) || is_even() {
            return (known, WorkCounters::default());
        }
        PatchPart::new(whole.corners.iter().copied(), &potential).integral(error)
    };
    let (arriving, work): (Vec<Rgb>, Vec<WorkCounters>) = numbers.par_iter().map(on).unzip();
    (arriving, work.into_iter().sum())
}

/// Mean direct irradiance, W/m², of those of the leaves on which it is so steep that vertices misjudge it.
pub(super) fn steep_means(
    context: Context<'_>,
    mesh: &Mesh,
    vertices: &VertexLight,
    leaves: &[ElementId],
) -> (BTreeMap<ElementId, Rgb>, WorkCounters) {
    let error = ERROR * counting_power(mesh, vertices, leaves);
    let mean = |&leaf: &ElementId| {
        let element = &mesh[leaf];
        if !context.optics.reflects(element.patch)
            || doubt(mesh, vertices, leaf) * element.area <= error
        {
            return None;
        }
        let plane = mesh.plane(element.patch);
        let corners = element.corners.iter().map(|&v| plane.lift(mesh[v].position));
        let potential = context.light.on(element.patch);
        let (power, work) = PatchPart::new(corners, &potential).integral(error);
        Some(((leaf, power / element.area), work))
    };
    let found: Vec<_> = leaves.par_iter().filter_map(mean).collect();
    let (means, work): (BTreeMap<_, _>, Vec<WorkCounters>) = found.into_iter().unzip();
    (means, work.into_iter().sum())
}

/// What arrives on leaves, W, without most of what is shut in: of an emitter that faces a ceiling closely, what lights
/// the room is hardly more than an error of that.
fn counting_power(mesh: &Mesh, vertices: &VertexLight, leaves: &[ElementId]) -> f64 {
    let area: f64 = leaves.iter().map(|&leaf| mesh[leaf].area).sum();
    let capped = |most: f64| {
        let light = |leaf| vertices.mean_direct(mesh, leaf);
        capped_power(mesh, leaves.iter().copied(), most, light)
    };
    let all = capped(f64::INFINITY);
    capped(HOT * all / area.max(f64::MIN_POSITIVE)).max(LEAST * all)
}

/// By how much the mean over a leaf by Simpson's rule differs from that by trapezia, W/m².
fn doubt(mesh: &Mesh, light: &VertexLight, leaf: ElementId) -> f64 {
    let Some(middle) = mesh.find_middle(leaf) else { return 0.0 };
    let at = |v: VertexId| light.direct_irradiance(v);
    let level = |of: &[VertexId]| of.iter().map(|&v| at(v)).sum::<Rgb>() / of.len() as f64;
    let [corners, edges] = [&mesh[leaf].corners[..], &middle.edges[..]].map(level);
    let trapezia = if mesh[leaf].corners.len() == 4 {
        (corners + 2.0 * edges + at(middle.centre)) / 4.0
    } else {
        (corners + 3.0 * edges) / 4.0
    };
    strength(mean(mesh, leaf, at) - trapezia)
}

/// True if the light that is known on a patch varies.
fn is_uneven(mesh: &Mesh, light: &VertexLight, patch: PatchId) -> bool {
    let root = mesh[patch].root;
    let middle = mesh.find_middle(root);
    let middle = middle.iter().flat_map(|middle| middle.edges.iter().chain([&middle.centre]));
    let lit = mesh[root].corners.iter().chain(middle).filter_map(|&v| light.direct(v));
    let strengths: SmallVec<[f64; 16]> = lit.map(|direct| strength(direct.irradiance)).collect();
    let most = strengths.iter().copied().fold(0.0, f64::max);
    strengths.iter().any(|&here| here < (1.0 - UNEVEN) * most)
}

/// A convex part of a patch, and what arrives in its middle for all of it.
struct PatchPart<'a> {
    corners: SmallVec<[DVec3; 4]>,
    potential: &'a PotentialEmitters<'a>,
    /// W.
    power: Rgb,
    work: WorkCounters,
}

impl<'a> PatchPart<'a> {
    fn new(corners: impl Iterator<Item = DVec3>, potential: &'a PotentialEmitters<'a>) -> Self {
        let corners: SmallVec<[DVec3; 4]> = corners.collect();
        let Evaluated { light, work } = potential.at(centre(&corners));
        let power = light.irradiance * area_vector(&corners).length();
        Self { corners, potential, power, work }
    }

    /// What arrives on it, W, right to about the `error` given, and what it took.
    fn integral(&self, error: f64) -> (Rgb, WorkCounters) {
        let mut work = self.work;
        let power = self.refined(error, 0, &mut work);
        (power, work)
    }

    fn refined(&self, error: f64, level: u32, work: &mut WorkCounters) -> Rgb {
        let quarters = quarters(&self.corners, centre(&self.corners), DVec3::midpoint);
        let parts: SmallVec<[Self; 4]> =
            quarters.map(|corners| Self::new(corners.into_iter(), self.potential)).collect();
        *work += parts.iter().map(|part| part.work).sum();
        let sum: Rgb = parts.iter().map(|part| part.power).sum();
        let [least, most] = LEVELS;
        if level >= most || level >= least && strength(sum - self.power) <= error {
            return sum;
        }
        parts.iter().map(|part| part.refined(error, level + 1, work)).sum()
    }
}

fn centre(corners: &[DVec3]) -> DVec3 {
    corners.iter().sum::<DVec3>() / corners.len() as f64
}
