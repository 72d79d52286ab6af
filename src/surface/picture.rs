//! The mean of a texture over a piece of a surface.

use glam::{DAffine2, DVec2};

use super::polygon::{Line, bounds};
use super::{Surface, Surfaces};
use crate::colour::Rgb;
use crate::scene::Texture;

/// Most samples along one axis; finer textures are sampled, not integrated.
const MOST_SAMPLES: f64 = 48.0;

/// Mean colour of the reflectance's and of the emission's texture over a convex polygon on a
/// surface; 1 without.
pub fn mean_texture(surfaces: &Surfaces, surface: &Surface, outline: &[DVec2]) -> [Rgb; 2] {
    let material = &surfaces.materials[surface.material as usize];
    [material.texture, material.emission_texture].map(|texture| {
        let texture = texture.map(|t| &surfaces.textures[t as usize]);
        texture.zip(surface.uv).map_or(Rgb::ONE, |(texture, uv)| mean(texture, uv, outline))
    })
}

/// Mean over a grid as fine as the texels, as far as [`MOST_SAMPLES`] allows.
fn mean(texture: &Texture, uv: DAffine2, outline: &[DVec2]) -> Rgb {
    let [low, high] = bounds(outline);
    let size = DVec2::new(f64::from(texture.width), f64::from(texture.height));
    let texels = |side: DVec2| (uv.transform_vector2(side) * size).length();
    let count = |side: DVec2| texels(side).ceil().clamp(4.0, MOST_SAMPLES) as u32;
    let extent = high - low;
    let (columns, rows) = (count(DVec2::new(extent.x, 0.0)), count(DVec2::new(0.0, extent.y)));

    let borders: Vec<Line> = super::polygon::edges(outline).map(Line::through).collect();
    let (mut sum, mut samples) = (Rgb::ZERO, 0.0);
    for row in 0..rows {
        for column in 0..columns {
            let share = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5)
                / DVec2::new(f64::from(columns), f64::from(rows));
            let place = low + extent * share;
            if borders.iter().all(|border| border.side(place, 0.0) >= 0.0) {
                sum += texture.sample(uv.transform_point2(place));
                samples += 1.0;
            }
        }
    }
    if samples > 0.0 {
        return sum / samples;
    }
    texture.sample(uv.transform_point2(super::polygon::centroid(outline)))
}
