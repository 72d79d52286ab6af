//! Light straight from emitters: exact where a light is a polygon, by rays where it is a point.
//!
//! It carries the hard edges, so it is never carried by the hemicube.

mod glimpse;
mod lines;
mod outlook;
mod punctual;
mod rims;
mod rough;
mod sky;
mod tally;

use std::borrow::Cow;

use glam::DVec3;

use crate::colour::Rgb;
use crate::form_factor::contour::{point_to_polygon, point_to_polygon_above};
use crate::mesh::{Direct, Mesh};
use crate::scene::{Light, NamedLight};
use crate::surface::Surfaces;
use crate::surface::cut::{Cuts, convex_pieces};
use crate::visibility::{Facet, HalfSpace, Occluders, Pieces, Polygon};

pub use lines::Line;
pub use outlook::PatchLight;
use punctual::Source;
use tally::Tally;

/// All emitters of a scene.
#[derive(Clone, Debug)]
pub struct Lamps {
    areas: Vec<AreaLamp>,
    points: Vec<Light>,
    /// Rows of cells to each triangle of a light that is always sampled.
    rows: Option<u32>,
    tally: Tally,
}

/// A convex polygon that emits from its front.
#[derive(Clone, Debug)]
struct AreaLamp {
    corners: Polygon,
    front: HalfSpace,
    /// W/m²; of skies, at the zenith.
    exitance: Rgb,
    glow: Glow,
}

/// How a lamp's radiance depends on the direction from which it comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Glow {
    /// Not at all, from a surface.
    Surface,
    /// Not at all, from the sky.
    Even,
    /// As that of an overcast sky.
    Overcast,
}

impl Glow {
    /// Irradiance of a place with unit normal by a polygon above its horizon, as a share of the exitance.
    fn weight(self, receiver: (DVec3, DVec3), polygon: &[DVec3]) -> f64 {
        let factor = point_to_polygon_above(receiver.0, receiver.1, polygon);
        match self {
            Self::Surface | Self::Even => factor,
            Self::Overcast => sky::overcast(receiver, polygon, factor),
        }
    }

    /// Radiance along a unit direction towards the lamp, as a share of the largest.
    fn radiance(self, direction: DVec3) -> f64 {
        match self {
            Self::Surface | Self::Even => 1.0,
            Self::Overcast => sky::overcast_radiance(direction),
        }
    }

    fn is_sky(self) -> bool {
        self != Self::Surface
    }
}

impl Lamps {
    /// The emitting surfaces, in convex pieces, and the lights of a scene.
    pub fn new(surfaces: &Surfaces, mesh: &Mesh) -> Self {
        let mut areas = Vec::new();
        for (number, surface) in surfaces.list.iter().enumerate().filter(|(_, s)| s.is_emitter()) {
            // A hair before the surface, so that rounding lets no place on it be lit by what it lies on.
            let normal = surface.plane.normal;
            let front = HalfSpace::new(surface.plane.origin + normal * surfaces.tolerance, normal);
            let textured = surfaces.materials[surface.material as usize].emission_texture.is_some();
            if textured {
                let patches = mesh.patches.iter().filter(|p| p.surface == number as u32);
                areas.extend(patches.map(|patch| AreaLamp {
                    corners: patch.corners.iter().copied().collect(),
                    front,
                    exitance: patch.exitance,
                    glow: Glow::Surface,
                }));
            } else {
                let cuts =
                    Cuts { segments: &[], size: f64::INFINITY, tolerance: surfaces.tolerance };
                areas.extend(convex_pieces(&surface.rings, &cuts).iter().map(|piece| AreaLamp {
                    corners: piece.iter().map(|&p| surface.plane.lift(p)).collect(),
                    front,
                    exitance: surface.exitance,
                    glow: Glow::Surface,
                }));
            }
        }
        let mut points = Vec::new();
        for NamedLight { light, .. } in &surfaces.lights {
            match *light {
                Light::Sky { sky, irradiance } => {
                    areas.extend(sky::lamps(surfaces, sky, irradiance));
                }
                Light::Sun { direction, irradiance } => {
                    areas.extend(sky::sun(surfaces, direction, irradiance));
                }
                _ => points.push(light.clone()),
            }
        }
        areas.retain(|lamp| lamp.exitance.max_element() > 0.0);
        Self { areas, points, rows: None, tally: Tally::default() }
    }

    /// With [`Settings::shadow_rays`](crate::settings::Settings::shadow_rays): what hides a polygon is found by about
    /// that many rays to each of its triangles, one through each of equal cells, instead of exactly.
    #[must_use]
    pub fn seen_by(self, rays: Option<u32>) -> Self {
        let rows = rays.map(|rays| f64::from(rays).sqrt().round().max(1.0) as u32);
        Self { rows, ..self }
    }

    /// True if there is no light at all.
    pub fn is_empty(&self) -> bool {
        self.areas.is_empty() && self.points.is_empty()
    }

    /// How often light has been evaluated so far: pairs of a place and a lamp, or convex piece of one, that
    /// shines there unless something hides it.
    pub fn evaluations(&self) -> u64 {
        self.tally.evaluations()
    }

    /// Shadow rays so far: to lights that are points, and to others where exact cutting has given up.
    pub fn rays(&self) -> u64 {
        self.tally.rays()
    }

    /// Evaluations and rays so far.
    pub(crate) fn counts(&self) -> [u64; 2] {
        [self.evaluations(), self.rays()]
    }

    /// Counts on from these.
    pub(crate) fn count_from(&self, [evaluations, rays]: [u64; 2]) {
        self.tally.set(evaluations, rays);
    }

    /// What arrives at a place with unit `normal`.
    pub fn shine(&self, occluders: &Occluders, place: DVec3, normal: DVec3) -> Direct {
        let shine = |lamp: &AreaLamp| lamp.shine((occluders, None), (place, normal), self.rows);
        self.sum(self.areas.iter().filter_map(shine)) + self.points_shine(occluders, place, normal)
    }

    /// All that arrives, counted.
    fn sum(&self, arriving: impl Iterator<Item = Arriving>) -> Direct {
        let (mut light, mut evaluations, mut rays) = (Direct::default(), 0, 0);
        for one in arriving {
            light = light + one.light;
            evaluations += 1;
            rays += one.rays;
        }
        self.tally.add(evaluations, rays);
        light
    }

    fn points_shine(&self, occluders: &Occluders, place: DVec3, normal: DVec3) -> Direct {
        let mut light = Direct::default();
        let (mut evaluations, mut rays) = (0, 0);
        for point in &self.points {
            if let Some((irradiance, source)) = punctual::irradiance(point, place, normal) {
                light.unoccluded += irradiance;
                evaluations += 1;
                rays += 1;
                let far_end = match source {
                    Source::Position(position) => position,
                    Source::Direction(direction) => place + direction * occluders.extent(),
                };
                if !occluders.blocks(place, far_end) {
                    light.irradiance += irradiance;
                }
            }
        }
        self.tally.add(evaluations, rays);
        light
    }
}

/// Light from one lamp, and the rays that it took to find it.
struct Arriving {
    light: Direct,
    rays: u64,
}

/// Occluders, and the numbers of those that may be in the way, where these are known.
type Screen<'a> = (&'a Occluders, Option<&'a [u32]>);

impl AreaLamp {
    /// What arrives at a place with a unit normal, if anything may; by so many `rows` of rays, if any.
    fn shine(
        &self,
        screen: Screen<'_>,
        receiver: (DVec3, DVec3),
        rows: Option<u32>,
    ) -> Option<Arriving> {
        let (place, normal) = receiver;
        let above = self.reach(place, normal);
        if above.is_empty() {
            return None;
        }
        let all = self.glow.weight(receiver, &above);
        let exact = match (screen, rows) {
            ((_, Some([])), _) => Some(all),
            (_, Some(_)) => None,
            (_, None) => self.seen(screen, receiver, &above),
        };
        let rows = rows.unwrap_or(if self.glow.is_sky() { SKY_STRATA } else { STRATA });
        let rays = u64::from(rows * rows) * (above.len() as u64 - 2);
        let (seen, rays) = exact.map_or_else(
            || (self.sampled(screen.0, receiver, (&above, rows)), rays),
            |exact| (exact, 0),
        );
        let (irradiance, unoccluded) = (self.exitance * seen.min(all), self.exitance * all);
        Some(Arriving { light: Direct { irradiance, unoccluded }, rays })
    }

    /// What would arrive at a place with a unit normal if nothing stood between, W/m².
    fn unoccluded(&self, receiver: (DVec3, DVec3)) -> Rgb {
        let above = self.reach(receiver.0, receiver.1);
        if above.is_empty() {
            Rgb::ZERO
        } else {
            self.exitance * self.glow.weight(receiver, &above)
        }
    }

    /// The part above the horizon of a place in front of the lamp.
    fn reach(&self, place: DVec3, normal: DVec3) -> Cow<'_, [DVec3]> {
        if self.front.depth(place) <= 0.0 {
            return Cow::Borrowed(&[]);
        }
        self.above_plane(HalfSpace::new(place, normal))
    }

    /// The part that some place on a receiver may see, if there is one.
    fn above(&self, receiver: Facet<'_>) -> Option<Cow<'_, [DVec3]>> {
        let faces = receiver.corners.iter().any(|&corner| self.front.depth(corner) > 0.0);
        let above = self.above_plane(receiver.plane);
        (faces && !above.is_empty()).then_some(above)
    }

    fn above_plane(&self, horizon: HalfSpace) -> Cow<'_, [DVec3]> {
        if self.corners.iter().all(|&corner| horizon.depth(corner) >= 0.0) {
            return Cow::Borrowed(&self.corners);
        }
        Cow::Owned(horizon.clip(&self.corners).into_vec())
    }

    /// Form factor of the part that is not hidden, unless too much stands in between.
    fn seen(
        &self,
        screen: Screen<'_>,
        (place, normal): (DVec3, DVec3),
        above: &[DVec3],
    ) -> Option<f64> {
        let exact = match screen {
            (occluders, Some(among)) => {
                occluders.visible_behind(among, place, above, self.front.normal)
            }
            (occluders, None) => occluders.visible_part(place, above, self.front.normal),
        };
        exact.map(|pieces: Pieces| {
            pieces.iter().map(|piece| self.glow.weight((place, normal), piece)).sum()
        })
    }

    /// The visible part's weight by a ray to each of the cells in so many rows on each triangle of the part
    /// above the horizon: the fallback where much stands in between.
    fn sampled(
        &self,
        occluders: &Occluders,
        (place, normal): (DVec3, DVec3),
        (polygon, rows): (&[DVec3], u32),
    ) -> f64 {
        let mut sum = 0.0;
        for k in 1..polygon.len() - 1 {
            let triangle = [polygon[0], polygon[k], polygon[k + 1]];
            for cell in cells(triangle, rows) {
                let middle = cell.iter().sum::<DVec3>() / 3.0;
                if !occluders.blocks(place, middle) {
                    let share = self.glow.radiance((middle - place).normalize_or_zero());
                    sum += share * point_to_polygon(place, normal, &cell);
                }
            }
        }
        sum
    }
}

/// Cells along an edge of each triangle of a light where exact cutting has given up.
const STRATA: u32 = 12;

/// The same for each of the pieces of a sky, which together are many.
const SKY_STRATA: u32 = 6;

/// Equal triangles in so many rows that make up one.
fn cells([a, b, c]: [DVec3; 3], rows: u32) -> impl Iterator<Item = [DVec3; 3]> {
    let (u, v) = ((b - a) / f64::from(rows), (c - a) / f64::from(rows));
    let places = (0..rows).flat_map(move |row| (0..rows - row).map(move |column| (row, column)));
    places.flat_map(move |(row, column)| {
        let corner = a + u * f64::from(column) + v * f64::from(row);
        let between = (column + row + 1 < rows).then(|| [corner + u, corner + u + v, corner + v]);
        [Some([corner, corner + u, corner + v]), between].into_iter().flatten()
    })
}
