//! What a file says, every default settled, every repair reported.
//!
//! Nothing downstream asks where a value came from: positions are metres with Y up, colours are
//! linear, emission is radiance, lights are in watts, texture coordinates have their transforms applied.

mod adding;
mod backdrop;
pub(crate) mod boxes;
mod build;
mod camera;
mod corners;
mod daylight;
mod gltf;
mod ies;
mod junctions;
mod light;
mod load;
mod material;
mod mixed;
mod named;
mod names;
mod notes;
mod obj;
mod overrides;
mod photometry;
mod ply;
mod polygon;
mod repair;
mod sides;
mod sight;
mod stl;
mod texels;
mod text;
mod texture;
mod up;
mod weld;

use std::path::PathBuf;

use glam::{DVec2, DVec3, Vec3};
use smallvec::SmallVec;

pub(crate) use self::gltf::sampler_of;
pub use adding::{Amount, AreaLight};
pub use camera::Camera;
pub(crate) use light::SUN_RADIUS;
pub use light::{DESIGN_SKY, Light, NamedLight, Sky, clear_sun};
pub use load::load;
pub use material::{MAX_REFLECTANCE, Material, Sampler, Texture, Wrap};
pub(crate) use names::{matches, named};
pub(crate) use notes::{counted, note_count};
pub use photometry::Photometry;
pub(crate) use polygon::area_vector;
pub use sides::{Sides, settle_sides};
pub use texels::Texels;
pub(crate) use texture::{decode, mean};
pub use up::Up;

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
#[derive(Clone, Debug, Default, PartialEq, Eq)]
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
    /// Index into [`Scene::materials`].
    pub material: u32,
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
        Self { vertices, normals, uvs, tints: SmallVec::new(), material: 0, object: 0 }
    }
}

/// How to read a file that leaves something open.
#[derive(Clone, Debug)]
pub struct LoadOptions {
    /// Metres per unit of the file's coordinates, default 1.
    pub metres_per_unit: f64,
    /// Which axis of the file is up, default Y.
    pub up: Up,
    /// What the numbers of emission are, default radiance.
    pub emission: EmissionUnit,
    /// Which sides of faces reflect and emit.
    pub two_sided: Sides,
}

/// The unit in which a file gives what its materials emit, be it `Ke` or glTF emission.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EmissionUnit {
    /// Radiance, W/(m² sr), as most exporters write.
    #[default]
    Radiance,
    /// Luminance, cd/m², as the text of glTF wants; 683 lm/W.
    Nits,
}

impl Default for LoadOptions {
    fn default() -> Self {
        let emission = EmissionUnit::Radiance;
        Self { metres_per_unit: 1.0, up: Up::Y, emission, two_sided: Sides::Auto }
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

    /// A texture of the same picture as one that there is, read by another sampler.
    fn add_texture_like(&mut self, known: u32, sampler: Sampler) -> u32 {
        let texture = Texture { sampler, ..self.textures[known as usize].clone() };
        self.textures.push(texture);
        self.textures.len() as u32 - 1
    }

    /// Drops the faces of some materials; tells how many.
    fn leave_out(&mut self, materials: &[usize]) -> usize {
        let before = self.faces.len();
        self.faces.retain(|face| !materials.contains(&(face.material as usize)));
        before - self.faces.len()
    }

    /// Indices of the faces whose material emits light.
    pub fn emitters(&self) -> impl Iterator<Item = usize> {
        self.faces.iter().enumerate().filter_map(|(index, face)| {
            let material = self.materials.get(face.material as usize)?;
            (material.emission.max_element() > 0.0).then_some(index)
        })
    }

    /// True if some face or some light emits.
    pub fn is_lit(&self) -> bool {
        !self.lights.is_empty() || self.emitters().next().is_some()
    }
}
