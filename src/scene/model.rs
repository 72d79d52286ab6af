//! The scene itself: polygons in metres, what they look like, and what else the file tells of them.

use super::ids::MaterialId;
use std::path::PathBuf;

use glam::{DVec2, DVec3, Vec3};
use serde::Serialize;
use smallvec::SmallVec;

use super::camera::Camera;
use super::light::NamedLight;
use super::material::{Material, Sampler, Texture};

/// A scene of polygons, in metres.
///
/// One that is made in code is checked by [`Scene::build`]; what is not, and cannot be looked at, has no surfaces, and
/// lighting it is an error that says why.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Corners of the faces, m.
    pub positions: Vec<DVec3>,
    /// The polygons, counter-clockwise seen from their front.
    pub faces: Vec<Face>,
    /// Names of the objects (OBJ `o`/`g`, glTF nodes) that faces belong to.
    pub objects: Vec<String>,
    /// The hierarchy that objects and cameras stand in, parents before children; empty in an OBJ file, which has none.
    pub nodes: Vec<Node>,
    /// How faces look and glow.
    pub materials: Vec<Material>,
    /// Pictures that materials refer to.
    pub textures: Vec<Texture>,
    /// Lights without a surface.
    pub lights: Vec<NamedLight>,
    /// True if light was added by lumens, candela or lux: then people want to be told of light in lumens, too.
    pub photometric: bool,
    /// Views the file offers, in its order.
    pub cameras: Vec<Camera>,
    /// Repairs and warnings, a line each, for the user to read.
    pub notes: Vec<String>,
    /// The files that all this was read from, so that nothing is written in their place.
    pub files: Vec<PathBuf>,
}

/// A node of a scene's hierarchy. What it moves is where it belongs already.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Node {
    /// The file's name for it, empty if it has none.
    pub name: String,
    /// Index into [`Scene::nodes`], below its own.
    pub parent: Option<u32>,
    /// Index into [`Scene::objects`].
    pub object: Option<u32>,
    /// Index into [`Scene::cameras`].
    pub camera: Option<u32>,
}

/// A planar polygon; its per-corner lists are empty or as long as `vertices`.
#[derive(Clone, Debug)]
pub struct Face {
    /// Indices into [`Scene::positions`], at least three.
    pub vertices: SmallVec<[u32; 4]>,
    /// Unit normals of the curved surface that the face approximates; empty for flat faces.
    pub normals: SmallVec<[Vec3; 4]>,
    /// Texture coordinates, origin at the picture's top left as in glTF; empty without texture.
    pub uvs: SmallVec<[DVec2; 4]>,
    /// Factors on the material's reflectance, 0..=1 per channel, linear between the corners; empty for 1.
    pub tints: SmallVec<[Vec3; 4]>,
    /// Its material.
    pub material: MaterialId,
    /// Index into [`Scene::objects`].
    pub object: u32,
}

impl Face {
    /// Where its corners are, m.
    pub(crate) fn corners(&self, positions: &[DVec3]) -> SmallVec<[DVec3; 4]> {
        self.vertices.iter().filter_map(|&vertex| positions.get(vertex as usize)).copied().collect()
    }
}

impl Default for Face {
    fn default() -> Self {
        let (vertices, normals, uvs) = (SmallVec::new(), SmallVec::new(), SmallVec::new());
        Self { vertices, normals, uvs, tints: SmallVec::new(), material: MaterialId(0), object: 0 }
    }
}

impl Scene {
    /// Smallest and largest corner coordinates of all faces, m; `None` without faces.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let corners = self.faces.iter().flat_map(|face| &face.vertices);
        corners
            .filter_map(|&vertex| self.positions.get(vertex as usize))
            .map(|&p| (p, p))
            .reduce(|(low, high), (p, _)| (low.min(p), high.max(p)))
    }

    /// Diagonal of [`Self::bounds`], m; 0 without faces.
    pub fn extent(&self) -> f64 {
        self.bounds().map_or(0.0, |(low, high)| low.distance(high))
    }

    /// Adds a material.
    pub fn add_material(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// A texture of the same picture as one that there is, read by another sampler.
    pub(super) fn add_texture_like(&mut self, known: u32, sampler: Sampler) -> u32 {
        let texture = Texture { sampler, ..self.textures[known as usize].clone() };
        self.textures.push(texture);
        self.textures.len() as u32 - 1
    }

    /// Drops the faces of some materials; tells how many.
    pub(super) fn leave_out(&mut self, materials: &[usize]) -> usize {
        let before = self.faces.len();
        self.faces.retain(|face| !materials.contains(&(face.material.index())));
        before - self.faces.len()
    }

    /// Indices of the faces whose material emits light.
    pub fn emitters(&self) -> impl Iterator<Item = usize> {
        self.faces.iter().enumerate().filter_map(|(index, face)| {
            let material = self.materials.get(face.material.index())?;
            (material.emission.max_element() > 0.0).then_some(index)
        })
    }

    /// True if some face or some light emits.
    pub fn is_lit(&self) -> bool {
        !self.lights.is_empty() || self.emitters().next().is_some()
    }
}
