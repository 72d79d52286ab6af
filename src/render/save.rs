//! Writes pictures to files.

use std::path::Path;

use image::{DynamicImage, ImageError, ImageFormat, Rgb32FImage};

use super::display::{Display, displayed};
use super::picture::Picture;
use crate::error::{Error, Result};

/// Endings that [`save`] knows.
const ENDINGS: &str = ".png, .hdr, .exr";

/// Writes `picture` as the ending of `path` says: `.png` as `display` shows it, in 8-bit sRGB;
/// `.hdr` and `.exr` the linear radiance, W/(m² sr), without lines and legend.
///
/// # Errors
/// When the ending is another one, or the file cannot be written.
pub fn save(picture: &Picture, path: &Path, display: &Display) -> Result<()> {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    let (image, format): (DynamicImage, _) = match ending.as_ref().and_then(|e| e.to_str()) {
        Some("png") => (displayed(picture, display).into(), ImageFormat::Png),
        Some("hdr") => (radiance(picture).into(), ImageFormat::Hdr),
        Some("exr") => (radiance(picture).into(), ImageFormat::OpenExr),
        _ => return Err(Error::UnknownFormat { path: path.to_owned(), known: ENDINGS }),
    };
    image.save_with_format(path, format).map_err(|error| match error {
        ImageError::IoError(source) => Error::io(path)(source),
        other => Error::format(path, other.to_string()),
    })
}

fn radiance(picture: &Picture) -> Rgb32FImage {
    Rgb32FImage::from_fn(picture.width, picture.height, |x, y| {
        let index = y as usize * picture.width as usize + x as usize;
        image::Rgb(picture.radiance[index].to_array())
    })
}
