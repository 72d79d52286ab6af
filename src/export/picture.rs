//! Pictures as files carry them.

use std::borrow::Cow;
use std::io::{self, Cursor};

use image::{ImageBuffer, ImageFormat, Rgb};

use crate::colour::srgb_from_linear;
use crate::scene::Texture;

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

    /// How [`encoded`] stores `texture`.
    pub(crate) fn of(texture: &Texture) -> Self {
        match kept(texture) {
            Some(coding) => coding,
            None => Self::Png,
        }
    }
}

/// The picture as it was read if that is PNG or JPEG, else its texels as PNG.
pub(crate) fn encoded(texture: &Texture) -> io::Result<Cow<'_, [u8]>> {
    if kept(texture).is_some() {
        return Ok(Cow::Borrowed(&texture.encoded));
    }
    let code = |value: f32| (srgb_from_linear(f64::from(value)) * 255.0).round() as u8;
    let bytes: Vec<u8> = texture.texels.iter().flatten().map(code).collect();
    let picture = ImageBuffer::<Rgb<u8>, _>::from_raw(texture.width, texture.height, bytes)
        .ok_or_else(|| io::Error::other(format!("picture {}: texels are missing", texture.name)))?;
    let mut png = Cursor::new(Vec::new());
    picture.write_to(&mut png, ImageFormat::Png).map_err(io::Error::other)?;
    Ok(Cow::Owned(png.into_inner()))
}

fn kept(texture: &Texture) -> Option<Coding> {
    match texture.mime_type.as_str() {
        _ if texture.encoded.is_empty() => None,
        "image/png" => Some(Coding::Png),
        "image/jpeg" => Some(Coding::Jpeg),
        _ => None,
    }
}
