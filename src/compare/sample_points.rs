//! Places all over the surfaces, and places where shadow falls steeply.

use std::collections::BTreeMap;

use fastrand::Rng;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::path_tracer::{PathTracer, R2, Site};
use super::sobol::mixed;
use crate::geometry::cut::{Cuts, convex_pieces};
use crate::surface::{SurfaceId, Surfaces};

/// Places among which those in steep shadow are looked for.
const CANDIDATES: usize = 60_000;

/// Neighbours farther away than this share of the extent tell nothing about a gradient.
pub(super) const REACH: f64 = 0.01;

/// Neighbours closer than this share of the reach count as at that distance.
const CLOSE: f64 = 0.2;

/// Neighbours that a gradient is made of.
const NEIGHBOURS: usize = 8;

/// Share of the candidates that are the steepest.
const STEEPEST: f64 = 0.1;

/// Gradients below this share of the largest are none.
const FLAT: f64 = 0.02;

/// A triangle of a surface whose light can be told.
struct SampleTriangle {
    surface: SurfaceId,
    corners: [DVec2; 3],
    area: f64,
}

/// A place and the area that it stands for, m².
#[derive(Clone, Copy, Debug)]
pub(super) struct SamplePoint {
    pub(super) site: Site,
    pub(super) area: f64,
}

/// About `count` places in proportion to area, one at least on each convex piece of a surface.
pub(super) fn area_sites(surfaces: &Surfaces, count: usize, seed: u64) -> Vec<SamplePoint> {
    spread(surfaces, &sample_triangles(surfaces), count, mixed(&[seed, 1]))
}

/// At most `count` places drawn from the tenth of many candidates at which the share of the lamps that is seen
/// changes most, weighed by what they would send if nothing stood between.
pub(super) fn shadow_sites(tracer: &PathTracer<'_>, count: usize, seed: u64) -> Vec<Site> {
    if count == 0 {
        return Vec::new();
    }
    let surfaces = tracer.surfaces;
    let placed = spread(surfaces, &sample_triangles(surfaces), CANDIDATES, mixed(&[seed, 2]));
    let sites: Vec<Site> = placed.iter().map(|placed| placed.site).collect();
    let steepness = steepness(tracer, &sites);
    let mut order: Vec<usize> = (0..sites.len()).filter(|&k| steepness[k] > 0.0).collect();
    order.sort_by(|&a, &b| steepness[b].total_cmp(&steepness[a]));
    let least = FLAT * order.first().map_or(0.0, |&first| steepness[first]);
    order.truncate((STEEPEST * sites.len() as f64) as usize);
    order.retain(|&k| steepness[k] > least);
    Rng::with_seed(mixed(&[seed, 3])).shuffle(&mut order);
    order.into_iter().take(count).map(|k| sites[k]).collect()
}

/// The surfaces that reflect and do not outshine that, in triangles.
fn sample_triangles(surfaces: &Surfaces) -> Vec<SampleTriangle> {
    let shown = surfaces.ids().map(|id| (id, &surfaces[id]));
    let shown = shown.filter(|(_, s)| s.reflects() && !s.is_emitter());
    let cuts = Cuts { segments: &[], size: f64::INFINITY, epsilon: surfaces.epsilon };
    let fan = |(surface, ring): (SurfaceId, Vec<DVec2>)| {
        (1..ring.len() - 1)
            .map(move |k| {
                let corners = [ring[0], ring[k], ring[k + 1]];
                let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]) / 2.0;
                SampleTriangle { surface, corners, area }
            })
            .collect::<Vec<SampleTriangle>>()
    };
    let pieces = shown.flat_map(|(number, surface)| {
        let pieces = convex_pieces(&surface.rings, &cuts).into_iter();
        pieces.map(move |piece| (number, piece.to_vec()))
    });
    pieces.flat_map(fan).filter(|triangle| triangle.area > 0.0).collect()
}

/// About `count` places on triangles, spread evenly over each.
fn spread(
    surfaces: &Surfaces,
    sample_triangles: &[SampleTriangle],
    count: usize,
    seed: u64,
) -> Vec<SamplePoint> {
    let total: f64 = sample_triangles.iter().map(|triangle| triangle.area).sum();
    let mut random = Rng::with_seed(seed);
    let (mut before, mut given) = (0.0, 0);
    let mut placed = Vec::new();
    for triangle in sample_triangles {
        before += triangle.area;
        let due = (before / total * count as f64 + 0.5) as usize;
        let own = (due - given).max(1);
        given = due;
        let shift = DVec2::new(random.f64(), random.f64());
        let [a, b, c] = triangle.corners;
        let plane = &surfaces[triangle.surface].plane;
        placed.extend((0..own).map(|k| {
            let mut at = (shift + R2 * k as f64).fract();
            if at.element_sum() > 1.0 {
                at = DVec2::ONE - at;
            }
            let place = plane.lift(a + (b - a) * at.x + (c - a) * at.y);
            let site = Site { surface: triangle.surface, place, normal: plane.normal };
            SamplePoint { site, area: triangle.area / own as f64 }
        }));
    }
    placed
}

/// At each site, how steeply the lamps' visible share changes towards its neighbours on the surface, 1/m, times
/// their unblocked irradiance, W/m².
fn steepness(tracer: &PathTracer<'_>, sites: &[Site]) -> Vec<f64> {
    let seen: Vec<(Option<f64>, f64)> = sites
        .par_iter()
        .map(|site| {
            let direct = tracer.direct(site);
            let all = direct.unoccluded.element_sum() / 3.0;
            ((all > 0.0).then(|| direct.visible()), all)
        })
        .collect();
    let reach = REACH * tracer.surfaces.extent;
    let near = PointGrid::new(sites.iter().map(|site| (site.place, site.surface.index())), reach);
    let slope = |number: usize| {
        let (visible, all) = (seen[number].0?, seen[number].1);
        let at = &sites[number];
        let mut around: Vec<(f64, usize)> = near
            .around(at.place, at.surface.index())
            .map(|other| (sites[other].place.distance(at.place), other))
            .filter(|&(distance, other)| distance <= reach && other != number)
            .collect();
        around.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        around.truncate(NEIGHBOURS);
        let change = |&(distance, other): &(f64, usize)| {
            seen[other].0.map_or(0.0, |other| (other - visible).abs() / distance.max(CLOSE * reach))
        };
        let sum: f64 = around.iter().map(change).sum();
        Some(all * sum / around.len().max(1) as f64)
    };
    (0..sites.len()).into_par_iter().map(|number| slope(number).unwrap_or(0.0)).collect()
}

/// Finds places of one kind near another.
pub(super) struct PointGrid {
    cells: BTreeMap<(usize, [i64; 3]), Vec<usize>>,
    cell: f64,
}

impl PointGrid {
    /// Of places and what kind they are; `reach` is how far one will look, m.
    pub(super) fn new(places: impl Iterator<Item = (DVec3, usize)>, reach: f64) -> Self {
        let cell = reach.max(f64::MIN_POSITIVE);
        let mut cells: BTreeMap<_, Vec<usize>> = BTreeMap::new();
        for (number, (place, kind)) in places.enumerate() {
            cells.entry((kind, cell_of(place, cell))).or_default().push(number);
        }
        Self { cells, cell }
    }

    /// At least all places of a kind within reach of another, by their numbers.
    pub(super) fn around(&self, place: DVec3, kind: usize) -> impl Iterator<Item = usize> + '_ {
        let [x, y, z] = cell_of(place, self.cell);
        let steps = || -1..=1_i64;
        let cells = steps().flat_map(move |i| {
            steps().flat_map(move |j| steps().map(move |k| (kind, [x + i, y + j, z + k])))
        });
        cells.filter_map(|cell| self.cells.get(&cell)).flatten().copied()
    }
}

fn cell_of(place: DVec3, cell: f64) -> [i64; 3] {
    (place / cell).floor().to_array().map(|x| x as i64)
}
