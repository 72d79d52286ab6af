//! Errors where they can be seen: in a picture, and on a mesh.

use std::f64::consts::PI;

use glam::DVec3;
use image::RgbImage;
use rayon::prelude::*;

use crate::colour::{Rgb, luminance};
use crate::compare::comparison::Comparison;
use crate::compare::locate::Locator;
use crate::compare::path_tracer::{PathTracer, Site};
use crate::compare::run::Lit;
use crate::compare::sentences::percent;
use crate::page::colour_maps;
use crate::page::{Markup, html};
use crate::reconstruct::{Irradiance, TriMesh};
use crate::render::map::round_above;
use crate::render::{Picture, smallest_png};

/// Share of the pixels whose errors the scale holds.
const HELD: f64 = 0.98;

/// Lower end of the scale of magnitudes over its upper end.
const DEPTH: f64 = 0.01;

/// Steps between the ends of a scale; even, so that one is in the middle.
const STEPS: f64 = 40.0;

/// sRGB-coded grey where there is nothing to compare.
const NOTHING: [u8; 3] = [128; 3];

/// By how much the luminance of a picture differs from another's, as a share of a mean.
pub(super) struct ErrorMap {
    width: u32,
    height: u32,
    /// Row by row; `None` where no surface fills the pixel.
    errors: Vec<Option<f64>>,
}

/// One scale for several maps.
pub(super) struct ErrorScale {
    limit: f64,
}

impl ErrorMap {
    /// Of pictures of one size; `mean` is a radiosity, W/m².
    pub(super) fn new(picture: &Picture, reference: &Picture, mean: f64) -> Self {
        let error = |index: usize| {
            let radiosity = |p: &Picture| PI * luminance(p.values[index].as_dvec3());
            (picture.coverage[index] > 0.999)
                .then(|| (radiosity(picture) - radiosity(reference)) / mean.max(f64::MIN_POSITIVE))
        };
        let errors = (0..picture.values.len()).map(error).collect();
        Self { width: picture.width, height: picture.height, errors }
    }

    /// Sum of the errors' squares over a block of pixels.
    pub(super) fn sum(&self, [left, top]: [u32; 2], [width, height]: [u32; 2]) -> f64 {
        let row = |y: u32| {
            let start = (y * self.width + left) as usize;
            self.errors[start..start + width as usize].iter().flatten().map(|e| e * e).sum::<f64>()
        };
        (top..top + height).map(row).sum()
    }

    /// Blue where there is too little light, orange where there is too much; in steps, which pack better.
    pub(super) fn signed_png(&self, scale: &ErrorScale) -> Vec<u8> {
        self.png(|error| colour_maps::diverging_at(stepped((error / scale.limit + 1.0) / 2.0)))
    }

    /// Dark where the error is small.
    pub(super) fn absolute_png(&self, scale: &ErrorScale) -> Vec<u8> {
        self.png(|error| colour_maps::viridis_at(stepped(scale.place(error))))
    }

    fn png(&self, colour: impl Fn(f64) -> [u8; 3]) -> Vec<u8> {
        let image = RgbImage::from_fn(self.width, self.height, |x, y| {
            let error = self.errors[(y * self.width + x) as usize];
            image::Rgb(error.map_or(NOTHING, &colour))
        });
        smallest_png(&image)
    }

    /// Half, 95 of a hundred, and all of the pixels.
    pub(super) fn in_words(&self) -> String {
        let sizes = self.sizes();
        let [median, most, worst] = [0.5, 0.95, 1.0].map(|share| percent(quantile(&sizes, share)));
        format!("Half of the pixels are within {median}, 95 % within {most}, all within {worst}.")
    }

    /// Magnitudes, rising.
    fn sizes(&self) -> Vec<f64> {
        let mut sizes: Vec<f64> = self.errors.iter().flatten().map(|error| error.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
    }
}

/// The nearest of a few places along a scale.
fn stepped(place: f64) -> f64 {
    (place.clamp(0.0, 1.0) * STEPS).round() / STEPS
}

fn quantile(rising: &[f64], share: f64) -> f64 {
    let last = rising.len().saturating_sub(1);
    rising.get((share * last as f64) as usize).copied().unwrap_or(0.0)
}

impl ErrorScale {
    /// That holds nearly all errors of all maps.
    pub(super) fn of(maps: &[ErrorMap]) -> Self {
        let limits = maps.iter().map(|map| quantile(&map.sizes(), HELD));
        Self { limit: round_above(limits.fold(1e-4, f64::max)) }
    }

    /// Where on the logarithmic scale a magnitude is, 0..=1.
    fn place(&self, error: f64) -> f64 {
        let share = (error.abs() / self.limit).max(DEPTH);
        (1.0 - share.ln() / DEPTH.ln()).clamp(0.0, 1.0)
    }

    /// Both scales, with their ends.
    pub(super) fn legends(&self) -> Markup {
        let end = percent(self.limit);
        html! {
            (legend("Signed", &colour_maps::diverging(), [&format!("−{end}"), "0", &format!("+{end}")]))
            (legend("Magnitude, logarithmic", &colour_maps::viridis(),
                [&percent(self.limit * DEPTH), &percent(self.limit * DEPTH.sqrt()), &end]))
        }
    }
}

/// A strip of colours, three bytes each, with marks at its ends and in the middle.
fn legend(title: &str, colours: &[u8], marks: [&str; 3]) -> Markup {
    let stops: Vec<String> = colours
        .chunks_exact(3)
        .step_by(15)
        .map(|c| format!("rgb({} {} {})", c[0], c[1], c[2]))
        .collect();
    let style = format!("background: linear-gradient(to right, {})", stops.join(", "));
    html! {
        div.legend {
            span.title { (title) }
            div.bar {
                div.strip style=(style) {}
                div.marks {
                    @for (mark, at) in marks.iter().zip([0, 50, 100]) {
                        span style=(format!("left: {at}%")) { (mark) }
                    }
                }
            }
        }
    }
}

/// Light as it should be, anywhere on a mesh: straight from emitters exactly, reflected as in the best solution.
pub(super) struct Truth<'a> {
    tracer: PathTracer<'a>,
    best: Locator<'a>,
    mean: f64,
}

impl<'a> Truth<'a> {
    /// By the reflected light of the `best` of the runs.
    pub(super) fn new(comparison: &'a Comparison, best: &'a Lit) -> Self {
        let Comparison { surfaces, runs, .. } = comparison;
        let mean = runs.iter().map(|run| run.score.all.mean).fold(0.0, f64::max);
        Self {
            tracer: PathTracer::new(surfaces),
            best: Locator::new(&best.mesh, surfaces.extent),
            mean: mean.max(f64::MIN_POSITIVE),
        }
    }

    /// Mean errors in the middles of the triangles around each vertex, by their areas, as shares of the mean
    /// radiosity.
    pub(super) fn errors_at_vertices(&self, lit: &Lit) -> Vec<f64> {
        let mesh = &lit.mesh;
        let middles: Vec<(f64, f64)> =
            (0..mesh.triangles.len()).into_par_iter().map(|k| self.error_at(lit, k)).collect();
        let mut sums = vec![(0.0, 0.0); mesh.positions.len()];
        for (triangle, (error, area)) in mesh.triangles.iter().zip(middles) {
            for &vertex in triangle {
                let (sum, weight) = &mut sums[vertex as usize];
                *sum += error * area;
                *weight += area;
            }
        }
        let mean = |(sum, weight): (f64, f64)| if weight > 0.0 { sum / weight } else { 0.0 };
        sums.into_iter().map(|sums| mean(sums) / self.mean).collect()
    }

    /// Error in the middle of a triangle, W/m², too much light being positive, and the triangle's area, m².
    fn error_at(&self, lit: &Lit, triangle: usize) -> (f64, f64) {
        let Lit { mesh, solution } = lit;
        let corners = mesh.triangles[triangle];
        let [a, b, c] = corners.map(|v| mesh.positions[v as usize]);
        let leaf = mesh.leaves[triangle];
        let surface = solution.mesh.surface_of(leaf).index();
        let normal = self.tracer.surfaces.list[surface].plane.normal;
        let site = Site { surface, place: (a + b + c) / 3.0, normal };
        let truth = self.tracer.direct(&site).irradiance + self.reflected(&site, mesh, corners);
        let found = middle(mesh, corners, |light| light.direct + light.indirect);
        let reflectance = solution.optics.of(&solution.mesh[leaf]);
        (luminance(reflectance * (found - truth)), (b - a).cross(c - a).length() / 2.0)
    }

    /// Irradiance by reflected light, W/m²; where the best solution has no triangle, the mesh's own.
    fn reflected(&self, site: &Site, mesh: &TriMesh, corners: [u32; 3]) -> Rgb {
        let best = self.best.indirect(site.place, site.normal);
        best.unwrap_or_else(|| middle(mesh, corners, |light| light.indirect))
    }
}

fn middle(mesh: &TriMesh, corners: [u32; 3], light: impl Fn(&Irradiance) -> Rgb) -> DVec3 {
    corners.iter().map(|&v| light(&mesh.irradiance[v as usize])).sum::<DVec3>() / 3.0
}
