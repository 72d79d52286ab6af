//! Errors on a mesh.

use glam::DVec3;
use rayon::prelude::*;

use crate::colour::{Rgb, luminance};
use crate::compare::comparison::Comparison;
use crate::compare::locate::Locator;
use crate::compare::path_tracer::{PathTracer, Site};
use crate::compare::run::Lit;
use crate::reconstruct::{Irradiance, TriMesh};

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
        let surface = solution.mesh.surface_of(leaf);
        let normal = self.tracer.surfaces[surface].plane.normal;
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
