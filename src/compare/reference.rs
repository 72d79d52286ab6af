//! Radiosity at fixed places that no mesh has had a part in, and how sure it is.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

use super::estimate::{Effort, LightEstimate, ROUNDS};
use super::path_tracer::{PathTracer, Site};
use super::sample_points::{PointGrid, REACH, area_sites, shadow_sites};
use crate::colour::Rgb;
use crate::error::{Error, Result};
use crate::geometry::polygon::contains;
use crate::surface::{Surface, Surfaces};

/// A place sees the inside of a solid if more than this share of what it sees is the backs of surfaces.
const BURIED: f64 = 0.6;

/// Paths that look whether a place is inside a solid.
const LOOKS: u32 = 256;

/// What is said of a scene in which there is nothing to compare.
const NOTHING: &str =
    "no surface reflects light without emitting some: there is nothing to compare";

/// Which of the two sets a place belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Set {
    /// All over the surfaces: the weighted mean is a mean over area.
    Area,
    /// Where shadow falls steeply; all count the same.
    Shadow,
}

/// What leaves a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The place, m.
    pub place: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    /// Radiosity B, W/m².
    pub radiosity: Rgb,
    /// Its standard error, W/m²; zero where it is exact.
    pub error: Rgb,
    /// The set it belongs to.
    pub set: Set,
    /// The area it stands for, up to a factor common to all; 1 in the shadow set.
    pub weight: f64,
}

/// Where a reference comes from.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// Direct light exactly, the rest by paths.
    Traced {
        /// Independent rounds.
        rounds: usize,
        /// Paths from each place, all rounds together.
        paths: usize,
        /// Time it took.
        seconds: f64,
    },
    /// A file.
    File(PathBuf),
}

/// Radiosity at fixed places, independent of any mesh.
///
/// Left out are places on emitters and on black surfaces, and those inside solids: where more than 60 % of
/// what is seen are backs of surfaces, another surface lies on top, or all is dark and closed.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The places, those of the area set first.
    pub points: Vec<Point>,
    /// By point: true in the shadow band, which is the shadow set and what of the area set is within a hundredth
    /// of the scene's extent of it.
    pub in_band: Vec<bool>,
    /// Where it comes from.
    pub origin: Origin,
}

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
        let start = Instant::now();
        let tracer = PathTracer::new(surfaces);
        let (sites, weights) = places(&tracer, effort);
        let mut estimate = LightEstimate::new(&tracer, &sites, effort.seed);
        estimate.run(effort, observe);
        if estimate.paths == 0 {
            return Err(Error::Scene("stopped before there was a reference".to_owned()));
        }
        let points: Vec<Point> = (0..sites.len())
            .filter(|&k| !estimate.is_dark(k))
            .map(|k| {
                let [radiosity, error] = estimate.radiosity(k);
                let Site { place, normal, .. } = sites[k];
                let (set, weight) = weights[k];
                Point { place, normal, radiosity, error, set, weight }
            })
            .collect();
        let (rounds, seconds) = (ROUNDS, start.elapsed().as_secs_f64());
        let paths = rounds * estimate.paths as usize;
        Self::new(points, Origin::Traced { rounds, paths, seconds }, surfaces.extent)
            .ok_or_else(|| Error::Scene(NOTHING.to_owned()))
    }

    /// A reference of these points in a scene of this extent, m; `None` without a lit place in the area set.
    pub fn new(mut points: Vec<Point>, origin: Origin, extent: f64) -> Option<Self> {
        points.sort_by_key(|point| point.set == Set::Shadow);
        let lit = |point: &Point| point.set == Set::Area && point.radiosity.element_sum() > 0.0;
        if !points.iter().any(lit) {
            return None;
        }
        let in_band = band(&points, REACH * extent);
        Some(Self { points, in_band, origin })
    }

    /// Number of places of a set.
    pub fn count(&self, set: Set) -> usize {
        self.points.iter().filter(|point| point.set == set).count()
    }

    /// Root mean square of the standard errors over the mean radiosity of a set; zero for one without points.
    pub fn noise(&self, set: Set) -> f64 {
        let chosen = || self.points.iter().filter(|point| point.set == set);
        let weight: f64 = chosen().map(|p| p.weight).sum();
        let square: f64 = chosen().map(|p| p.weight * p.error.length_squared() / 3.0).sum();
        let light: f64 = chosen().map(|p| p.weight * p.radiosity.element_sum() / 3.0).sum();
        if light > 0.0 { (square / weight).sqrt() / (light / weight) } else { 0.0 }
    }
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
    let own = &surfaces.list[site.surface];
    // The other side of a double-sided polygon is in the same place, back to back.
    let is_partner = |number: usize, other: &Surface| {
        own.two_sided
            && other.two_sided
            && own.is_back != other.is_back
            && number == if own.is_back { site.surface - 1 } else { site.surface + 1 }
    };
    surfaces.list.iter().enumerate().any(|(number, other)| {
        other.plane.normal.dot(site.normal) < -0.999
            && other.plane.height(site.place).abs() <= 5.0 * surfaces.epsilon
            && !is_partner(number, other)
            && contains(&other.rings, other.plane.flatten(site.place))
    })
}

/// Which points are of the shadow set or, facing the same way, near one that is.
fn band(points: &[Point], reach: f64) -> Vec<bool> {
    let shadow: Vec<&Point> = points.iter().filter(|point| point.set == Set::Shadow).collect();
    let near = PointGrid::new(shadow.iter().map(|point| (point.place, 0)), reach);
    let in_band = |point: &Point| {
        point.set == Set::Shadow
            || near.around(point.place, 0).any(|k| {
                let other = shadow[k];
                other.normal.dot(point.normal) > 0.9 && other.place.distance(point.place) <= reach
            })
    };
    points.iter().map(in_band).collect()
}
