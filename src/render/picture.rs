//! A picture of a mesh: what it holds, and what it is made from.

use std::ops::ControlFlow;

use glam::Vec3;

use super::colours::Swatch;
use super::final_gather::FinalGather;
use super::shade::{Shade, Solved};
use super::tracer::Tracer;
use super::view::View;
use crate::colour::Rgb;
use crate::reconstruct::TriMesh;
use crate::scene::{Camera, NamedLight};
use crate::solver::Stop;

/// Linear pixels; all lists run row by row from the top and hold `width * height` values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// What is shown.
    pub view: View,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear RGB, the background included: radiance, W/(m² sr), of light, mesh and radiosity;
    /// irradiance, W/m²; the share of the allowed error; or colours that stand for levels and reasons.
    pub values: Vec<Vec3>,
    /// The values that the whites of pictures on surfaces would have, which [tone mapping](crate::tone::tone_map_picture)
    /// goes by; empty in pictures of meshes without textures.
    pub whites: Vec<Vec3>,
    /// Share of each pixel that shows the mesh, 0..=1.
    pub coverage: Vec<f32>,
    /// Strength of the mesh's lines, 0..=1; empty in views without.
    pub lines: Vec<f32>,
    /// Value where there is no mesh.
    pub background: Rgb,
    /// Whether it shows a solution that was stopped before it was done, as far as its [`Subject`] knows; a PNG says so
    /// in its corner.
    pub unfinished: bool,
    /// What the mesh is made of, in words.
    pub(super) caption: String,
    /// What colours stand for, where values are colours.
    pub(super) key: Vec<Swatch>,
}

impl Picture {
    /// The same light and lines, with no legend below.
    #[must_use]
    pub fn without_legend(self) -> Self {
        let view = if self.view.shows_radiance() { View::Light } else { self.view };
        Self { view, ..self }
    }
}

/// What a picture should hold.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// What to show, default the light.
    pub view: View,
    /// Pixels a row, default 800.
    pub width: u32,
    /// Rows, default 600.
    pub height: u32,
    /// Rays a pixel along each axis, at least 1, default 4. From 3 on, pixels that look smooth, with
    /// those beside them, after the first few rays, one a row and column of the grid, get no more.
    pub samples: u32,
    /// Whether to evaluate direct light anew at every sample, or at one in smooth pixels, instead of
    /// interpolating it, which needs a [`Solved`]; default no.
    pub final_gather: bool,
    /// Radiance where there is no mesh, W/(m² sr), default 0; not in views of other quantities.
    pub background: Rgb,
    /// Skies and suns seen where there is no mesh, over the background, default none; as that, in views of radiance
    /// other than that of radiosity.
    pub sky: Vec<NamedLight>,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            view: View::Light,
            width: 800,
            height: 600,
            samples: 4,
            final_gather: false,
            background: Rgb::ZERO,
            sky: Vec::new(),
        }
    }
}

/// What a picture is taken of.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// What is seen.
    pub mesh: &'a TriMesh,
    /// What it was made from, for views that need it and for final gathering.
    pub solved: Option<Solved<'a>>,
}

impl Subject<'_> {
    /// Whether its solution was stopped before it was done.
    fn is_unfinished(&self) -> bool {
        self.solved.is_some_and(|solved| solved.solution.stop != Stop::Converged)
    }
}

/// The picture of `mesh` from `camera`: radiance B/π, averaged over each pixel.
///
/// Radiosity is interpolated linearly over the triangles; on textured parts it is multiplied by
/// texture over texture mean. Back sides are not seen. Views that [need a
/// solution](View::needs_solution) show nothing.
pub fn render(mesh: &TriMesh, camera: &Camera, options: &RenderOptions) -> Picture {
    let subject = Subject { mesh, solved: None };
    render_solved(subject, camera, options, |_| ControlFlow::Continue(()))
}

/// The same of a solution, with all views; with [`RenderOptions::final_gather`], direct light is
/// exact where it is shown, not interpolated.
///
/// `observe` is told how much is done, 0..=1; when it breaks off, the rest of the picture is
/// interpolated, and its edges are not smoothed.
pub fn render_solved(
    subject: Subject<'_>,
    camera: &Camera,
    options: &RenderOptions,
    mut observe: impl FnMut(f64) -> ControlFlow<()>,
) -> Picture {
    let mesh = subject.mesh;
    let gather = options.final_gather.then_some(()).and(subject.solved.as_ref());
    let gather = gather
        .and_then(|solved| FinalGather::new(solved.surfaces, &solved.solution.mesh, &mut observe));
    let shade = Shade::new(subject, options.view);
    let key = shade.key.clone();
    let background = if options.view.shows_radiance() { options.background } else { Rgb::ZERO };
    let pixels =
        Tracer::new((camera, options), shade, background).trace(gather.as_ref(), &mut observe);
    Picture {
        view: options.view,
        width: options.width,
        height: options.height,
        values: pixels.iter().map(|pixel| pixel.value.as_vec3()).collect(),
        whites: match mesh.textures.is_empty() {
            true => Vec::new(),
            false => pixels.iter().map(|pixel| pixel.white.as_vec3()).collect(),
        },
        coverage: pixels.iter().map(|pixel| pixel.coverage as f32).collect(),
        lines: match options.view.shows_lines() {
            true => pixels.iter().map(|pixel| pixel.line as f32).collect(),
            false => Vec::new(),
        },
        background,
        unfinished: subject.is_unfinished(),
        caption: caption(mesh),
        key,
    }
}

/// Numbers of triangles and of leaves.
fn caption(mesh: &TriMesh) -> String {
    let mut leaves = mesh.leaves.clone();
    leaves.sort_unstable();
    leaves.dedup();
    match leaves.len() {
        0 => format!("{} triangles", mesh.triangles.len()),
        count => format!("{} triangles, {count} elements", mesh.triangles.len()),
    }
}
