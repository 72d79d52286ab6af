//! Pictures: decoding, and how a material's pictures and texture coordinates belong together.

use glam::{DAffine2, DVec2};
use image::{DynamicImage, ImageFormat};

use super::notes::listed;
use super::{MAX_REFLECTANCE, Material, Sampler, Scene, Texels, Texture};
use crate::colour::{Rgb, linear_from_srgb};

/// How a file's texture coordinates become the scene's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct UvMapping {
    /// Which of a mesh's sets of coordinates is meant.
    pub(crate) set: u32,
    /// Applied to the file's coordinates.
    pub(crate) transform: DAffine2,
}

impl Default for UvMapping {
    fn default() -> Self {
        Self { set: 0, transform: DAffine2::IDENTITY }
    }
}

impl UvMapping {
    /// The scene's coordinates for the file's `uv`.
    pub(crate) fn apply(&self, uv: DVec2) -> DVec2 {
        self.transform.transform_point2(uv)
    }
}

/// A texture of a scene and the coordinates it is read with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MappedTexture {
    pub(crate) texture: u32,
    pub(crate) mapping: UvMapping,
}

/// Gives `material` its pictures and tells how its faces' coordinates are to be mapped.
///
/// Faces carry one set of coordinates, so an emission picture that is laid on differently
/// from the reflectance picture is replaced by its mean.
pub(crate) fn attach_pictures(
    scene: &mut Scene,
    material: &mut Material,
    reflectance: Option<MappedTexture>,
    emission: Option<MappedTexture>,
) -> UvMapping {
    material.texture = reflectance.map(|picture| picture.texture);
    if let Some(picture) = reflectance {
        // Only floating-point pictures hold more, and nothing reflects more than it receives.
        let texture = &mut scene.textures[picture.texture as usize];
        texture.texels = std::mem::take(&mut texture.texels).at_most_one();
    }
    let mapping = reflectance.or(emission).map(|picture| picture.mapping).unwrap_or_default();
    if let Some(glow) = emission {
        if glow.mapping == mapping {
            material.emission_texture = Some(glow.texture);
        } else {
            material.emission *= mean(&scene.textures[glow.texture as usize]);
            scene.notes.push(format!(
                "material \"{}\": the emission picture is laid on unlike the colour picture; its mean is used",
                material.name
            ));
        }
    }
    mapping
}

/// Mean colour of a texture, linear RGB.
pub(crate) fn mean(texture: &Texture) -> Rgb {
    let sum: Rgb = texture.texels.iter().map(|texel| glam::Vec3::from(texel).as_dvec3()).sum();
    sum / texture.texels.len().max(1) as f64
}

/// What a material reflects whose picture is missing, where its factor says nothing of it: black, which hides a
/// surface that only its picture was to show, and white, which leaves all to the picture.
pub(crate) fn without_picture(factor: Rgb) -> Option<Rgb> {
    let is_silent = factor.max_element() <= 0.0 || factor.min_element() >= MAX_REFLECTANCE;
    is_silent.then_some(Material::default().reflectance)
}

/// The note of that.
pub(crate) fn note_missing(notes: &mut Vec<String>, materials: &[String]) {
    if !materials.is_empty() {
        let names = listed(materials);
        notes.push(format!("picture missing in {names}; grey of reflectance 0.5 is used"));
    }
}

/// Decodes a picture, or says why it cannot.
///
/// Integer pictures are taken as sRGB, floating-point ones as linear. `encoded` is kept when it is
/// PNG or JPEG.
pub(crate) fn decode(name: &str, encoded: &[u8], sampler: Sampler) -> Result<Texture, String> {
    // TGA files say nothing about themselves.
    let format = image::guess_format(encoded)
        .or_else(|error| ImageFormat::from_path(name).map_err(|_| error))
        .map_err(|error| error.to_string())?;
    let picture =
        image::load_from_memory_with_format(encoded, format).map_err(|error| error.to_string())?;
    let (encoded, mime_type) = match format {
        ImageFormat::Png => (encoded, "image/png"),
        ImageFormat::Jpeg => (encoded, "image/jpeg"),
        _ => (&[][..], ""),
    };
    Ok(Texture {
        name: name.to_owned(),
        width: picture.width(),
        height: picture.height(),
        alpha: opacities(&picture),
        texels: linear_texels(picture),
        encoded: encoded.into(),
        mime_type: mime_type.to_owned(),
        sampler,
    })
}

/// Nothing for a picture without holes.
fn opacities(picture: &DynamicImage) -> Vec<u8> {
    if !picture.color().has_alpha() {
        return Vec::new();
    }
    let alpha: Vec<u8> = picture.to_rgba8().pixels().map(|pixel| pixel.0[3]).collect();
    if alpha.iter().all(|&alpha| alpha == u8::MAX) { Vec::new() } else { alpha }
}

fn is_linear(picture: &DynamicImage) -> bool {
    matches!(picture, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_))
}

fn linear_texels(picture: DynamicImage) -> Texels {
    if is_linear(&picture) {
        let sound = |x: f32| if x.is_finite() { x.max(0.0) } else { 0.0 };
        return picture.to_rgb32f().pixels().map(|pixel| pixel.0.map(sound)).collect();
    }
    if picture.color().bytes_per_pixel() > 4 {
        let decode = |x: u16| linear_from_srgb(f64::from(x) / 65535.0) as f32;
        return picture.to_rgb16().pixels().map(|pixel| pixel.0.map(decode)).collect();
    }
    Texels::from_srgb(picture.into_rgb8().into_raw())
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::Rgb32FImage;

    use super::*;

    fn encoded(format: ImageFormat, picture: &DynamicImage) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn integer_pictures_are_decoded_from_srgb_and_kept_as_they_came() {
        let picture =
            DynamicImage::ImageRgb8(image::RgbImage::from_pixel(2, 1, image::Rgb([188, 0, 255])));
        let bytes = encoded(ImageFormat::Png, &picture);
        let texture = decode("t", &bytes, Sampler::default()).unwrap();
        assert_eq!((texture.width, texture.height, texture.texels.len()), (2, 1, 2));
        let texel = texture.texels.get(1).unwrap();
        assert!((texel[0] - 0.502_886_5).abs() < 1e-5, "{texel:?}");
        assert_eq!(texture.texels.memory().1, 6);
        assert_eq!(*texture.encoded, bytes);
    }

    #[test]
    fn floating_pictures_are_linear() {
        let picture =
            DynamicImage::ImageRgb32F(Rgb32FImage::from_pixel(1, 1, image::Rgb([0.5, 4.0, 0.0])));
        let texture =
            decode("t", &encoded(ImageFormat::OpenExr, &picture), Sampler::default()).unwrap();
        assert_eq!(texture.texels, vec![[0.5, 4.0, 0.0]].into());
        assert!(texture.encoded.is_empty());
    }

    #[test]
    fn an_emission_picture_laid_on_differently_becomes_its_mean() {
        let texture =
            |texels: Vec<[f32; 3]>| Texture { texels: texels.into(), ..Texture::default() };
        let mut scene = Scene {
            textures: vec![texture(vec![[3.0, 0.5, 0.0]]), texture(vec![[1.0; 3], [0.0; 3]])],
            ..Scene::default()
        };
        let mut material = Material { emission: Rgb::splat(4.0), ..Material::default() };
        let picture = |texture, set| {
            Some(MappedTexture { texture, mapping: UvMapping { set, ..UvMapping::default() } })
        };
        let mapping = attach_pictures(&mut scene, &mut material, picture(0, 0), picture(1, 1));
        assert_eq!((mapping.set, material.texture, material.emission_texture), (0, Some(0), None));
        assert_eq!(material.emission, Rgb::splat(2.0));
        assert_eq!(scene.textures[0].texels, vec![[1.0, 0.5, 0.0]].into());
        assert_eq!(scene.notes.len(), 1);
    }

    #[test]
    fn pictures_of_every_format_are_read() {
        use ImageFormat::{Bmp, Gif, Tga, Tiff, WebP};
        let picture =
            DynamicImage::ImageRgb8(image::RgbImage::from_pixel(2, 3, image::Rgb([0, 255, 0])));
        for (name, format) in
            [("a.bmp", Bmp), ("a.GIF", Gif), ("a.tga", Tga), ("a.tif", Tiff), ("a.webp", WebP)]
        {
            let texture = decode(name, &encoded(format, &picture), Sampler::default()).unwrap();
            assert_eq!((texture.width, texture.height), (2, 3), "{name}");
            assert!(texture.texels.iter().all(|texel| texel == [0.0, 1.0, 0.0]), "{name}");
        }
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        assert!(decode("t", b"not a picture", Sampler::default()).is_err());
        assert!(decode("t", b"\x89PNG\r\n\x1a\n broken", Sampler::default()).is_err());
    }
}
