//! A scene while it is read from glTF, and what was left out.

use glam::DVec3;

use super::extensions::is_readable;
use super::file::GltfFile;
use crate::scene::notes::{listed, note_count};
use crate::scene::texture::UvMapping;
use crate::scene::{Material, MaterialId, Scene};

/// A scene while it is read.
pub(super) struct GltfImport<'a> {
    pub(super) file: &'a GltfFile,
    pub(super) scene: Scene,
    /// How the materials map texture coordinates, as many as the scene's materials.
    pub(super) mappings: Vec<UvMapping>,
    /// Index of the material of primitives without one.
    pub(super) fallback: Option<MaterialId>,
    /// Names of lamps, where they stand and how far they are said to reach, m.
    pub(super) ranges: Vec<(String, DVec3, f64)>,
    pub(super) skipped: Skipped,
}

/// How much was left out.
#[derive(Default)]
pub(super) struct Skipped {
    /// Primitives of points or lines.
    pub(super) loose: usize,
    /// Cameras that are not perspective, or without a sensible angle or direction.
    pub(super) cameras: usize,
    /// Primitives whose vertices say that light comes through.
    pub(super) alphas: usize,
}

impl<'a> GltfImport<'a> {
    /// Before anything but the materials has been read.
    pub(super) fn new(file: &'a GltfFile, scene: Scene, mappings: Vec<UvMapping>) -> Self {
        Self {
            file,
            scene,
            mappings,
            fallback: None,
            ranges: Vec::new(),
            skipped: Skipped::default(),
        }
    }

    /// The default material, added to the scene on its first use.
    pub(super) fn fallback_material(&mut self) -> MaterialId {
        *self.fallback.get_or_insert_with(|| {
            self.mappings.push(UvMapping::default());
            self.scene.notes.push("meshes without material get grey of reflectance 0.5".to_owned());
            self.scene.add_material(Material::default())
        })
    }

    /// Names the extensions that might have said something.
    pub(super) fn note_extensions(&mut self) {
        let used = &self.file.root.extensions_used;
        let unread: Vec<String> =
            used.iter().filter(|name| !is_readable(name)).map(String::clone).collect();
        if !unread.is_empty() {
            self.scene.notes.push(format!("extensions not read: {}", listed(&unread)));
        }
    }

    pub(super) fn note_skipped(&mut self) {
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
