//! The mesh that leaves the house: triangles with a radiosity at every vertex.

use std::ops::Range;

use glam::{DVec3, Vec2, Vec3};

use crate::colour::Rgb;
use crate::geometry::boxes::local_origin;
use crate::mesh::ElementId;
use crate::scene::{Camera, Node, Texture};
use crate::surface::LightGroup;

/// A conforming triangle mesh; all per-vertex lists are as long as `positions`.
#[derive(Clone, Debug, Default)]
pub struct TriMesh {
    /// Vertex positions, m. Vertices of different surfaces at one place have bitwise equal positions.
    pub positions: Vec<DVec3>,
    /// Unit normals: of the surface, or of the curved surface it approximates.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, zero where a part has no texture.
    pub uvs: Vec<Vec2>,
    /// Radiosity B, W/m² per channel, interpolated linearly over a triangle.
    pub radiosity: Vec<Rgb>,
    /// Mean colour of the texture under the vertex's element, 1 where there is none; [`Self::light`] times the
    /// texture is the textured radiosity.
    pub texture_mean: Vec<Rgb>,
    /// Corners, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Consecutive runs of triangles that share a material and an object; together they are all triangles.
    pub parts: Vec<MeshPart>,
    /// Pictures that parts refer to.
    pub textures: Vec<Texture>,
    /// Names of the objects that parts belong to.
    pub objects: Vec<String>,
    /// The hierarchy that objects and cameras stand in; objects without a node stand by themselves.
    pub nodes: Vec<Node>,
    /// The scene's cameras.
    pub cameras: Vec<Camera>,
    /// The light of each group of lights, if it was kept apart: then radiosity is their sum.
    pub lights: Vec<LightShare>,
    /// What arrives at each vertex; empty in a mesh read from a file.
    pub irradiance: Vec<Irradiance>,
    /// The leaf of the solution's mesh that each triangle is part of; empty in a mesh read from a file.
    pub leaves: Vec<ElementId>,
    /// Places of vertices that lie inside an edge of another leaf, of the same surface or of one that meets
    /// it there; all have become corners of triangles. Zero in a mesh read from a file.
    pub hanging: usize,
}

/// Mean of a channel of a picture, as a share of that of its brightest one, below which it says nothing of the light.
const LEAST_MEAN: f64 = 1e-3;

/// Least light in a channel, as a share of that in the brightest one: what is shown has a ratio in all channels.
const TRACE: f64 = 1e-6;

impl TriMesh {
    /// Radiosity, W/m², that a textured surface would have at a vertex if its picture were white: this times the
    /// picture is the textured radiosity. Zero where the picture is black all around.
    ///
    /// Channels that the picture has next to nothing of are lit as its brightest one is.
    pub fn light(&self, vertex: usize) -> Rgb {
        let (radiosity, mean) = (self.radiosity[vertex], self.texture_mean[vertex]);
        let channel = mean.max_position();
        if mean[channel] <= 0.0 {
            return Rgb::ZERO;
        }
        let is_known = mean.cmpge(Rgb::splat(LEAST_MEAN * mean[channel]));
        let light =
            Rgb::select(is_known, radiosity / mean, Rgb::splat(radiosity[channel] / mean[channel]));
        light.max(Rgb::splat(TRACE * light.max_element()))
    }

    /// Where coordinates in single precision are to begin, m: the origin, unless the mesh is far from it.
    pub fn local_origin(&self) -> DVec3 {
        let (low, high) = self.bounds();
        local_origin(low, high).unwrap_or_default()
    }

    /// Least and greatest coordinates of the triangles, m; both zero if there is none.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let mut corners = self.triangles.iter().flatten().map(|&c| self.positions[c as usize]);
        let Some(first) = corners.next() else {
            return (DVec3::ZERO, DVec3::ZERO);
        };
        corners.fold((first, first), |(low, high), p| (low.min(p), high.max(p)))
    }
}

/// The light of one group of lights.
#[derive(Clone, Debug, PartialEq)]
pub struct LightShare {
    /// The lights, and how strong they are.
    pub group: LightGroup,
    /// Radiosity at a strength of 1, W/m², one per vertex of the mesh.
    pub radiosity: Vec<Rgb>,
}

/// Light that arrives at a vertex, W/m²: B = E + ρ (direct + indirect).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Irradiance {
    /// Straight from emitters.
    pub direct: Rgb,
    /// Reflected by other surfaces.
    pub indirect: Rgb,
    /// Straight from emitters on the vertex's own facet alone: another than `direct` only where facets
    /// of a curved surface share their light.
    pub direct_on_facet: Rgb,
}

impl Irradiance {
    /// Between this and another, at a `share` of the way, 0..=1.
    pub(super) fn lerp(self, other: Self, share: f64) -> Self {
        Self {
            direct: self.direct.lerp(other.direct, share),
            indirect: self.indirect.lerp(other.indirect, share),
            direct_on_facet: self.direct_on_facet.lerp(other.direct_on_facet, share),
        }
    }
}

/// A run of triangles of one material and object.
#[derive(Clone, Debug, Default)]
pub struct MeshPart {
    /// The material's name.
    pub name: String,
    /// Range of indices into [`TriMesh::triangles`].
    pub triangles: Range<usize>,
    /// Index into [`TriMesh::textures`].
    pub texture: Option<u32>,
    /// Alpha of the texture, 0..=1, below which there is a hole.
    pub cutoff: Option<f64>,
    /// Index into [`TriMesh::objects`].
    pub object: Option<u32>,
}
