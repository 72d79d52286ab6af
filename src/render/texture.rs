//! Colours of a texture between its texels.

use glam::{DVec2, DVec3, Vec2};

use crate::colour::Rgb;
use crate::scene::Texture;

/// Colour at `uv`, origin at the picture's top left, as its sampler mixes texels; white if the texture is empty.
pub(super) fn sample(texture: &Texture, uv: Vec2) -> Rgb {
    let at = |index: usize| {
        let texel = texture.texels.get(index);
        texel.map_or(Rgb::ONE, |[r, g, b]| DVec3::new(r.into(), g.into(), b.into()))
    };
    texture.mixed(on_texels(texture, uv), at)
}

/// Opacity at `uv`, 0..=1, mixed likewise.
pub(super) fn opacity(texture: &Texture, uv: Vec2) -> f64 {
    texture.opacity(on_texels(texture, uv))
}

fn on_texels(texture: &Texture, uv: Vec2) -> DVec2 {
    uv.as_dvec2() * DVec2::new(f64::from(texture.width), f64::from(texture.height))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Sampler, Wrap};

    fn black_and_white(wrap: Wrap) -> Texture {
        Texture {
            width: 2,
            height: 1,
            texels: vec![[0.0; 3], [1.0; 3]].into(),
            sampler: Sampler { wrap: [wrap; 2], nearest: false },
            ..Texture::default()
        }
    }

    #[test]
    fn texels_keep_their_colour_at_their_centres_and_mix_between() {
        let texture = black_and_white(Wrap::Repeat);
        for (u, expected) in [(0.25, 0.0), (0.75, 1.0), (0.5, 0.5), (1.0, 0.5), (-0.25, 1.0)] {
            assert!((sample(&texture, Vec2::new(u, 0.5)).x - expected).abs() < 1e-6, "{u}");
        }
    }

    #[test]
    fn clamped_textures_continue_their_border_and_mirrored_ones_turn_back() {
        for (wrap, u, expected) in [
            (Wrap::Clamp, -3.0, 0.0),
            (Wrap::Clamp, 0.0, 0.0),
            (Wrap::Clamp, 1.0, 1.0),
            (Wrap::Clamp, 7.0, 1.0),
            (Wrap::Mirror, 1.0, 1.0),
            (Wrap::Mirror, 1.75, 0.0),
            (Wrap::Mirror, -0.75, 1.0),
            (Wrap::Mirror, 2.25, 0.0),
        ] {
            let found = sample(&black_and_white(wrap), Vec2::new(u, 0.5)).x;
            assert_eq!(found, expected, "{wrap:?} {u}");
        }
    }

    #[test]
    fn nearest_texels_are_not_mixed_and_opacities_are_as_colours_are() {
        let mut texture = black_and_white(Wrap::Repeat);
        texture.alpha = vec![0, 255];
        assert!((opacity(&texture, Vec2::splat(0.5)) - 0.5).abs() < 1e-6);
        texture.sampler.nearest = true;
        for (u, expected) in [(0.49, 0.0), (0.51, 1.0), (1.01, 0.0)] {
            let at = Vec2::new(u, 0.5);
            assert_eq!(
                (sample(&texture, at).x, opacity(&texture, at)),
                (expected, expected),
                "{u}"
            );
        }
    }
}
