//! One picture for what shines and has pictures: its emission and the light that it reflects.
//!
//! Such a surface sends E Q + H P: its exitance E on a picture Q, and on a picture P the light H that it would send if
//! P were white. Meshes are drawn by one picture times the light at vertices, here and in every program that reads
//! them. So both become one picture, T = E Q + h P, with the mean h of H at all vertices, and the light at a vertex is
//! its radiosity by the mean of T around it. That is right in each texel where H is h, or next to nothing beside E Q,
//! and on average everywhere.

use glam::Vec2;

use super::surface_triangles::{LitCorner, SurfaceTriangles};
use crate::colour::Rgb;
use crate::scene::{Material, MaterialId, Scene, Texture};
use crate::surface::{Surface, Surfaces};

/// The pictures that the mesh of a scene may have, by their numbers: those of the scene and, empty as long as there is
/// no light, one for each material that shines and has a picture.
pub fn mesh_pictures(scene: &Scene) -> Vec<Texture> {
    let has_picture = |material: &&Material| {
        let picture = material.texture.or(material.emission_texture);
        material.emission.max_element() > 0.0 && picture.is_some()
    };
    let shining = scene.materials.iter().filter(has_picture).map(|_| Texture::default());
    scene.textures.iter().cloned().chain(shining).collect()
}

/// What the picture of a material that shines is made of.
#[derive(Debug)]
pub(super) struct Glow<'a> {
    colour: Option<&'a Texture>,
    emission: Option<&'a Texture>,
    /// E, W/m².
    exitance: Rgb,
    /// h, W/m².
    reflected: Rgb,
    /// What is 1 in the picture, W/m²; no channel of it is above.
    white: f64,
}

impl<'a> Glow<'a> {
    /// Nothing for a material that does not shine or has no picture.
    pub(super) fn of_material(
        surfaces: &'a Surfaces,
        id: MaterialId,
        all: &[SurfaceTriangles],
    ) -> Option<Self> {
        let material = &surfaces[id];
        let [colour, emission] = [material.texture, material.emission_texture].map(|texture| {
            let texture = texture.map(|number| &surfaces.textures[number as usize]);
            texture.filter(|texture| !texture.texels.is_empty())
        });
        colour.or(emission)?;
        let is_lamp = |surface: &&Surface| surface.material == id && surface.is_emitter();
        let exitance = surfaces.list.iter().find(is_lamp)?.exitance;
        let own = all.iter().filter(|triangles| triangles.material == id);
        let (mut sum, mut means) = (Rgb::ZERO, Rgb::ZERO);
        for corner in own.flat_map(|triangles| &triangles.corners) {
            sum += corner.radiosity - corner.emitted;
            means += corner.texture_mean;
        }
        let reflected = Rgb::select(means.cmpgt(Rgb::ZERO), sum / means, Rgb::ZERO).max(Rgb::ZERO);
        let most = |texture: Option<&Texture>| {
            texture.map_or(1.0, |t| f64::from(t.texels.iter().flatten().fold(0.0, f32::max)))
        };
        let white = (exitance * most(emission) + reflected * most(colour)).max_element();
        (white > 0.0).then_some(Self { colour, emission, exitance, reflected, white })
    }

    /// Adds the picture to others and tells its number.
    pub(super) fn added_to(&self, textures: &mut Vec<Texture>) -> u32 {
        textures.push(self.picture());
        textures.len() as u32 - 1
    }

    /// Mean of the picture around a corner.
    pub(super) fn mean(&self, corner: &LitCorner) -> Rgb {
        (corner.emitted + self.reflected * corner.texture_mean) / self.white
    }

    /// As fine as the finer of both pictures, and laid on as that of the emission is.
    fn picture(&self) -> Texture {
        let both = || [self.emission, self.colour].into_iter().flatten();
        let width = both().map(|texture| texture.width).max().unwrap_or_default();
        let height = both().map(|texture| texture.height).max().unwrap_or_default();
        let place = |at: u32| {
            let [column, row] = [at % width, at / width].map(|number| number as f32 + 0.5);
            Vec2::new(column / width as f32, row / height as f32)
        };
        let mixed = |texture: Option<&Texture>, uv| texture.map_or(Rgb::ONE, |t| t.mixed(uv));
        let texel = |at: u32| {
            let uv = place(at);
            let (glow, light) = (mixed(self.emission, uv), mixed(self.colour, uv));
            let sent = self.exitance * glow + self.reflected * light;
            (sent / self.white).as_vec3().to_array()
        };
        let holes = self.colour.filter(|colour| !colour.alpha.is_empty());
        let opacity = |at: u32| (255.0 * holes.map_or(1.0, |t| t.opacity(place(at)))).round() as u8;
        let count = width * height;
        Texture {
            name: both().map(|texture| texture.name.as_str()).collect::<Vec<_>>().join(" and "),
            width,
            height,
            texels: (0..count).map(texel).collect(),
            alpha: if holes.is_some() { (0..count).map(opacity).collect() } else { Vec::new() },
            sampler: both().next().map(|texture| texture.sampler).unwrap_or_default(),
            ..Texture::default()
        }
    }
}
