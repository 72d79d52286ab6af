//! Writes pictures to files.

use std::io;
use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, ImageFormat, Rgb32FImage, RgbImage};

use super::display::{Display, displayed};
use super::picture::Picture;
use crate::error::{Error, Result};
use crate::file;

/// Endings that [`save`] knows.
const ENDINGS: &str = ".png, .hdr, .exr";

/// Writes `picture` as the ending of `path` says: `.png` as `display` shows it, in 8-bit sRGB;
/// `.hdr` and `.exr` the linear [values](Picture::values), without lines and legend.
/// Missing directories are made; the file appears whole or not at all.
///
/// # Errors
/// When the ending is another one, or the file cannot be written.
pub fn save(picture: &Picture, path: &Path, display: &Display) -> Result<()> {
    let format = format_of(path)?;
    let image: DynamicImage = match format {
        ImageFormat::Png => displayed(picture, display).into(),
        _ => linear(picture).into(),
    };
    file::replace(path, |out| image.write_to(out, format).map_err(io::Error::other))
}

/// The bytes of a PNG of `picture` as `display` shows it, in 8-bit sRGB, as few as there can be.
pub fn png(picture: &Picture, display: &Display) -> Vec<u8> {
    smallest_png(&displayed(picture, display))
}

/// The bytes of a PNG, packed at leisure.
pub(crate) fn smallest_png(image: &RgbImage) -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoder =
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    let written = image.write_with_encoder(encoder);
    debug_assert!(written.is_ok(), "memory takes every byte of a picture");
    bytes
}

/// Finds out before long work whether [`save`] could write to `path`; makes missing directories.
///
/// # Errors
/// When the ending is unknown or no file can be made there.
pub fn check_writable(path: &Path) -> Result<()> {
    format_of(path)?;
    file::probe(path)
}

fn format_of(path: &Path) -> Result<ImageFormat> {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("png") => Ok(ImageFormat::Png),
        Some("hdr") => Ok(ImageFormat::Hdr),
        Some("exr") => Ok(ImageFormat::OpenExr),
        _ => Err(Error::UnknownFormat { path: path.to_owned(), known: ENDINGS }),
    }
}

fn linear(picture: &Picture) -> Rgb32FImage {
    Rgb32FImage::from_fn(picture.width, picture.height, |x, y| {
        let index = y as usize * picture.width as usize + x as usize;
        image::Rgb(picture.values[index].to_array())
    })
}
