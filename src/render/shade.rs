//! What is seen at a place of the mesh.

use std::f64::consts::PI;

use glam::{DVec3, Vec2};

use super::caster::MeshHit;
use super::colours::Swatch;
use super::final_gather::FinalGather;
use super::leaves;
use super::subject::Subject;
use super::view::View;
use crate::colour::Rgb;
use crate::reconstruct::{Irradiance, MeshPart, TriMesh};
use crate::scene::Texture;

/// Direct light at the place itself; without, it is interpolated.
pub(super) type Gather<'a> = Option<&'a FinalGather<'a>>;

/// A view's value at a place, and what the white of the picture that lies there would have; of radiosity that can differ.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ShadedValue {
    pub(super) value: Rgb,
    pub(super) white: Rgb,
}

impl From<Rgb> for ShadedValue {
    fn from(value: Rgb) -> Self {
        Self { value, white: value }
    }
}

/// Finds the value of a view at any place of a mesh.
pub(super) struct Shade<'a> {
    pub(super) mesh: &'a TriMesh,
    pub(super) view: View,
    /// [`Texture::white`] of the mesh's textures.
    whites: Vec<f64>,
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
        let whites = mesh.textures.iter().map(Texture::white).collect();
        Self { mesh, view, whites, by_triangle, key }
    }

    /// Whether a ray ends at a triangle, or goes through a hole that is cut out of it.
    pub(super) fn is_there(&self, hit: &MeshHit) -> bool {
        let Some(cutoff) = part_of(self.mesh, hit.triangle).and_then(|part| part.cutoff) else {
            return true;
        };
        let texture = texture_on(self.mesh, hit.triangle);
        texture.is_none_or(|number| {
            self.mesh.textures[number].opacity(uv_at(self.mesh, hit)) >= cutoff
        })
    }

    /// The view's value at a place, linear RGB.
    pub(super) fn value(&self, hit: &MeshHit, gather: Gather<'_>) -> ShadedValue {
        match self.view {
            View::Light | View::Wireframe | View::Radiosity => self.radiance(hit, gather),
            View::Direct => self.direct(hit, gather).into(),
            View::Indirect => self.irradiance(hit).indirect.into(),
            View::Illuminance => (self.direct(hit, gather) + self.irradiance(hit).indirect).into(),
            View::Level | View::Reason | View::Error => {
                self.by_triangle.get(hit.triangle).copied().unwrap_or_default().into()
            }
        }
    }

    fn radiance(&self, hit: &MeshHit, gather: Gather<'_>) -> ShadedValue {
        let texture = texture_on(self.mesh, hit.triangle);
        let light = self.light(hit, texture.is_some(), gather) / PI;
        let Some(number) = texture else { return light.into() };
        ShadedValue {
            value: light * texture_at(self.mesh, number, hit),
            white: light * self.whites[number],
        }
    }

    /// Radiosity, that of a white picture where there is one.
    fn light(&self, hit: &MeshHit, is_textured: bool, gather: Gather<'_>) -> Rgb {
        let interpolated = light_at(self.mesh, hit, is_textured);
        let Some(gather) = gather else {
            return interpolated;
        };
        let reflectance = gather.reflectance(self.mesh.leaves[hit.triangle], self.place(hit));
        if reflectance == Rgb::ZERO {
            return interpolated;
        }
        let change = self.direct(hit, Some(gather)) - self.irradiance(hit).direct;
        (interpolated + reflectance * change).max(Rgb::ZERO)
    }

    /// Irradiance straight from emitters.
    ///
    /// What the vertices say, changed by as much as they are wrong here about the light on this
    /// facet: so facets of a curved surface share their light with final gathering as without.
    fn direct(&self, hit: &MeshHit, gather: Gather<'_>) -> Rgb {
        let Irradiance { direct, direct_on_facet, .. } = self.irradiance(hit);
        let Some(gather) = gather else {
            return direct;
        };
        let exact = gather.direct(self.mesh.leaves[hit.triangle], self.place(hit));
        (direct + (exact - direct_on_facet)).max(Rgb::ZERO)
    }

    /// Where a hit is, m.
    fn place(&self, hit: &MeshHit) -> DVec3 {
        let corners = self.mesh.triangles[hit.triangle].map(|c| self.mesh.positions[c as usize]);
        corners.iter().zip(hit.weights.to_array()).map(|(&p, weight)| p * weight).sum()
    }

    /// What the vertices say of the light that arrives; nothing in a mesh read from a file.
    fn irradiance(&self, hit: &MeshHit) -> Irradiance {
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
pub(super) fn radiosity_at(mesh: &TriMesh, hit: &MeshHit) -> Rgb {
    let texture = texture_on(mesh, hit.triangle);
    let light = light_at(mesh, hit, texture.is_some());
    texture.map_or(light, |number| light * texture_at(mesh, number, hit))
}

/// Interpolated radiosity, W/m², that of a white picture on a textured triangle.
fn light_at(mesh: &TriMesh, hit: &MeshHit, is_textured: bool) -> Rgb {
    let corners = mesh.triangles[hit.triangle].map(|corner| corner as usize);
    let light = |vertex| if is_textured { mesh.light(vertex) } else { mesh.radiosity[vertex] };
    let weighted = corners.into_iter().zip(hit.weights.to_array());
    weighted.map(|(corner, weight)| light(corner) * weight).sum()
}

fn part_of(mesh: &TriMesh, triangle: usize) -> Option<&MeshPart> {
    mesh.parts.get(mesh.parts.partition_point(|part| part.triangles.end <= triangle))
}

/// Number of the texture of a triangle.
fn texture_on(mesh: &TriMesh, triangle: usize) -> Option<usize> {
    let number = part_of(mesh, triangle)?.texture? as usize;
    (number < mesh.textures.len()).then_some(number)
}

/// Colour of a texture at `hit`.
fn texture_at(mesh: &TriMesh, number: usize, hit: &MeshHit) -> Rgb {
    mesh.textures[number].mixed(uv_at(mesh, hit))
}

/// Texture coordinates at `hit`.
fn uv_at(mesh: &TriMesh, hit: &MeshHit) -> Vec2 {
    let corners = mesh.triangles[hit.triangle].map(|corner| corner as usize);
    let weighted = corners.iter().zip(hit.weights.to_array());
    weighted.map(|(&corner, weight)| mesh.uvs[corner] * weight as f32).sum()
}
