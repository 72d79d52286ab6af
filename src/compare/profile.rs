//! Radiosity along a line across the edge of a shadow: what every mesh makes of it.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::Serialize;

use super::estimate::{LightEstimate, ROUNDS};
use super::locate::Locator;
use super::path_tracer::{PathTracer, Site};
use super::reference::{Point, Reference, Set};
use super::run::Lit;
use super::traced::is_open;
use crate::colour::luminance;
use crate::geometry::polygon::{Line, contains, edges};
use crate::surface::{Surface, SurfaceId, Surfaces};
use crate::watch::in_batches;

/// Places along the line.
const PLACES: usize = 65;

/// Length of the line, in widths of the penumbra.
const WIDTHS: f64 = 5.0;

/// Step along a penumbra, as a share of the extent.
const STEP: f64 = 1e-3;

/// Steps away from the middle at which a penumbra is taken for the whole surface.
const FARTHEST: usize = 150;

/// Surfaces below this share of the largest one's area have no profile.
const LARGE: f64 = 0.05;

/// Other random numbers than the reference's by default.
const PROFILE_SEED: u64 = 2;

/// Share of the work that is done once the line is found.
const FOUND: f64 = 0.5;

/// Lines that are cut to what is on their surface at a time.
const CUT_TOGETHER: usize = 16;

/// Step at which an edge must be smooth, as a share of the extent.
const SCALE: f64 = 2e-3;

/// The gradient may change by this factor when its step is halved; where it changes more, light jumps.
const SMOOTH: f64 = 1.5;

/// A straight line on a surface, across the edge of a shadow.
#[derive(Clone, Debug, Serialize)]
pub struct ShadowProfile {
    /// The surface, an index into [`Surfaces::list`].
    pub surface: SurfaceId,
    /// Its ends, m.
    pub ends: [[f64; 3]; 2],
    /// Width of the penumbra across which it runs, m.
    pub penumbra: f64,
    /// Where the places are, m from the first end.
    pub at: Vec<f64>,
    /// Luminance of the radiosity there, W/m²: direct light exactly, the rest by paths.
    pub reference: Vec<f64>,
    /// Standard errors of that, W/m².
    pub error: Vec<f64>,
}

/// What a mesh makes of a profile.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Trace {
    /// Luminance of the radiosity at the places, W/m²; `None` where there is no triangle.
    pub values: Vec<Option<f64>>,
    /// Where edges of leaves cross the line, m from its first end.
    pub ticks: Vec<f64>,
}

/// A place of a shadow, and which way it falls.
struct ShadowEdge {
    site: Site,
    /// Unit vector on the surface's plane, towards the light.
    direction: DVec2,
}

/// Where a shadow goes from light to dark.
#[derive(Clone, Copy)]
struct Penumbra {
    /// m.
    width: f64,
    /// How far its middle is from the edge's place along the edge's direction, m.
    centre: f64,
    /// Difference of the shares of the lamps that are seen.
    contrast: f64,
}

/// A place at which a line may cross a penumbra.
struct Crossing {
    edge: ShadowEdge,
    penumbra: Penumbra,
    /// What the line would be worth if it were not cut short, W/m².
    most_worth: f64,
}

/// A line across a penumbra.
struct Transect {
    site: Site,
    penumbra: Penumbra,
    /// Its ends on the plane of the site's surface, m.
    ends: [DVec2; 2],
    /// How much light goes along it, the more so the less it is cut short, W/m².
    worth: f64,
}

impl ShadowProfile {
    /// Across the smooth edge of a shadow on a large surface at which most light goes; `None` if there is none, or
    /// `observe`, told of the share done, breaks off.
    pub(super) fn find(
        tracer: &PathTracer<'_>,
        reference: &Reference,
        paths: usize,
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Option<Self> {
        let surfaces = tracer.surfaces;
        let Transect { site, penumbra, ends, .. } = best(tracer, reference, observe)?;
        let surface = &surfaces[site.surface];
        let length = ends[0].distance(ends[1]);
        let at: Vec<f64> = (0..PLACES).map(|k| length * k as f64 / (PLACES - 1) as f64).collect();
        let site_at = |&at: &f64| {
            let place = surface.plane.lift(ends[0].lerp(ends[1], at / length));
            Site { place, ..site }
        };
        let sites: Vec<Site> = at.iter().map(site_at).collect();
        let mut estimate = LightEstimate::new(tracer, sites, PROFILE_SEED);
        let paths = (paths / ROUNDS).max(1) as u32;
        estimate.lengthen(paths, || observe(FOUND)).continue_value()?;
        let found: Vec<[f64; 2]> =
            (0..PLACES).map(|k| estimate.radiosity(k).map(luminance)).collect();
        Some(Self {
            surface: site.surface,
            ends: ends.map(|end| surface.plane.lift(end).to_array()),
            penumbra: penumbra.width,
            at,
            reference: found.iter().map(|found| found[0]).collect(),
            error: found.iter().map(|found| found[1]).collect(),
        })
    }

    /// The line as a mesh has it.
    pub fn trace(&self, surfaces: &Surfaces, lit: &Lit) -> Trace {
        let Surface { plane, .. } = &surfaces[self.surface];
        let ends = self.ends.map(DVec3::from);
        let length = ends[0].distance(ends[1]);
        let locator = Locator::new(&lit.mesh, surfaces.extent);
        let value = |&at: &f64| {
            let place = ends[0].lerp(ends[1], at / length);
            locator.radiosity(place, plane.normal).map(luminance)
        };
        let line = Line::through(ends.map(|end| plane.flatten(end)));
        let start = plane.flatten(ends[0]);
        let along = (plane.flatten(ends[1]) - start).normalize_or_zero();
        let mesh = &lit.solution.mesh;
        let outlines = mesh.leaves().filter(|&leaf| mesh.surface_of(leaf) == self.surface);
        let mut ticks: Vec<f64> = outlines
            .flat_map(|leaf| edges(&mesh.outline(leaf)).collect::<Vec<_>>())
            .filter_map(|[a, b]| {
                let (from, to) = (line.side(a, 0.0), line.side(b, 0.0));
                (from * to <= 0.0 && from != to)
                    .then(|| (a.lerp(b, from / (from - to)) - start).dot(along))
            })
            .filter(|tick| (0.0..=length).contains(tick))
            .collect();
        ticks.sort_by(f64::total_cmp);
        ticks.dedup_by(|a, b| (*a - *b).abs() <= surfaces.epsilon * 10.0);
        Trace { values: self.at.iter().map(value).collect(), ticks }
    }
}

/// Of all lines across soft edges at the places of the shadow set, the one along which most light goes.
fn best(
    tracer: &PathTracer<'_>,
    reference: &Reference,
    observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Option<Transect> {
    let surfaces = tracer.surfaces;
    let largest = surfaces.list.iter().map(Surface::area).fold(0.0, f64::max);
    let shadow: Vec<_> = reference.points.iter().filter(|point| point.set == Set::Shadow).collect();
    let crossing = |(): &mut (), point: &&Point| {
        let surface = surface_at(surfaces, point.place, point.normal)?;
        let large = surfaces[surface].area() >= LARGE * largest;
        let site = Site { surface, place: point.place, normal: point.normal };
        large.then(|| crossing(tracer, &site)).flatten()
    };
    let found: Vec<Option<Crossing>> =
        in_batches(&shadow, |_| (), crossing, |done| observe(FOUND * done));
    if found.len() < shadow.len() {
        return None;
    }
    let mut crossings: Vec<Crossing> = found.into_iter().flatten().collect();
    crossings.sort_by(|a, b| b.most_worth.total_cmp(&a.most_worth));
    let better = |best: Transect, next: Transect| if next.worth > best.worth { next } else { best };
    let mut best: Option<Transect> = None;
    // To cut lines takes long, and only makes them worth less: those left cannot be better.
    for some in crossings.chunks(CUT_TOGETHER) {
        if best.as_ref().is_some_and(|best| some[0].most_worth <= best.worth) {
            break;
        }
        observe(FOUND).continue_value()?;
        let cut: Vec<Option<Transect>> =
            some.par_iter().map(|crossing| transect(tracer, crossing)).collect();
        best = best.into_iter().chain(cut.into_iter().flatten()).reduce(better);
    }
    best
}

/// The soft edge at a place, if there is one; where light jumps there is no penumbra.
fn crossing(tracer: &PathTracer<'_>, site: &Site) -> Option<Crossing> {
    let edge = edge(tracer, site, SCALE * tracer.surfaces.extent)?;
    let penumbra = penumbra(tracer, &edge)?;
    let all = luminance(tracer.direct(site).unoccluded);
    Some(Crossing { most_worth: penumbra.contrast * all, edge, penumbra })
}

/// The line across a soft edge.
fn transect(tracer: &PathTracer<'_>, crossing: &Crossing) -> Option<Transect> {
    let Crossing { edge, penumbra, most_worth } = crossing;
    let site = &edge.site;
    let middle = tracer.surfaces[site.surface].plane.flatten(site.place);
    let along = edge.direction * (WIDTHS * penumbra.width / 2.0);
    let ends = clipped(tracer, site, middle + edge.direction * penumbra.centre, along)?;
    let whole = ends[0].distance(ends[1]) / (2.0 * along.length());
    Some(Transect { site: *site, penumbra: *penumbra, ends, worth: most_worth * whole })
}

/// The surface that a place is on.
fn surface_at(surfaces: &Surfaces, place: DVec3, normal: DVec3) -> Option<SurfaceId> {
    let slack = 1e-4 * surfaces.extent;
    surfaces.ids().find(|&id| {
        let surface = &surfaces[id];
        surface.plane.normal.dot(normal) > 0.9
            && surface.plane.height(place).abs() <= slack
            && contains(&surface.rings, surface.plane.flatten(place))
    })
}

/// How shadow falls at a place, if smoothly.
fn edge(tracer: &PathTracer<'_>, site: &Site, step: f64) -> Option<ShadowEdge> {
    let whole = gradient(tracer, site, step)?;
    let half = gradient(tracer, site, step / 2.0)?;
    let steepness = whole.length();
    let smooth =
        steepness > 0.0 && (steepness / SMOOTH..=steepness * SMOOTH).contains(&half.length());
    smooth.then(|| ShadowEdge { site: *site, direction: whole.normalize_or_zero() })
}

/// Change of the visible share of lamps, times what they would send, on the plane of a place, W/m³.
fn gradient(tracer: &PathTracer<'_>, site: &Site, step: f64) -> Option<DVec2> {
    let surface = &tracer.surfaces[site.surface];
    let middle = surface.plane.flatten(site.place);
    let visible = |offset: DVec2| visible(tracer, site, middle + offset);
    let along = |axis: DVec2| Some((visible(axis * step)? - visible(-axis * step)?) / (2.0 * step));
    let all = tracer.direct(site).unoccluded.element_sum() / 3.0;
    Some(DVec2::new(along(DVec2::X)?, along(DVec2::Y)?) * all)
}

/// Share of the lamps that is seen from a place on a site's surface; `None` off the surface.
fn visible(tracer: &PathTracer<'_>, site: &Site, at: DVec2) -> Option<f64> {
    let surface = &tracer.surfaces[site.surface];
    let place = surface.plane.lift(at);
    contains(&surface.rings, at).then(|| tracer.direct(&Site { place, ..*site }).visible())
}

/// The penumbra that a place is in: from it both ways along the edge's direction, while light rises or falls.
fn penumbra(tracer: &PathTracer<'_>, edge: &ShadowEdge) -> Option<Penumbra> {
    let surface = &tracer.surfaces[edge.site.surface];
    let middle = surface.plane.flatten(edge.site.place);
    let step = STEP * tracer.surfaces.extent;
    let seen = |k: usize, sign: f64| {
        visible(tracer, &edge.site, middle + edge.direction * (sign * step * k as f64))
    };
    // How far, and what share of the lamps is seen there.
    let walk = |sign: f64| {
        let mut last = seen(0, sign).unwrap_or_default();
        for k in 1..FARTHEST {
            // Over at a border, or when the light turns or hardly changes any more.
            let next = seen(k, sign).filter(|next| (next - last) * sign >= 1e-4);
            let Some(next) = next else { return (step * k as f64, last) };
            last = next;
        }
        (step * FARTHEST as f64, last)
    };
    let ((up, most), (down, least)) = (walk(1.0), walk(-1.0));
    let penumbra = Penumbra { width: up + down, centre: (up - down) / 2.0, contrast: most - least };
    (penumbra.width > 0.0).then_some(penumbra)
}

/// The part of the line from `middle - along` to `middle + along` around its middle that is on a site's
/// surface, and not inside a solid.
fn clipped(
    tracer: &PathTracer<'_>,
    site: &Site,
    middle: DVec2,
    along: DVec2,
) -> Option<[DVec2; 2]> {
    let surface = &tracer.surfaces[site.surface];
    let reach = |direction: DVec2| {
        let inside = |share: f64| {
            let at = middle + direction * share;
            let site = Site { place: surface.plane.lift(at), ..*site };
            contains(&surface.rings, at) && is_open(tracer, &site)
        };
        let steps = (1..=256).map(|k| f64::from(k) / 256.0);
        steps.take_while(|&share| inside(share)).last()
    };
    let [low, high] = [-along, along].map(|way| reach(way).map(|share| middle + way * share));
    Some([low?, high?])
}
