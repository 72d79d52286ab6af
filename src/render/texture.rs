//! Colours of a texture between its texels.

use glam::{DVec3, Vec2};

use crate::colour::Rgb;
use crate::scene::Texture;

/// Bilinear colour at `uv`, origin at the picture's top left; white if the texture is empty.
pub(super) fn sample(texture: &Texture, uv: Vec2) -> Rgb {
    if texture.width == 0 || texture.height == 0 || !uv.is_finite() {
        return Rgb::ONE;
    }
    let x = f64::from(uv.x) * f64::from(texture.width) - 0.5;
    let y = f64::from(uv.y) * f64::from(texture.height) - 0.5;
    let (column, row) = (x.floor(), y.floor());
    let at = |column, row| texel(texture, column, row);
    let above = at(column, row).lerp(at(column + 1.0, row), x - column);
    let below = at(column, row + 1.0).lerp(at(column + 1.0, row + 1.0), x - column);
    above.lerp(below, y - row)
}

fn texel(texture: &Texture, column: f64, row: f64) -> Rgb {
    let column = wrapped(column, texture.width, texture.repeat[0]);
    let row = wrapped(row, texture.height, texture.repeat[1]);
    let index = row * texture.width as usize + column;
    texture.texels.get(index).map_or(Rgb::ONE, |[r, g, b]| DVec3::new(r.into(), g.into(), b.into()))
}

fn wrapped(index: f64, count: u32, repeat: bool) -> usize {
    let count = f64::from(count);
    let inside = if repeat { index.rem_euclid(count) } else { index };
    inside.clamp(0.0, count - 1.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn black_and_white(repeat: bool) -> Texture {
        Texture {
            width: 2,
            height: 1,
            texels: vec![[0.0; 3], [1.0; 3]].into(),
            repeat: [repeat; 2],
            ..Texture::default()
        }
    }

    #[test]
    fn texels_keep_their_colour_at_their_centres_and_mix_between() {
        let texture = black_and_white(true);
        for (u, expected) in [(0.25, 0.0), (0.75, 1.0), (0.5, 0.5), (1.0, 0.5), (-0.25, 1.0)] {
            assert!((sample(&texture, Vec2::new(u, 0.5)).x - expected).abs() < 1e-6, "{u}");
        }
    }

    #[test]
    fn clamped_textures_continue_their_border() {
        let texture = black_and_white(false);
        for (u, expected) in [(-3.0, 0.0), (0.0, 0.0), (1.0, 1.0), (7.0, 1.0)] {
            assert_eq!(sample(&texture, Vec2::new(u, 0.5)).x, expected, "{u}");
        }
    }
}
