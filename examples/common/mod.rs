//! Lights surfaces, and tells how far a mesh is from a finer one, as seen from a camera.

use std::ops::ControlFlow;

use radiosity::render::{RenderOptions, render};
use radiosity::scene::Camera;
use radiosity::{Settings, Solution, Surfaces, TriMesh, reconstruct, solve};

/// Pixels this much brighter than the mean show a lamp, which every mesh gets right.
const LAMP: f64 = 10.0;

/// Root mean square of the difference of two pictures, as a share of the mean of the second.
pub(crate) fn error(mesh: &TriMesh, truth: &TriMesh, camera: &Camera) -> f64 {
    let options = RenderOptions { width: 480, height: 360, samples: 2, ..Default::default() };
    let [seen, right] = [mesh, truth].map(|mesh| render(mesh, camera, &options).values);
    let values = || right.iter().map(|pixel| f64::from(pixel.element_sum()));
    let lamp = LAMP * values().sum::<f64>() / values().filter(|&value| value > 0.0).count() as f64;

    let (mut squares, mut sum, mut count) = (0.0, 0.0, 0.0);
    for ((seen, right), value) in seen.iter().zip(&right).zip(values()) {
        if (f64::MIN_POSITIVE..lamp).contains(&value) {
            squares += f64::from(seen.distance_squared(*right)) / 3.0;
            sum += value / 3.0;
            count += 1.0;
        }
    }
    f64::sqrt(squares / count) / (sum / count)
}

/// The solution of a scene, and its triangles.
pub(crate) fn lit(
    surfaces: &Surfaces,
    settings: &Settings,
) -> radiosity::Result<(Solution, TriMesh)> {
    let solution = solve(surfaces, settings, |_| ControlFlow::Continue(()))?;
    let mesh = reconstruct(surfaces, &solution);
    Ok((solution, mesh))
}
