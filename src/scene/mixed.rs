//! Colours of a texture between its texels.

use glam::{DVec2, DVec3, Vec2};

use super::Texture;
use crate::colour::Rgb;

impl Texture {
    /// Colour at `uv`, origin at the picture's top left, as its sampler mixes texels; white if there are none.
    pub(crate) fn mixed(&self, uv: Vec2) -> Rgb {
        let at = |index: usize| {
            let texel = self.texels.get(index);
            texel.map_or(Rgb::ONE, |[r, g, b]| DVec3::new(r.into(), g.into(), b.into()))
        };
        self.mix(self.on_texels(uv), at)
    }

    /// Opacity at `uv`, 0..=1, mixed likewise.
    pub(crate) fn opacity(&self, uv: Vec2) -> f64 {
        self.opacity_at(self.on_texels(uv))
    }

    fn on_texels(&self, uv: Vec2) -> DVec2 {
        uv.as_dvec2() * DVec2::new(f64::from(self.width), f64::from(self.height))
    }

    /// Opacity at a place in texels from the top left, 0..=1.
    pub(crate) fn opacity_at(&self, place: DVec2) -> f64 {
        let at =
            |index: usize| self.alpha.get(index).map_or(1.0, |&alpha| f64::from(alpha) / 255.0);
        self.mix(place, |index| Rgb::splat(at(index))).x
    }

    /// What texels hold, by their index, at a place in texels from the top left, as the sampler mixes them; 1 for a
    /// picture without texels.
    pub(crate) fn mix(&self, place: DVec2, at: impl Fn(usize) -> Rgb) -> Rgb {
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
            assert!((texture.mixed(Vec2::new(u, 0.5)).x - expected).abs() < 1e-6, "{u}");
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
            let found = black_and_white(wrap).mixed(Vec2::new(u, 0.5)).x;
            assert_eq!(found, expected, "{wrap:?} {u}");
        }
    }

    #[test]
    fn nearest_texels_are_not_mixed_and_opacities_are_as_colours_are() {
        let mut texture = black_and_white(Wrap::Repeat);
        texture.alpha = vec![0, 255];
        assert!((texture.opacity(Vec2::splat(0.5)) - 0.5).abs() < 1e-6);
        texture.sampler.nearest = true;
        for (u, expected) in [(0.49, 0.0), (0.51, 1.0), (1.01, 0.0)] {
            let at = Vec2::new(u, 0.5);
            assert_eq!((texture.mixed(at).x, texture.opacity(at)), (expected, expected), "{u}");
        }
    }
}
