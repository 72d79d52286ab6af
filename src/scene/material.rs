//! Diffuse reflectance, emission and the pictures they are taken from.

use std::sync::Arc;

use glam::{DVec2, Vec3};

use super::Texels;
use crate::colour::Rgb;

/// Largest reflectance a scene may hold in a channel: at 1, light in a closed room would never die out.
pub const MAX_REFLECTANCE: f64 = 0.99;

/// A diffuse material.
#[derive(Clone, Debug)]
pub struct Material {
    /// The file's name for it.
    pub name: String,
    /// Diffuse reflectance ρ per channel, 0..=0.99; multiplied by the texture where there is one.
    pub reflectance: Rgb,
    /// Emitted radiance L, W/(m² sr) per channel; multiplied by the emission texture.
    pub emission: Rgb,
    /// True if both sides reflect and emit; otherwise the back is black.
    pub double_sided: bool,
    /// Index into [`super::Scene::textures`] of the picture of the reflectance.
    pub texture: Option<u32>,
    /// Index into [`super::Scene::textures`] of the picture of the emission.
    pub emission_texture: Option<u32>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: "default".to_owned(),
            reflectance: Rgb::splat(0.5),
            emission: Rgb::ZERO,
            double_sided: false,
            texture: None,
            emission_texture: None,
        }
    }
}

/// A picture with repeating borders unless clamped, decoded and as it came.
#[derive(Clone, Debug, Default)]
pub struct Texture {
    /// File name or the glTF image's name.
    pub name: String,
    /// Texels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` texels.
    pub texels: Texels,
    /// The encoded picture as read, PNG or JPEG, written out again on export; empty if it was neither.
    pub encoded: Arc<[u8]>,
    /// `image/png` or `image/jpeg`.
    pub mime_type: String,
    /// Whether coordinates outside 0..=1 repeat the picture (else they take its border), along u and v.
    pub repeat: [bool; 2],
}

impl Texture {
    /// The texel at texture coordinates `uv`, linear RGB; black for a picture without texels.
    pub fn sample(&self, uv: DVec2) -> Rgb {
        let index = |coordinate: f64, count: u32, repeat: bool| {
            let wrapped = if repeat { coordinate - coordinate.floor() } else { coordinate };
            ((wrapped * f64::from(count)) as usize).min(count.saturating_sub(1) as usize)
        };
        let column = index(uv.x, self.width, self.repeat[0]);
        let row = index(uv.y, self.height, self.repeat[1]);
        let texel = self.texels.get(row * self.width as usize + column);
        texel.map_or(Rgb::ZERO, |texel| Vec3::from(texel).as_dvec3())
    }
}
