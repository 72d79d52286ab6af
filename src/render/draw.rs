//! Takes pictures.

use std::ops::ControlFlow;

use super::final_gather::FinalGather;
use super::options::RenderOptions;
use super::picture::Picture;
use super::shade::Shade;
use super::subject::Subject;
use super::tracer::PixelTracer;
use crate::colour::Rgb;
use crate::reconstruct::TriMesh;
use crate::scene::Camera;

/// The picture of `mesh` from `camera`: radiance B/π, averaged over each pixel.
///
/// Radiosity is interpolated linearly over the triangles; on textured parts it is multiplied by
/// texture over texture mean. Back sides are not seen. Views that [need a
/// solution](super::View::needs_solution) show nothing.
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
        PixelTracer::new(camera, options, shade, background).trace(gather.as_ref(), &mut observe);
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
