//! The mean of a texture over a piece of a surface.

use glam::{DAffine2, DVec2};

use super::model::{Surface, Surfaces};
use super::tint::Tint;
use crate::colour::Rgb;
use crate::geometry::polygon::{Convex, Line, area, bounds, centroid, edges};
use crate::scene::Texture;

/// Most texels that are weighed one by one, along one axis; more are sampled at so many places.
const MOST_TEXELS: f64 = 48.0;

/// Mean colour of the reflectance's and of the emission's texture over a convex polygon on a
/// surface; 1 without.
pub fn mean_texture(surfaces: &Surfaces, surface: &Surface, outline: &[DVec2]) -> [Rgb; 2] {
    let material = &surfaces[surface.material];
    [material.texture, material.emission_texture].map(|texture| {
        let texture = texture.map(|t| &surfaces.textures[t as usize]);
        texture.zip(surface.uv).map_or(Rgb::ONE, |(texture, uv)| mean(texture, uv, outline, None))
    })
}

/// Mean diffuse reflectance over a convex polygon on a surface, tint and texture included.
pub fn mean_reflectance(surfaces: &Surfaces, surface: &Surface, outline: &[DVec2]) -> Rgb {
    let texture = surfaces[surface.material].texture;
    let texture = texture.map(|t| &surfaces.textures[t as usize]).zip(surface.uv);
    let varied = match (surface.tint.uniform(), texture) {
        (Some(tint), None) => tint,
        (Some(tint), Some((texture, uv))) => tint * mean(texture, uv, outline, None),
        // What is linear has its mean at the centroid.
        (None, None) => surface.tint.at(centroid(outline)),
        (None, Some((texture, uv))) => mean(texture, uv, outline, Some(&surface.tint)),
    };
    surface.reflectance * varied
}

/// Mean of a texture, times a tint if there is one, over a polygon: exact, unless it has too many texels.
fn mean(texture: &Texture, uv: DAffine2, outline: &[DVec2], tint: Option<&Tint>) -> Rgb {
    let size = DVec2::new(f64::from(texture.width), f64::from(texture.height));
    let on_texels: Convex = outline.iter().map(|&p| uv.transform_point2(p) * size).collect();
    let [low, high] = bounds(&on_texels);
    let to_plane = tint.map(|tint| (tint, uv.inverse()));
    let tinted = |colour: Rgb, middle: &dyn Fn() -> DVec2| match to_plane {
        Some((tint, inverse)) => colour * tint.at(inverse.transform_point2(middle() / size)),
        None => colour,
    };
    let sum = if (high - low).max_element() <= MOST_TEXELS {
        weighed(&on_texels, |texel, part| {
            tinted(texture.sample((texel + 0.5) / size), &|| centroid(part))
        })
    } else {
        sampled(&on_texels, |place| tinted(texture.sample(place / size), &|| place))
    };
    let middle = || on_texels.iter().sum::<DVec2>() / on_texels.len().max(1) as f64;
    sum.unwrap_or_else(|| tinted(texture.sample(middle() / size), &middle))
}

/// Mean over a polygon, in texels, each weighed by the part of it that is inside.
fn weighed(outline: &Convex, colour: impl Fn(DVec2, &[DVec2]) -> Rgb) -> Option<Rgb> {
    let (mut sum, mut whole) = (Rgb::ZERO, 0.0);
    let [low, high] = bounds(outline);
    for row in low.y.floor() as i64..high.y.ceil() as i64 {
        let strip = between(outline, 1, row as f64);
        let [low, high] = bounds(&strip);
        for column in low.x.floor() as i64..high.x.ceil() as i64 {
            let inside = between(&strip, 0, column as f64);
            let part = area(&inside).abs();
            if part > 0.0 {
                sum += colour(DVec2::new(column as f64, row as f64), &inside) * part;
                whole += part;
            }
        }
    }
    (whole > 0.0).then(|| sum / whole)
}

/// The part of a convex polygon between a coordinate and one more.
fn between(outline: &Convex, axis: usize, low: f64) -> Convex {
    let along = [DVec2::NEG_Y, DVec2::X][axis];
    let part = |outline: &Convex, low: f64, along: DVec2| {
        let from = DVec2::splat(low);
        let [left, _] = Line::through([from, from + along]).split(outline, 0.0);
        left.unwrap_or_default()
    };
    part(&part(outline, low, along), low + 1.0, -along)
}

/// Mean over a grid of places inside a polygon.
fn sampled(outline: &Convex, colour: impl Fn(DVec2) -> Rgb) -> Option<Rgb> {
    let [low, high] = bounds(outline);
    let count = MOST_TEXELS as u32;
    let turn = area(outline).signum();
    let borders: Vec<Line> = edges(outline).map(Line::through).collect();
    let (mut sum, mut samples) = (Rgb::ZERO, 0.0);
    for row in 0..count {
        for column in 0..count {
            let share = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let place = low + (high - low) * share / MOST_TEXELS;
            if borders.iter().all(|border| border.side(place, 0.0) * turn >= 0.0) {
                sum += colour(place);
                samples += 1.0;
            }
        }
    }
    (samples > 0.0).then(|| sum / samples)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_count_by_their_share_of_a_polygon() {
        // Left half 1, right half 0, over a triangle of which three quarters are left.
        let outline: Convex =
            [[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]].map(DVec2::from).into_iter().collect();
        let colour = |texel: DVec2| Rgb::splat(f64::from(u8::from(texel.x < 4.0)));
        let by_texel = weighed(&outline, |texel, _| colour(texel)).map_or(0.0, |mean| mean.x);
        let by_place = sampled(&outline, colour).map_or(0.0, |mean| mean.x);
        assert!((by_texel - 0.75).abs() < 1e-12, "{by_texel}");
        assert!((by_place - 0.75).abs() < 0.02, "{by_place}");
        // The other way round, between texels, and beyond the picture.
        let turned: Convex = outline.iter().rev().map(|&p| p - DVec2::splat(0.25)).collect();
        let found = weighed(&turned, |texel, _| colour(texel + 0.25)).map_or(0.0, |mean| mean.x);
        assert!((found - (1.0 - (3.75_f64 / 8.0).powi(2))).abs() < 1e-12, "{found}");
    }
}
