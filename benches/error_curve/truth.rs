//! The right radiosity at fixed places, and how far a mesh is from it.

use glam::{DVec2, DVec3};
use radiosity::colour::Rgb;
use radiosity::direct::Emitters;
use radiosity::geometry::polygon::edges;
use radiosity::light::Optics;
use radiosity::mesh::{ElementId, Mesh};
use radiosity::surface::SurfaceId;
use radiosity::visibility::Occluders;
use radiosity::{Settings, Surfaces, TriMesh};
use rayon::prelude::*;

use crate::lit;
use crate::lookup::Lookup;

/// Places are at most this share of the scene's extent apart.
const SPACING: f64 = 1.0 / 150.0;

/// Share of the area that is the shadow set: where light is hidden more and more most steeply.
const SHADOW_SHARE: f64 = 0.1;

/// Less reflected light than this share of the most is none: nobody looks into what stands on a floor.
const ENCLOSED: f64 = 1e-6;

/// A place on a surface, and what a mesh should say there.
struct Point {
    place: DVec3,
    normal: DVec3,
    /// m².
    area: f64,
    /// W/m².
    radiosity: Rgb,
    /// Irradiance by reflected light, W/m².
    reflected: Rgb,
    /// How steeply shadow falls there, W/m³.
    steepness: f64,
}

/// Places all over the reflecting surfaces of a scene, the steepest shadows first.
pub(crate) struct Truth {
    points: Vec<Point>,
    /// How many are the shadow set.
    shadow: usize,
    extent: f64,
}

/// Where light is measured.
struct Gauge<'a> {
    surfaces: &'a Surfaces,
    mesh: Mesh,
    optics: Optics,
    lamps: Emitters,
    occluders: Occluders,
}

impl Truth {
    /// Exact direct light, and reflected light of a fine solution.
    pub(crate) fn new(surfaces: &Surfaces) -> radiosity::Result<Self> {
        let (_, fine) = lit(surfaces, &Settings::high())?;
        let indirect = Lookup::new(&fine, surfaces.extent);
        let uniform = Some(SPACING * surfaces.extent);
        let mesh = Mesh::new(surfaces, &Settings { uniform, ..Settings::medium() });
        let (lamps, occluders) = (Emitters::new(surfaces, &mesh), Occluders::new(surfaces));
        let optics = Optics::new(surfaces, &mesh);
        let gauge = Gauge { surfaces, mesh, optics, lamps, occluders };
        let leaves: Vec<ElementId> = gauge.mesh.leaves().collect();
        let mut points: Vec<Point> = leaves
            .par_iter()
            .filter(|&&leaf| is_seen(surfaces, gauge.mesh.surface_of(leaf)))
            .filter_map(|&leaf| {
                let surface = &surfaces[gauge.mesh.surface_of(leaf)];
                let place = gauge.mesh.centre(leaf, &surface.plane);
                let at = (place, surface.plane.normal);
                let reflected = indirect.at(at, |vertex| fine.irradiance[vertex].indirect)?;
                Some(gauge.point(leaf, at, reflected))
            })
            .collect();
        let strength = |point: &Point| point.reflected.element_sum();
        let most = points.iter().map(strength).fold(0.0, f64::max);
        points.retain(|point| strength(point) >= ENCLOSED * most);
        points.sort_by(|a, b| b.steepness.total_cmp(&a.steepness));
        let shadow = leading(&points);
        Ok(Self { points, shadow, extent: surfaces.extent })
    }

    /// How many places there are, and how many of them are the shadow set.
    pub(crate) fn sizes(&self) -> [usize; 2] {
        [self.points.len(), self.shadow]
    }

    /// Root mean square error of a mesh as a share of the mean radiosity, over all places and over the
    /// shadow set.
    pub(crate) fn errors(&self, mesh: &TriMesh) -> [f64; 2] {
        let lookup = Lookup::new(mesh, self.extent);
        let square = |point: &Point| {
            let seen = lookup.at((point.place, point.normal), |vertex| mesh.radiosity[vertex]);
            let error = seen.unwrap_or(Rgb::ZERO) - point.radiosity;
            point.area * error.length_squared() / 3.0
        };
        let squares: Vec<f64> = self.points.par_iter().map(square).collect();
        [self.points.len(), self.shadow].map(|count| {
            let points = &self.points[..count];
            let area: f64 = points.iter().map(|point| point.area).sum();
            let light = |point: &Point| point.area * point.radiosity.element_sum() / 3.0;
            let mean = points.iter().map(light).sum::<f64>() / area;
            (squares[..count].iter().sum::<f64>() / area).sqrt() / mean
        })
    }
}

/// Whether a surface shows what a mesh computes: it reflects, and does not outshine that.
pub(crate) fn is_seen(surfaces: &Surfaces, surface: SurfaceId) -> bool {
    let surface = &surfaces[surface];
    surface.reflectance.max_element() > 0.0 && !surface.is_emitter()
}

/// How many points in order make up the shadow set.
fn leading(points: &[Point]) -> usize {
    let mut left = SHADOW_SHARE * points.iter().map(|point| point.area).sum::<f64>();
    let is_shadow = |point: &&Point| {
        left -= point.area;
        left >= 0.0 && point.steepness > 0.0
    };
    points.iter().take_while(is_shadow).count()
}

impl Gauge<'_> {
    fn point(&self, leaf: ElementId, (place, normal): (DVec3, DVec3), reflected: Rgb) -> Point {
        let direct = self.lamps.shine(&self.occluders, place, normal);
        let reflectance = self.optics.of(&self.mesh[leaf]);
        let slope = self.slope(leaf, (place, normal));
        Point {
            place,
            normal,
            area: self.mesh[leaf].area,
            radiosity: reflectance * (direct.irradiance + reflected),
            reflected,
            steepness: slope.length() * direct.unoccluded.element_sum() / 3.0,
        }
    }

    /// Gradient of the visible share, 1/m, by central differences inside a leaf.
    fn slope(&self, leaf: ElementId, (place, normal): (DVec3, DVec3)) -> DVec2 {
        let outline = self.mesh.outline(leaf);
        let longest = edges(&outline).map(|[a, b]| a.distance(b)).fold(0.0, f64::max);
        // Less than the distance of the centre from all edges of rectangles and triangles.
        let step = 0.2 * self.mesh[leaf].area / longest;
        let visible =
            |offset: DVec3| self.lamps.shine(&self.occluders, place + offset, normal).visible();
        let plane = &self.surfaces[self.mesh.surface_of(leaf)].plane;
        let along = |axis: DVec3| (visible(axis * step) - visible(axis * -step)) / (2.0 * step);
        DVec2::new(along(plane.u), along(plane.v))
    }
}
