//! Radiosity at fixed places that no mesh has had a part in, and how sure it is.

use std::path::PathBuf;

use glam::DVec3;
use serde::Serialize;

use super::sample_points::{PointGrid, REACH};
use crate::colour::Rgb;

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
