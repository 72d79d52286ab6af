//! A picture of a mesh: what it holds and how its pixels are found.

use std::f64::consts::PI;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::caster::{Caster, Hit, Sides};
use super::lines::line_coverage;
use super::texture;
use super::view::View;
use crate::colour::Rgb;
use crate::reconstruct::TriMesh;
use crate::scene::Camera;

/// Least mean of a texture by which a radiosity is divided; darker texels hold no information.
const LEAST_TEXTURE_MEAN: f64 = 1e-6;

/// Linear pixels; all lists run row by row from the top and hold `width * height` values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Radiance, W/(m² sr), linear RGB, the background included.
    pub radiance: Vec<Vec3>,
    /// Share of each pixel that shows the mesh, 0..=1.
    pub coverage: Vec<f32>,
    /// Strength of the mesh's lines, 0..=1; empty unless asked for.
    pub lines: Vec<f32>,
    /// Radiance where there is no mesh, W/(m² sr).
    pub background: Rgb,
}

/// What a picture should hold.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// Pixels a row, default 800.
    pub width: u32,
    /// Rows, default 600.
    pub height: u32,
    /// Rays a pixel along each axis, at least 1, default 4; the time grows with its square.
    pub samples: u32,
    /// Whether to find the mesh's lines, for display over the light; default no.
    pub wireframe: bool,
    /// Radiance where there is no mesh, W/(m² sr), default 0.
    pub background: Rgb,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self { width: 800, height: 600, samples: 4, wireframe: false, background: Rgb::ZERO }
    }
}

/// The picture of `mesh` from `camera`: radiance B/π, averaged over each pixel.
///
/// Radiosity is interpolated linearly over the triangles; on textured parts it is multiplied by
/// texture over texture mean. Back sides are not seen.
pub fn render(mesh: &TriMesh, camera: &Camera, options: &RenderOptions) -> Picture {
    let caster = Caster::new(mesh);
    let view = View::new(camera, options.width, options.height);
    let tracer = Tracer { mesh, caster: &caster, view: &view, options };
    let count = options.width as usize * options.height as usize;
    let pixels: Vec<Pixel> = (0..count).into_par_iter().map(|index| tracer.pixel(index)).collect();
    Picture {
        width: options.width,
        height: options.height,
        radiance: pixels.iter().map(|pixel| pixel.radiance.as_vec3()).collect(),
        coverage: pixels.iter().map(|pixel| pixel.coverage as f32).collect(),
        lines: match options.wireframe {
            true => pixels.iter().map(|pixel| pixel.line as f32).collect(),
            false => Vec::new(),
        },
        background: options.background,
    }
}

/// Means over a pixel.
#[derive(Clone, Copy, Default)]
struct Pixel {
    radiance: Rgb,
    coverage: f64,
    line: f64,
}

struct Tracer<'a> {
    mesh: &'a TriMesh,
    caster: &'a Caster,
    view: &'a View,
    options: &'a RenderOptions,
}

impl Tracer<'_> {
    fn pixel(&self, index: usize) -> Pixel {
        let width = self.options.width as usize;
        let (left, top) = ((index % width) as f64, (index / width) as f64);
        let samples = self.options.samples.max(1);
        let mut sum = Pixel::default();
        for i in 0..samples {
            for j in 0..samples {
                let (x, y) = place_of_sample(i, j, samples);
                self.add_sample(left + x, top + y, &mut sum);
            }
        }
        let share = 1.0 / f64::from(samples).powi(2);
        Pixel {
            radiance: sum.radiance * share,
            coverage: sum.coverage * share,
            line: sum.line * share,
        }
    }

    fn add_sample(&self, x: f64, y: f64, sum: &mut Pixel) {
        let direction = self.view.direction(x, y);
        let hit = self.caster.first(self.view.eye, direction.normalize(), Sides::Front);
        let Some(hit) = hit else {
            sum.radiance += self.options.background;
            return;
        };
        sum.radiance += radiosity_at(self.mesh, &hit) / PI;
        sum.coverage += 1.0;
        if self.options.wireframe {
            sum.line += line_coverage(self.mesh, self.view, direction, &hit);
        }
    }
}

/// Place in a pixel, 0..1, of sample `i`, `j` out of `samples` squared: on a grid turned so that
/// no two samples share a row or column, which grades edges near the axes finest.
fn place_of_sample(i: u32, j: u32, samples: u32) -> (f64, f64) {
    let [i, j, n] = [i, j, samples].map(f64::from);
    ((i + (j + 0.5) / n) / n, (j + (n - i - 0.5) / n) / n)
}

/// Radiosity, W/m², at `hit`, textured.
pub(super) fn radiosity_at(mesh: &TriMesh, hit: &Hit) -> Rgb {
    let corners = mesh.triangles[hit.triangle].map(|corner| corner as usize);
    let weights = hit.weights.to_array();
    let mix = |values: &[Rgb]| -> Rgb {
        corners.iter().zip(weights).map(|(&corner, weight)| values[corner] * weight).sum()
    };
    let radiosity = mix(&mesh.radiosity);
    let part = mesh.parts.partition_point(|part| part.triangles.end <= hit.triangle);
    let texture = mesh.parts.get(part).and_then(|part| part.texture);
    let Some(texture) = texture.and_then(|index| mesh.textures.get(index as usize)) else {
        return radiosity;
    };
    let uv: Vec2 =
        corners.iter().zip(weights).map(|(&corner, weight)| mesh.uvs[corner] * weight as f32).sum();
    let mean = mix(&mesh.texture_mean).max(Rgb::splat(LEAST_TEXTURE_MEAN));
    radiosity / mean * texture::sample(texture, uv)
}
