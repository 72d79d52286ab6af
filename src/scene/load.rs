//! From a file of any known kind to a cleaned scene.

use std::ops::Range;
use std::path::Path;

use super::limits::{limit_materials, refuse_huge_coordinates};
use super::notes::counted;
use super::{EmissionUnit, LoadOptions, Scene, gltf, obj, ply, repair, settle_sides, stl, up};
use crate::colour::LUMENS_PER_WATT;
use crate::error::{Error, Result};
use crate::geometry::boxes::local_origin;

/// Reads an OBJ (with its MTL), glTF, GLB, STL or PLY file.
///
/// # Errors
/// When the file cannot be read or is not what its ending says; the message names the place.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Scene> {
    let mut scene = read(path, options)?;
    if options.emission == EmissionUnit::Nits {
        scene.materials.iter_mut().for_each(|material| material.emission /= LUMENS_PER_WATT);
    }
    refuse_huge_coordinates(path, &scene)?;
    repair::clean(&mut scene);
    limit_materials(&mut scene);
    settle_sides(&mut scene, options.two_sided);
    note_size(&mut scene);
    if scene.faces.is_empty() {
        let reasons: String = scene.notes.iter().map(|note| format!("; {note}")).collect();
        return Err(Error::Scene(format!("{}: the scene has no faces{reasons}", path.display())));
    }
    shorten(&mut scene.notes);
    Ok(scene)
}

/// Sizes of scenes that are probably in metres, m.
const USUAL: Range<f64> = 0.1..500.0;

fn note_size(scene: &mut Scene) {
    let extent = scene.extent();
    if let Some(origin) = scene.bounds().and_then(|(low, high)| local_origin(low, high)) {
        scene.notes.push(format!(
            "the scene lies {:.0} m from the origin: a GLB of it has coordinates around ({}, {}, {}) m and a node that moves \
             them there, a PLY double precision",
            origin.length(), origin.x, origin.y, origin.z
        ));
    }
    if extent > 0.0 && !USUAL.contains(&extent) {
        scene.notes.push(format!("the scene is {extent:.3} m across: is its unit the metre?"));
    }
}

/// More notes than this say nothing more to a reader.
const MOST_NOTES: usize = 60;

fn shorten(notes: &mut Vec<String>) {
    let more = notes.len().saturating_sub(MOST_NOTES);
    if more > 0 {
        notes.truncate(MOST_NOTES);
        notes.push(format!("and {}", counted(more, "more note")));
    }
}

fn read(path: &Path, options: &LoadOptions) -> Result<Scene> {
    let scale = options.metres_per_unit;
    if !(scale.is_finite() && scale > 0.0) {
        let message = format!("{scale} metres per unit; use a positive number");
        return Err(Error::Setting { name: "units", message });
    }
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let mut scene = match ending.as_str() {
        "obj" => obj::read(path)?,
        "gltf" | "glb" => gltf::read(path, options)?,
        "stl" => stl::read(path)?,
        "ply" => ply::read(path)?,
        _ => {
            let known = ".obj, .gltf, .glb, .stl, .ply";
            return Err(Error::UnknownFormat { path: path.to_owned(), known });
        }
    };
    if scene.files.is_empty() {
        scene.files.push(path.to_owned());
    }
    up::lay(&mut scene, scale, options.up);
    // Y is up in glTF by definition.
    if !matches!(ending.as_str(), "gltf" | "glb") {
        up::note_standing_floors(&mut scene, options.up);
    }
    Ok(scene)
}
