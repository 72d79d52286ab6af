//! Points that fill a cube evenly, and what they become on triangles and spheres.

use glam::DVec3;

/// The `index`-th point of a sequence that fills the unit cube of four dimensions evenly
/// ([Roberts 2018](https://extremelearning.com.au/unreasonable-effectiveness-of-quasirandom-sequences/)).
pub(super) fn spread(index: usize) -> [f64; 4] {
    // Root of x⁵ = x + 1.
    const ROOT: f64 = 1.167_303_978_261_418_7;
    [1, 2, 3, 4].map(|power| (0.5 + (index + 1) as f64 / ROOT.powi(power)).fract())
}

/// The point of the unit sphere at shares of its height and its circumference.
pub(super) fn on_sphere(u: f64, v: f64) -> DVec3 {
    let height = 2.0 * u - 1.0;
    let (sin, cos) = (std::f64::consts::TAU * v).sin_cos();
    let radius = (1.0 - height * height).max(0.0).sqrt();
    DVec3::new(radius * cos, height, radius * sin)
}

/// The point of a triangle at two shares of the unit square, whose upper half is folded onto the lower.
pub(super) fn on_triangle([a, b, c]: [DVec3; 3], s: f64, t: f64) -> DVec3 {
    let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
    a + s * (b - a) + t * (c - a)
}
