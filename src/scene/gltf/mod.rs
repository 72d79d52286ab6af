//! glTF 2.0 and GLB: parsed by the `gltf` crate, every number checked here before it is used.

mod accessors;
mod file;
mod lights;
mod materials;
mod nodes;
mod packed;
mod pose;
mod primitives;

use std::path::Path;

use glam::DVec3;

use self::file::{File, is_readable};
pub(crate) use self::materials::sampler_of;
use super::notes::{listed, note_count};
use super::texture::UvMapping;
use super::{LoadOptions, Material, Scene};
use crate::error::Result;

/// Reads the glTF or GLB file at `path` with its buffers and pictures.
pub(super) fn read(path: &Path, options: &LoadOptions) -> Result<Scene> {
    let mut notes = Vec::new();
    let file = File::open(path, &mut notes)?;
    let mut scene = Scene { files: file.files(), notes, ..Scene::default() };
    let materials::Known { mappings, clear } = materials::read(&file, &mut scene)?;
    let mut import = Import {
        file: &file,
        scene,
        mappings,
        fallback: None,
        ranges: Vec::new(),
        skipped: Skipped::default(),
    };
    import.add_nodes()?;
    import.note_lights(options.emission);
    import.note_skipped();
    import.note_extensions();
    import.scene.leave_out(&clear);
    Ok(import.scene)
}

/// A scene while it is read.
struct Import<'a> {
    file: &'a File,
    scene: Scene,
    /// How the materials map texture coordinates, as many as the scene's materials.
    mappings: Vec<UvMapping>,
    /// Index of the material of primitives without one.
    fallback: Option<u32>,
    /// Names of lamps, where they stand and how far they are said to reach, m.
    ranges: Vec<(String, DVec3, f64)>,
    skipped: Skipped,
}

/// How much was left out.
#[derive(Default)]
struct Skipped {
    /// Primitives of points or lines.
    loose: usize,
    /// Cameras that are not perspective, or without a sensible angle or direction.
    cameras: usize,
    /// Primitives whose vertices say that light comes through.
    alphas: usize,
}

impl Import<'_> {
    /// The default material, added to the scene on its first use.
    fn fallback_material(&mut self) -> u32 {
        *self.fallback.get_or_insert_with(|| {
            self.scene.materials.push(Material::default());
            self.mappings.push(UvMapping::default());
            self.scene.notes.push("meshes without material get grey of reflectance 0.5".to_owned());
            self.scene.materials.len() as u32 - 1
        })
    }

    /// Names the extensions that might have said something.
    fn note_extensions(&mut self) {
        let used = &self.file.root.extensions_used;
        let unread: Vec<String> =
            used.iter().filter(|name| !is_readable(name)).map(String::clone).collect();
        if !unread.is_empty() {
            self.scene.notes.push(format!("extensions not read: {}", listed(&unread)));
        }
    }

    fn note_skipped(&mut self) {
        let (skipped, notes) = (&self.skipped, &mut self.scene.notes);
        note_count(notes, skipped.loose, "primitive", "of points or lines ignored");
        note_count(notes, skipped.cameras, "camera", "ignored: only perspective ones are read");
        note_count(
            notes,
            skipped.alphas,
            "primitive",
            "with transparent vertex colours taken as opaque",
        );
    }
}
