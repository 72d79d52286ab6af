//! What is seen at a place of the mesh.

use std::f64::consts::PI;

use glam::{DVec3, Vec2};

use super::caster::Hit;
use super::colours::Swatch;
use super::final_gather::FinalGather;
use super::leaves;
use super::picture::Subject;
use super::texture;
use super::view::View;
use crate::colour::Rgb;
use crate::reconstruct::{Irradiance, TriMesh};
use crate::settings::Settings;
use crate::solver::Solution;
use crate::surface::Surfaces;

/// Least mean of a texture by which a radiosity is divided; darker texels hold no information.
const LEAST_TEXTURE_MEAN: f64 = 1e-6;

/// What a triangle mesh was made from.
#[derive(Clone, Copy, Debug)]
pub struct Solved<'a> {
    /// The scene's surfaces.
    pub surfaces: &'a Surfaces,
    /// What the solution was held to.
    pub settings: &'a Settings,
    /// Their light.
    pub solution: &'a Solution,
}

/// Direct light at the place itself; without, it is interpolated.
pub(super) type Gather<'a> = Option<&'a FinalGather<'a>>;

/// Finds the value of a view at any place of a mesh.
pub(super) struct Shade<'a> {
    pub(super) mesh: &'a TriMesh,
    pub(super) view: View,
    /// Values by triangle, in views of the leaves.
    by_triangle: Vec<Rgb>,
    /// What their colours stand for.
    pub(super) key: Vec<Swatch>,
}

impl<'a> Shade<'a> {
    pub(super) fn new(subject: Subject<'a>, view: View) -> Self {
        let mesh = subject.mesh;
        let (by_leaf, key) = match (view, &subject.solved) {
            (View::Level, Some(solved)) => leaves::levels(&solved.solution.mesh),
            (View::Reason, Some(solved)) => leaves::reasons(&solved.solution.mesh),
            (View::Error, Some(solved)) => (leaves::errors(solved), Vec::new()),
            _ => (Vec::new(), Vec::new()),
        };
        let value = |leaf: &crate::mesh::ElementId| by_leaf.get(leaf.index()).copied();
        let values = mesh.leaves.iter().map(|leaf| value(leaf).unwrap_or_default());
        let by_triangle = if by_leaf.is_empty() { Vec::new() } else { values.collect() };
        Self { mesh, view, by_triangle, key }
    }

    /// The view's value at a place, linear RGB.
    pub(super) fn value(&self, hit: &Hit, gather: Gather<'_>) -> Rgb {
        match self.view {
            View::Light | View::Wireframe | View::Radiosity => self.radiosity(hit, gather) / PI,
            View::Direct => self.direct(hit, gather),
            View::Indirect => self.irradiance(hit).indirect,
            View::Illuminance => self.direct(hit, gather) + self.irradiance(hit).indirect,
            View::Level | View::Reason | View::Error => {
                self.by_triangle.get(hit.triangle).copied().unwrap_or_default()
            }
        }
    }

    fn radiosity(&self, hit: &Hit, gather: Gather<'_>) -> Rgb {
        let interpolated = radiosity_at(self.mesh, hit);
        let Some(gather) = gather else {
            return interpolated;
        };
        let reflectance = gather.reflectance(self.mesh.leaves[hit.triangle], self.place(hit));
        if reflectance == Rgb::ZERO {
            return interpolated;
        }
        let change = self.direct(hit, Some(gather)) - self.irradiance(hit).direct;
        let texture = texture_at(self.mesh, hit).unwrap_or(Rgb::ONE);
        (interpolated + reflectance * texture * change).max(Rgb::ZERO)
    }

    /// Irradiance straight from emitters.
    ///
    /// What the vertices say, changed by as much as they are wrong here about the light on this
    /// facet: so facets of a curved surface share their light with final gathering as without.
    fn direct(&self, hit: &Hit, gather: Gather<'_>) -> Rgb {
        let Irradiance { direct, direct_on_facet, .. } = self.irradiance(hit);
        let Some(gather) = gather else {
            return direct;
        };
        let exact = gather.direct(self.mesh.leaves[hit.triangle], self.place(hit));
        (direct + (exact - direct_on_facet)).max(Rgb::ZERO)
    }

    /// Where a hit is, m.
    fn place(&self, hit: &Hit) -> DVec3 {
        let corners = self.mesh.triangles[hit.triangle].map(|c| self.mesh.positions[c as usize]);
        corners.iter().zip(hit.weights.to_array()).map(|(&p, weight)| p * weight).sum()
    }

    /// What the vertices say of the light that arrives; nothing in a mesh read from a file.
    fn irradiance(&self, hit: &Hit) -> Irradiance {
        let corners = self.mesh.triangles[hit.triangle].map(|corner| corner as usize);
        let mut mean = Irradiance::default();
        for (corner, weight) in corners.into_iter().zip(hit.weights.to_array()) {
            let Some(light) = self.mesh.irradiance.get(corner) else { continue };
            mean.direct += light.direct * weight;
            mean.indirect += light.indirect * weight;
            mean.direct_on_facet += light.direct_on_facet * weight;
        }
        mean
    }
}

/// Radiosity, W/m², at `hit`, textured.
pub(super) fn radiosity_at(mesh: &TriMesh, hit: &Hit) -> Rgb {
    let radiosity = mix(mesh, hit, &mesh.radiosity);
    texture_at(mesh, hit).map_or(radiosity, |texture| {
        let mean = mix(mesh, hit, &mesh.texture_mean).max(Rgb::splat(LEAST_TEXTURE_MEAN));
        radiosity / mean * texture
    })
}

/// Values at vertices, interpolated.
fn mix(mesh: &TriMesh, hit: &Hit, values: &[Rgb]) -> Rgb {
    let corners = mesh.triangles[hit.triangle].map(|corner| corner as usize);
    corners
        .iter()
        .zip(hit.weights.to_array())
        .map(|(&corner, weight)| values[corner] * weight)
        .sum()
}

/// Colour of the texture at `hit`, if there is one.
fn texture_at(mesh: &TriMesh, hit: &Hit) -> Option<Rgb> {
    let part = mesh.parts.partition_point(|part| part.triangles.end <= hit.triangle);
    let texture = mesh.textures.get(mesh.parts.get(part)?.texture? as usize)?;
    let corners = mesh.triangles[hit.triangle].map(|corner| corner as usize);
    let weighted = corners.iter().zip(hit.weights.to_array());
    let uv: Vec2 = weighted.map(|(&corner, weight)| mesh.uvs[corner] * weight as f32).sum();
    Some(texture::sample(texture, uv))
}
