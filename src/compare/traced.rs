//! References found by paths, the more exact the longer they are traced.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::estimate::{Effort, LightEstimate, ROUNDS};
use super::path_tracer::{PathTracer, Site};
use super::reference::{Origin, Point, Reference, Set};
use super::sample_points::{area_sites, shadow_sites};
use crate::error::{Error, Result};
use crate::geometry::polygon::contains;
use crate::surface::Surfaces;

/// A place sees the inside of a solid if more than this share of what it sees is the backs of surfaces.
const BURIED: f64 = 0.6;

/// Paths that look whether a place is inside a solid.
const LOOKS: u32 = 256;

/// Noise that is good enough where there are no runs whose errors would tell.
const NOISE: f64 = 0.002;

/// What is said of a scene in which there is nothing to compare.
const NOTHING: &str =
    "no surface reflects light without emitting some: there is nothing to compare";

impl Reference {
    /// Direct light exactly, reflected light by paths, at places drawn from the scene; `observe` is told how
    /// much is done, 0..=1, and may break off: then what has been found so far will do, if there is any.
    ///
    /// B = E + ρ (direct + indirect); indirect = the mean, over directions as many as their cosine, of what
    /// leaves by reflection the places that they meet. The error is that of the mean of the rounds. Where direct
    /// light has too much in its way to be exact, its own small error is not part of it.
    ///
    /// # Errors
    /// When no place of the scene reflects light, or it is broken off before anything has been found.
    pub fn trace(
        surfaces: &Surfaces,
        effort: &Effort,
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Self> {
        let tracer = PathTracer::new(surfaces);
        let effort = Effort { noise: effort.noise.or(Some(NOISE)), ..*effort };
        let mut traced = TracedReference::begin(&tracer, &effort, observe)?;
        traced.sharpen(&mut |_| 0.0, observe);
        Ok(traced.reference)
    }
}

/// A reference on its way: it can be made more exact at the same places.
#[derive(Debug)]
pub(super) struct TracedReference<'a> {
    estimate: LightEstimate<'a>,
    /// By place: its set, and the area that it stands for.
    kinds: Vec<(Set, f64)>,
    effort: Effort,
    spent: Duration,
    /// As it is by now.
    pub(super) reference: Reference,
}

impl<'a> TracedReference<'a> {
    /// The first few paths from every place.
    ///
    /// # Errors
    /// When no place of the scene reflects light, or `observe` breaks off.
    pub(super) fn begin(
        tracer: &'a PathTracer<'a>,
        effort: &Effort,
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Self> {
        let start = Instant::now();
        let (sites, mut kinds) = places(tracer, effort);
        let mut estimate = LightEstimate::new(tracer, sites, effort.seed);
        if estimate.begin(observe).is_break() {
            return Err(Error::Scene("stopped before there was a reference".to_owned()));
        }
        estimate.leave_out_dark(&mut kinds);
        let spent = start.elapsed();
        let reference = reference_of(&estimate, &kinds, spent)
            .ok_or_else(|| Error::Scene(NOTHING.to_owned()))?;
        Ok(Self { estimate, kinds, effort: *effort, spent, reference })
    }

    /// Follows more paths until the noise is as small as the effort asks for or, if it does not, `share_done` of a
    /// reference is 1; until its time is over, or `observe` breaks off.
    pub(super) fn sharpen(
        &mut self,
        share_done: &mut dyn FnMut(&Reference) -> f64,
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) {
        let Self { estimate, kinds, effort, spent, reference } = self;
        let (start, before) = (Instant::now(), *spent);
        let mut told = |estimate: &LightEstimate<'_>| {
            *spent = before + start.elapsed();
            if let Some(better) = reference_of(estimate, kinds, *spent) {
                *reference = better;
            }
            let by_time = spent.as_secs_f64() / effort.budget.as_secs_f64().max(1e-9);
            // Errors fall as one over the square root of the number of paths.
            let by_noise = |noise: f64| (noise / estimate.noise().max(f64::MIN_POSITIVE)).powi(2);
            by_time.max(effort.noise.map_or_else(|| share_done(reference), by_noise))
        };
        estimate.run(&mut told, observe);
    }
}

/// What an estimate of places of these kinds says; `None` without a lit place on a surface.
fn reference_of(
    estimate: &LightEstimate<'_>,
    kinds: &[(Set, f64)],
    spent: Duration,
) -> Option<Reference> {
    let point = |(k, (&Site { place, normal, .. }, &(set, weight)))| {
        let [radiosity, error] = estimate.radiosity(k);
        Point { place, normal, radiosity, error, set, weight }
    };
    let points = estimate.sites.iter().zip(kinds).enumerate().map(point).collect();
    let (rounds, paths) = (ROUNDS, ROUNDS * estimate.paths as usize);
    let origin = Origin::Traced { rounds, paths, seconds: spent.as_secs_f64() };
    Reference::new(points, origin, estimate.extent())
}

/// The places of both sets that are not inside solids, with their sets and weights.
fn places(tracer: &PathTracer<'_>, effort: &Effort) -> (Vec<Site>, Vec<(Set, f64)>) {
    let area = area_sites(tracer.surfaces, effort.area_points, effort.seed).into_iter();
    let shadow = shadow_sites(tracer, effort.shadow_points, effort.seed).into_iter();
    let area = area.map(|placed| (placed.site, (Set::Area, placed.area)));
    let all: Vec<_> = area.chain(shadow.map(|site| (site, (Set::Shadow, 1.0)))).collect();
    all.into_par_iter().filter(|(site, _)| is_open(tracer, site)).unzip()
}

/// True if a site is not inside a solid.
pub(super) fn is_open(tracer: &PathTracer<'_>, site: &Site) -> bool {
    !is_covered(tracer.surfaces, site) && tracer.backs(site, LOOKS) <= BURIED
}

/// True where another surface lies face to face on a site's own, as the bottom of a box that stands on a floor.
fn is_covered(surfaces: &Surfaces, site: &Site) -> bool {
    // The other side of a double-sided polygon is in the same place, back to back.
    let others = surfaces.ids().filter(|&id| surfaces.other_side(id) != Some(site.surface));
    others.map(|id| &surfaces[id]).any(|other| {
        other.plane.normal.dot(site.normal) < -0.999
            && other.plane.height(site.place).abs() <= 5.0 * surfaces.epsilon
            && contains(&other.rings, other.plane.flatten(site.place))
    })
}
