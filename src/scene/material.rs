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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// Along u and v.
    pub wrap: [Wrap; 2],
    /// Whether texels are squares of one colour each when seen from near, and not mixed.
    pub nearest: bool,
}

/// A picture, decoded and as it came.
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

    /// Opacity at a place in texels from the top left, 0..=1, as the sampler mixes texels.
    pub(crate) fn opacity(&self, place: DVec2) -> f64 {
        let at =
            |index: usize| self.alpha.get(index).map_or(1.0, |&alpha| f64::from(alpha) / 255.0);
        self.mixed(place, |index| Rgb::splat(at(index))).x
    }

    /// What texels hold, by their index, at a place in texels from the top left, as the sampler mixes them; 1 for a
    /// picture without texels.
    pub(crate) fn mixed(&self, place: DVec2, at: impl Fn(usize) -> Rgb) -> Rgb {
        if self.width == 0 || self.height == 0 || !place.is_finite() {
            return Rgb::ONE;
        }
        let [wrap_u, wrap_v] = self.sampler.wrap;
        let at = |column: f64, row: f64| {
            let row = wrap_v.texel(row, self.height);
            at(row * self.width as usize + wrap_u.texel(column, self.width))
        };
        if self.sampler.nearest {
            return at(place.x.floor(), place.y.floor());
        }
        let (x, y) = (place.x - 0.5, place.y - 0.5);
        let (column, row) = (x.floor(), y.floor());
        let above = at(column, row).lerp(at(column + 1.0, row), x - column);
        let below = at(column, row + 1.0).lerp(at(column + 1.0, row + 1.0), x - column);
        above.lerp(below, y - row)
    }
}
