//! Ends of scales that show most of a mesh well.

use crate::colour::luminance;
use crate::reconstruct::TriMesh;
use crate::render::map;

/// Places of the mesh, each of as much area, that stand for it.
const PLACES: usize = 1000;

/// Share of the errors that the scale holds.
const ERRORS_SHOWN: f64 = 0.95;

/// The lower end of a logarithmic scale of radiosity as a share of the upper end. The mesh itself does
/// not tell: how much of it is black, under things and behind them, says nothing of what is seen.
const LOW_SHARE: f64 = 0.01;

/// Ends of a logarithmic scale of radiosity, W/m², that lamps do not stretch.
pub(super) fn radiosity_range(mesh: &TriMesh) -> [f64; 2] {
    let [_, high] = map::bulk(&by_area(mesh));
    let high = if high > 0.0 && high.is_finite() { high } else { 1.0 };
    [LOW_SHARE * high, high]
}

/// What 95 of 100 `errors` keep within, rounded up to 1, 2 or 5 times a power of ten; 1 at most.
pub(super) fn error_limit(errors: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = errors.iter().map(|e| e.abs()).filter(|e| e.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    let at = (ERRORS_SHOWN * sizes.len() as f64) as usize;
    match sizes.get(at) {
        Some(&size) if size > 1e-6 => map::round_above(size).min(1.0),
        _ => 1e-2,
    }
}

/// Rising radiosities, luminance of W/m², of places evenly spread over the mesh.
fn by_area(mesh: &TriMesh) -> Vec<f64> {
    let mut pieces: Vec<(f64, f64)> = mesh.triangles.iter().map(|t| piece(mesh, t)).collect();
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = pieces.iter().map(|(_, area)| area).sum();
    let mut values = Vec::with_capacity(PLACES);
    let mut covered = 0.0;
    for (value, area) in pieces {
        covered += area;
        let wanted = (covered / total * PLACES as f64).min(PLACES as f64) as usize;
        values.resize(wanted.max(values.len()), value);
    }
    values
}

/// Mean radiosity and area, m², of a triangle.
fn piece(mesh: &TriMesh, corners: &[u32; 3]) -> (f64, f64) {
    let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
    let sum: f64 = corners.iter().map(|&corner| luminance(mesh.radiosity[corner as usize])).sum();
    (sum / 3.0, (b - a).cross(c - a).length() / 2.0)
}
