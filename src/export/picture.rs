//! Pictures as files carry them.

use std::borrow::Cow;
use std::io::{self, Cursor};

use image::codecs::jpeg::JpegEncoder;
use image::{DynamicImage, ImageFormat, RgbImage, RgbaImage};

use crate::colour::srgb_from_linear;
use crate::scene::Texture;

/// Of JPEGs, 1..=100: coarser ones show their squares.
const QUALITY: u8 = 90;

/// What a picture is stored as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Coding {
    Png,
    Jpeg,
}

impl Coding {
    pub(crate) fn mime_type(self) -> &'static str {
        match self {
            Self::Png => "image/png",
            Self::Jpeg => "image/jpeg",
        }
    }

    /// The ending of file names, without a dot.
    pub(crate) fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpg",
        }
    }

    /// How [`encoded`] stores `texture`, divided by `white`.
    pub(crate) fn of(texture: &Texture, white: f64) -> Self {
        kept(texture, white).unwrap_or(Self::Png)
    }

    /// What takes little room where each texel need not be as it was: JPEG for what came as such, but it has no holes.
    pub(crate) fn of_shrunk(texture: &Texture) -> Self {
        let was_jpeg = texture.mime_type == Self::Jpeg.mime_type();
        if was_jpeg && texture.alpha.is_empty() { Self::Jpeg } else { Self::Png }
    }
}

/// The picture, brightened so that `white` becomes 1: as it was read if that is PNG or JPEG and 1 already, else its
/// texels as PNG.
pub(crate) fn encoded(texture: &Texture, white: f64) -> io::Result<Cow<'_, [u8]>> {
    if kept(texture, white).is_some() {
        return Ok(Cow::Borrowed(&texture.encoded));
    }
    encoded_as(Coding::Png, texture, white).map(Cow::Owned)
}

/// The texels anew, brightened so that `white` becomes 1.
pub(crate) fn encoded_as(coding: Coding, texture: &Texture, white: f64) -> io::Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    let picture = brightened(texture, white)?;
    let written = match coding {
        Coding::Png => picture.write_to(&mut bytes, ImageFormat::Png),
        Coding::Jpeg => JpegEncoder::new_with_quality(&mut bytes, QUALITY).encode_image(&picture),
    };
    written.map_err(io::Error::other)?;
    Ok(bytes.into_inner())
}

fn brightened(texture: &Texture, white: f64) -> io::Result<DynamicImage> {
    let code = |value: f32| (srgb_from_linear(f64::from(value) / white) * 255.0).round() as u8;
    let (width, height) = (texture.width, texture.height);
    let colours = texture.texels.iter().map(|texel| texel.map(code));
    let picture: Option<DynamicImage> = if texture.alpha.is_empty() {
        RgbImage::from_raw(width, height, colours.flatten().collect()).map(DynamicImage::ImageRgb8)
    } else {
        let bytes = colours.zip(&texture.alpha).flat_map(|([r, g, b], &alpha)| [r, g, b, alpha]);
        RgbaImage::from_raw(width, height, bytes.collect()).map(DynamicImage::ImageRgba8)
    };
    picture.ok_or_else(|| io::Error::other(format!("picture {}: texels are missing", texture.name)))
}

fn kept(texture: &Texture, white: f64) -> Option<Coding> {
    match texture.mime_type.as_str() {
        _ if texture.encoded.is_empty() || white != 1.0 => None,
        "image/png" => Some(Coding::Png),
        "image/jpeg" => Some(Coding::Jpeg),
        _ => None,
    }
}
