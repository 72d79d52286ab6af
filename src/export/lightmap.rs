//! A lightmap for other programs: a coarse GLB, and beside it the picture of its light, twice.

use std::f64::consts::PI;
use std::io;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageFormat, Rgb32FImage, RgbImage};

use super::exposed::{ExposedMesh, coded};
use super::glb;
use super::stamp::Stamp;
use crate::error::{Error, Result};
use crate::file;
use crate::lightmap::Lightmap;
use crate::reconstruct::TriMesh;
use crate::tone::tone_map;

/// The only ending of the mesh.
const ENDING: &str = ".glb";

/// The files of a lightmap whose mesh is `room.glb`: that, `room.exr` and `room.png`.
pub fn lightmap_files(path: &Path) -> [PathBuf; 3] {
    let [exr, png] = ["exr", "png"].map(|ending| path.with_extension(ending));
    [path.to_owned(), exr, png]
}

/// Finds out before long work whether [`save_lightmap`] could write all its files.
///
/// # Errors
/// When `path` does not end in `.glb` or a file cannot be made there.
pub fn check_writable_lightmap(path: &Path) -> Result<()> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("glb")) {
        return Err(Error::UnknownFormat { path: path.to_owned(), known: ENDING });
    }
    lightmap_files(path).iter().try_for_each(|file| file::probe(file))
}

/// Writes a lightmap as [`lightmap_files`]; `mesh` is the lit one, which sets the exposure.
///
/// The GLB has the surfaces without refinement, `TEXCOORD_1` for the map, and materials with the surfaces'
/// own colour, picture and emission. The EXR holds E/π, W/(m² sr), in linear floats, so that
/// albedo × texel + emission is the radiance that is seen. The PNG is the radiosity E of a white surface,
/// exposed and tone-mapped as `COLOR_0` is, in 8-bit sRGB: to look at, or for engines without range.
///
/// # Errors
/// When the ending is not `.glb`, there is no triangle, or a file cannot be written.
pub fn save_lightmap(map: &Lightmap, mesh: &TriMesh, path: &Path, stamp: &Stamp) -> Result<()> {
    check_writable_lightmap(path)?;
    if map.atlas.mesh.triangles.is_empty() {
        return Err(Error::format(path, "there is no triangle to write"));
    }
    let exposed = ExposedMesh::new(mesh, stamp);
    let [glb, exr, png] = lightmap_files(path);
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let names = [name(&exr), name(&png)];
    picture(&exr, linear(map).into(), ImageFormat::OpenExr)?;
    picture(&png, displayed(map, exposed.scale).into(), ImageFormat::Png)?;
    file::replace(&glb, |out| glb::write_lightmap(map, &exposed, &names, out))
}

fn picture(path: &Path, image: DynamicImage, format: ImageFormat) -> Result<()> {
    file::replace(path, |out| image.write_to(out, format).map_err(io::Error::other))
}

fn linear(map: &Lightmap) -> Rgb32FImage {
    let size = map.atlas.size;
    Rgb32FImage::from_fn(size, size, |x, y| {
        image::Rgb(map.texels[(y * size + x) as usize].to_array())
    })
}

fn displayed(map: &Lightmap, scale: f64) -> RgbImage {
    let size = map.atlas.size;
    RgbImage::from_fn(size, size, |x, y| {
        let radiosity = map.texels[(y * size + x) as usize].as_dvec3() * PI;
        image::Rgb(coded(tone_map(radiosity * scale)).map(|code| (code * 255.0).round() as u8))
    })
}
