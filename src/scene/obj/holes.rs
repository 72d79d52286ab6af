//! Pictures with the holes that another picture, `map_d`, cuts into them.

use glam::DVec2;

use crate::colour::{Rgb, luminance, srgb_from_linear};
use crate::scene::{Scene, Texels, Texture};

/// Opacity below which there is a hole: what lies between is rounded.
pub(super) const CUTOFF: f64 = 0.5;

/// The number of a texture with the colours of one and the opacities of another, white without the first; `None` where
/// that has no holes.
pub(super) fn with_holes(scene: &mut Scene, colours: Option<u32>, mask: u32) -> Option<u32> {
    let mask_texture = &scene.textures[mask as usize];
    if colours == Some(mask) {
        // One picture of both has its opacities beside its colours, or none.
        return has_holes(&mask_texture.alpha).then_some(mask);
    }
    let opacities = Texture { alpha: opacities(mask_texture), ..mask_texture.clone() };
    if !has_holes(&opacities.alpha) {
        return None;
    }
    let colours = colours.map(|colours| scene.textures[colours as usize].clone());
    let texture = match colours {
        Some(colours) => laid(colours, &opacities),
        None => Texture {
            texels: opacities.texels.iter().map(|_| [1.0; 3]).collect(),
            encoded: [].into(),
            mime_type: String::new(),
            ..opacities
        },
    };
    scene.textures.push(texture);
    Some(scene.textures.len() as u32 - 1)
}

fn has_holes(alpha: &[u8]) -> bool {
    alpha.iter().any(|&alpha| f64::from(alpha) / 255.0 < CUTOFF)
}

/// Opacities of a picture that is for them: those it has, or else how bright it is.
fn opacities(texture: &Texture) -> Vec<u8> {
    if !texture.alpha.is_empty() {
        return texture.alpha.clone();
    }
    let code = |texel: [f32; 3]| {
        let brightness = luminance(Rgb::from_array(texel.map(f64::from)));
        (srgb_from_linear(brightness) * 255.0).round() as u8
    };
    texture.texels.iter().map(code).collect()
}

/// Colours with opacities, with as many texels as the one of the two that has more.
fn laid(colours: Texture, opacities: &Texture) -> Texture {
    let texels = |texture: &Texture| u64::from(texture.width) * u64::from(texture.height);
    let size = |texture: &Texture| DVec2::new(texture.width.into(), texture.height.into());
    let larger = if texels(opacities) > texels(&colours) { opacities } else { &colours };
    let (width, height) = (larger.width, larger.height);
    let shares: Vec<DVec2> = (0..height)
        .flat_map(|row| (0..width).map(move |column| DVec2::new(column.into(), row.into())))
        .map(|texel| (texel + 0.5) / size(larger))
        .collect();
    let alpha =
        |&share: &DVec2| (opacities.opacity_at(share * size(opacities)) * 255.0).round() as u8;
    let alpha = shares.iter().map(alpha).collect();
    let texels = if texels(&colours) == shares.len() as u64 {
        colours.texels.clone()
    } else {
        let at = |index: usize| colours.texels.get(index).unwrap_or_default();
        let colour = |index: usize| Rgb::from_array(at(index).map(f64::from));
        let coded =
            |colour: Rgb| colour.to_array().map(|x| (srgb_from_linear(x) * 255.0).round() as u8);
        let codes =
            shares.iter().flat_map(|share| coded(colours.mix(share * size(&colours), colour)));
        Texels::from_srgb(codes.collect())
    };
    Texture {
        width,
        height,
        alpha,
        texels,
        encoded: [].into(),
        mime_type: String::new(),
        ..colours
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: u32, texels: Vec<[f32; 3]>) -> Texture {
        let height = texels.len() as u32 / width;
        Texture { width, height, texels: texels.into(), ..Texture::default() }
    }

    #[test]
    fn opacities_come_from_alpha_or_brightness_and_keep_their_texels() {
        let textures = vec![
            picture(1, vec![[0.25, 0.5, 1.0]]),
            picture(2, vec![[1.0; 3], [0.0; 3]]),
            Texture { alpha: vec![0, 255], ..picture(2, vec![[0.2; 3]; 2]) },
            picture(2, vec![[1.0; 3]; 2]),
        ];
        let mut scene = Scene { textures, ..Scene::default() };
        let holes = with_holes(&mut scene, Some(0), 1).expect("a hole");
        let Texture { width, height, alpha, texels, .. } = &scene.textures[holes as usize];
        assert_eq!((*width, *height, alpha.as_slice()), (2, 1, &[255, 0][..]));
        assert!(texels.iter().all(|texel| (texel[1] - 0.5).abs() < 0.01), "{texels:?}");
        let white = with_holes(&mut scene, None, 2).expect("a hole");
        let Texture { alpha, texels, .. } = &scene.textures[white as usize];
        assert_eq!((alpha.as_slice(), texels.get(0)), (&[0, 255][..], Some([1.0; 3])));
        assert_eq!(with_holes(&mut scene, Some(2), 2), Some(2));
        assert_eq!(with_holes(&mut scene, Some(0), 3), None);
        assert_eq!(with_holes(&mut scene, Some(3), 3), None);
    }
}
