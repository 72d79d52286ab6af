//! What a file may say at most: coordinates that are places, reflectance below 1, radiance that shines.

use std::path::Path;

use super::notes::listed;
use super::texture::mean;
use super::{MAX_REFLECTANCE, Scene, Texture};
use crate::colour::Rgb;
use crate::error::{Error, Result};

/// Coordinates beyond this are taken for a wrong unit or a broken file, m.
pub(super) const MAX_COORDINATE: f64 = 1e9;

/// Radiance beyond this is cut, W/(m² sr): about 10^5 suns, and products of it stay finite.
pub(crate) const MAX_RADIANCE: f64 = 1e12;

/// An error if a vertex lies beyond [`MAX_COORDINATE`].
pub(super) fn refuse_huge_coordinates(path: &Path, scene: &Scene) -> Result<()> {
    let fits = |x: f64| x.abs() <= MAX_COORDINATE;
    match scene.positions.iter().find(|p| !p.to_array().into_iter().all(fits)) {
        None => Ok(()),
        Some(p) => Err(Error::format(
            path,
            format!("the vertex ({}, {}, {}) m lies beyond {MAX_COORDINATE:e} m", p.x, p.y, p.z),
        )),
    }
}

/// `colour` with every channel a number in 0..=`limit`.
pub(crate) fn tamed(colour: Rgb, limit: f64) -> Rgb {
    let tame = |x: f64| if x.is_nan() { 0.0 } else { x.clamp(0.0, limit) };
    Rgb::new(tame(colour.x), tame(colour.y), tame(colour.z))
}

/// Brings reflectance into 0..=[`MAX_REFLECTANCE`] and emission into 0..=[`MAX_RADIANCE`].
pub(crate) fn limit_materials(scene: &mut Scene) {
    let (mut bright, mut wrong) = (Vec::new(), Vec::new());
    for material in &mut scene.materials {
        let texture = material.texture.and_then(|index| scene.textures.get(index as usize));
        if is_too_bright(material.reflectance, texture) {
            bright.push(material.name.clone());
        }
        let reflectance = tamed(material.reflectance, MAX_REFLECTANCE);
        let emission = tamed(material.emission, MAX_RADIANCE);
        // NaN equals nothing, so this also tells NaN from its replacement.
        if reflectance != material.reflectance.min(Rgb::splat(MAX_REFLECTANCE))
            || emission != material.emission
        {
            wrong.push(material.name.clone());
        }
        (material.reflectance, material.emission) = (reflectance, emission);
    }
    if !bright.is_empty() {
        let names = listed(&bright);
        scene.notes.push(format!("reflectance above {MAX_REFLECTANCE} clamped in {names}"));
    }
    if !wrong.is_empty() {
        let names = listed(&wrong);
        scene.notes.push(format!("negative, infinite or undefined colours clamped in {names}"));
    }
}

/// Whether more is reflected than may be, on average over a texture. A factor of 1 on a texture is no claim of that:
/// it becomes 0.99 in silence.
fn is_too_bright(reflectance: Rgb, texture: Option<&Texture>) -> bool {
    let is_above = |colour: Rgb| colour.max_element() > MAX_REFLECTANCE;
    is_above(reflectance) && texture.is_none_or(|texture| is_above(reflectance * mean(texture)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;

    #[test]
    fn a_texture_is_told_to_be_clamped_if_its_mean_times_its_factor_is_too_bright() {
        let texture =
            |texels: Vec<[f32; 3]>| Texture { texels: texels.into(), ..Texture::default() };
        let told = |factor: f64, texels: Vec<[f32; 3]>| {
            let textured = Material { texture: Some(0), ..Material::default() };
            let material = Material { reflectance: Rgb::splat(factor), ..textured };
            let mut scene = Scene {
                materials: vec![material],
                textures: vec![texture(texels)],
                ..Scene::default()
            };
            limit_materials(&mut scene);
            assert!(scene.materials[0].reflectance.max_element() <= MAX_REFLECTANCE);
            scene.notes.len()
        };
        assert_eq!(told(1.0, vec![[1.0; 3], [0.2; 3]]), 0);
        assert_eq!(told(1.5, vec![[1.0; 3], [0.2; 3]]), 0);
        assert_eq!(told(2.0, vec![[1.0; 3], [0.2; 3]]), 1);
        assert_eq!(told(1.0, vec![[1.0; 3]; 2]), 1);
    }

    #[test]
    fn reflectance_above_limit_is_clamped_with_a_note() {
        let white = Material { reflectance: Rgb::new(1.0, 0.5, 2.0), ..Material::default() };
        let mut scene = Scene { materials: vec![white; 2], ..Scene::default() };
        limit_materials(&mut scene);
        assert_eq!(scene.materials[1].reflectance, Rgb::new(0.99, 0.5, 0.99));
        assert_eq!(scene.notes.len(), 1, "{:?}", scene.notes);
    }

    #[test]
    fn colours_that_are_no_colours_become_black() {
        let odd = Material {
            reflectance: Rgb::new(f64::NAN, -1.0, 0.5),
            emission: Rgb::new(f64::INFINITY, 1.0, f64::NEG_INFINITY),
            ..Material::default()
        };
        let mut scene = Scene { materials: vec![odd], ..Scene::default() };
        limit_materials(&mut scene);
        assert_eq!(scene.materials[0].reflectance, Rgb::new(0.0, 0.0, 0.5));
        assert_eq!(scene.materials[0].emission, Rgb::new(MAX_RADIANCE, 1.0, 0.0));
        assert_eq!(scene.notes.len(), 1, "{:?}", scene.notes);
    }
}
