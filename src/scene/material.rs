//! Diffuse reflectance, emission and the pictures they are taken from.

use std::sync::Arc;

use glam::{DVec2, Vec3};
use serde::Serialize;

use super::Texels;
use crate::colour::Rgb;

/// Largest reflectance a scene may hold in a channel: at 1, light in a closed room would never die out.
pub const MAX_REFLECTANCE: f64 = 0.99;

/// A diffuse material.
#[derive(Clone, Debug, Serialize)]
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
    /// Alpha of the reflectance's picture, 0..=1, below which there is no surface to be seen.
    pub cutoff: Option<f64>,
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
            cutoff: None,
        }
    }
}

/// What a picture shows beyond its borders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub enum Wrap {
    /// Itself again.
    #[default]
    Repeat,
    /// Itself again, every other time mirrored.
    Mirror,
    /// The colours of its border.
    Clamp,
}

impl Wrap {
    /// The texel, of `count` in a row or column, that lies at a whole number of texels from the first.
    pub(crate) fn texel(self, place: f64, count: u32) -> usize {
        let count = f64::from(count);
        let inside = match self {
            Self::Repeat => place.rem_euclid(count),
            Self::Mirror => {
                let there = place.rem_euclid(2.0 * count);
                there.min(2.0 * count - 1.0 - there)
            }
            Self::Clamp => place,
        };
        inside.clamp(0.0, (count - 1.0).max(0.0)) as usize
    }
}

/// How a picture is read between and beyond its texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub struct Sampler {
    /// Along u and v.
    pub wrap: [Wrap; 2],
    /// Whether texels are squares of one colour each when seen from near, and not mixed.
    pub nearest: bool,
}

/// A picture, decoded and as it came.
#[derive(Clone, Debug, Default, Serialize)]
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
    /// Opacities, 0 to 255, as many as texels; empty for a picture that is opaque all over.
    pub alpha: Vec<u8>,
    /// How it is read.
    pub sampler: Sampler,
}

/// Pictures with a channel at least as bright as this somewhere need not be brightened to be seen well.
const BRIGHT: f32 = 0.9;

impl Texture {
    /// The brightest channel of all texels, 0..=1, by which the picture is divided to be shown; 1 if that is near it.
    pub fn white(&self) -> f64 {
        let brightest = self.texels.iter().flatten().fold(0.0, f32::max);
        if brightest > 0.0 && brightest < BRIGHT { f64::from(brightest) } else { 1.0 }
    }

    /// The texel at texture coordinates `uv`, linear RGB; black for a picture without texels.
    pub fn sample(&self, uv: DVec2) -> Rgb {
        let [wrap_u, wrap_v] = self.sampler.wrap;
        let column = wrap_u.texel((uv.x * f64::from(self.width)).floor(), self.width);
        let row = wrap_v.texel((uv.y * f64::from(self.height)).floor(), self.height);
        let texel = self.texels.get(row * self.width as usize + column);
        texel.map_or(Rgb::ZERO, |texel| Vec3::from(texel).as_dvec3())
    }

    /// The same in half as many columns and rows, each texel the mean of four; no longer as a file had it.
    pub(crate) fn halved(&self) -> Self {
        let [width, height] = [self.width, self.height].map(|side| side.div_ceil(2));
        let index = |column: u32, row: u32| {
            (row.min(self.height - 1) * self.width + column.min(self.width - 1)) as usize
        };
        let four = |place: u32| {
            let (column, row) = (2 * (place % width), 2 * (place / width));
            [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| index(column + x, row + y))
        };
        let colour = |place: u32| -> [f32; 3] {
            let texels = four(place).map(|at| Vec3::from(self.texels.get(at).unwrap_or_default()));
            (texels.iter().sum::<Vec3>() / 4.0).into()
        };
        let opacity = |place: u32| {
            let sum: u32 = four(place).iter().map(|&at| u32::from(self.alpha[at])).sum();
            ((sum + 2) / 4) as u8
        };
        let has_holes = !self.alpha.is_empty();
        let alpha = if has_holes { (0..width * height).map(opacity).collect() } else { Vec::new() };
        Self {
            width,
            height,
            texels: (0..width * height).map(colour).collect(),
            alpha,
            encoded: [].into(),
            ..self.clone()
        }
    }
}
