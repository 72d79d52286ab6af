//! A picture of a mesh: what it holds.

use glam::Vec3;

use super::colours::Swatch;
use super::view::View;
use crate::colour::Rgb;

/// Linear pixels; all lists run row by row from the top and hold `width * height` values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// What is shown.
    pub view: View,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear RGB, the background included: radiance, W/(m² sr), of light, mesh and radiosity;
    /// irradiance, W/m²; the share of the allowed error; or colours that stand for levels and reasons.
    pub values: Vec<Vec3>,
    /// The values that the whites of pictures on surfaces would have, which [tone mapping](crate::tone::tone_map_picture)
    /// goes by; empty in pictures of meshes without textures.
    pub whites: Vec<Vec3>,
    /// Share of each pixel that shows the mesh, 0..=1.
    pub coverage: Vec<f32>,
    /// Strength of the mesh's lines, 0..=1; empty in views without.
    pub lines: Vec<f32>,
    /// Value where there is no mesh.
    pub background: Rgb,
    /// Whether it shows a solution that was stopped before it was done, as far as its
    /// [`Subject`](super::Subject) knows; a PNG says so in its corner.
    pub unfinished: bool,
    /// What the mesh is made of, in words.
    pub(super) caption: String,
    /// What colours stand for, where values are colours.
    pub(super) key: Vec<Swatch>,
}

impl Picture {
    /// The same light and lines, with no legend below.
    #[must_use]
    pub fn without_legend(self) -> Self {
        let view = if self.view.shows_radiance() { View::Light } else { self.view };
        Self { view, ..self }
    }
}
