//! The materials an OBJ file may use: its MTL libraries with their pictures.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use glam::{DAffine2, DMat2, DVec2};

use super::holes::{self, with_holes};
use super::mtl::{self, MtlMaterial, TextureMap};
use super::scan::UseMtl;
use crate::colour::Rgb;
use crate::scene::named::find;
use crate::scene::notes::listed;
use crate::scene::text::{self, without_comment, words};
use crate::scene::texture::{
    MappedTexture, UvMapping, attach_pictures, decode, note_missing, without_picture,
};
use crate::scene::{Material, MaterialId, Scene, Texture};

/// What a face needs to know of its material.
#[derive(Clone, Copy, Debug)]
pub(super) struct Use {
    pub(super) material: MaterialId,
    pub(super) mapping: UvMapping,
}

/// Materials by name.
#[derive(Debug, Default)]
pub(super) struct Library {
    by_name: HashMap<String, Use>,
    /// The same by names without what may be a comment.
    by_short_name: HashMap<String, Use>,
    /// Where the OBJ file is.
    folder: PathBuf,
    /// Pictures read so far, by file and whether clamped; `None` for unreadable ones.
    pictures: HashMap<(PathBuf, bool), Option<u32>>,
    /// Textures by those of colours and of opacities; `None` of those without holes.
    holes: HashMap<(Option<u32>, u32), Option<u32>>,
    fallback: Option<Use>,
    /// Names of the materials without a reflectance.
    colourless: Vec<String>,
    /// Names of those whose picture is missing and who say nothing else.
    pictureless: Vec<String>,
    /// Names of those that let light through.
    transparent: Vec<String>,
}

impl Library {
    /// Reads the `libraries` that the OBJ file at `path` names; what is missing is noted.
    pub(super) fn read(path: &Path, libraries: &[String], scene: &mut Scene) -> Self {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut library = Self { folder: folder.to_owned(), ..Self::default() };
        let mut seen = Vec::new();
        let files =
            libraries.iter().flat_map(|names| library_files(folder, names, &mut scene.notes));
        for file in files.collect::<Vec<_>>() {
            if seen.contains(&file) {
                continue;
            }
            match text::read(&file) {
                Ok(text) => {
                    for material in mtl::parse(&file, &text, &mut scene.notes) {
                        library.add(&file, material, scene);
                    }
                }
                Err(error) => scene.notes.push(format!("material library missing: {error}")),
            }
            seen.push(file);
        }
        scene.files.extend(seen);
        if !library.colourless.is_empty() {
            let names = listed(&library.colourless);
            scene.notes.push(format!("no Kd in {names}; grey of reflectance 0.5 is used"));
        }
        note_missing(&mut scene.notes, &library.pictureless);
        if !library.transparent.is_empty() {
            let names = listed(&library.transparent);
            scene.notes.push(format!(
                "transparency ignored, taken as opaque: {names}; --materials with `removed = true` leaves faces out"
            ));
        }
        library
    }

    fn add(&mut self, file: &Path, from: MtlMaterial, scene: &mut Scene) {
        let is_mapped = from.reflectance_map.is_some();
        let reflectance_map = from.reflectance_map.and_then(|map| self.picture(file, &map, scene));
        let opacity_map = from.opacity_map.and_then(|map| self.picture(file, &map, scene));
        let cut_out =
            opacity_map.and_then(|map| self.cut_out(&from.name, reflectance_map, map, scene));
        let emission_map = from.emission_map.and_then(|map| self.picture(file, &map, scene));
        let mut reflectance = from.reflectance;
        if reflectance.is_none() && reflectance_map.is_none() {
            self.colourless.push(from.name.clone());
        }
        if is_mapped
            && reflectance_map.is_none()
            && let Some(grey) = reflectance.and_then(without_picture)
        {
            reflectance = Some(grey);
            self.pictureless.push(from.name.clone());
        }
        if from.transparent {
            self.transparent.push(from.name.clone());
        }
        let unsaid =
            if reflectance_map.is_some() { Rgb::ONE } else { Material::default().reflectance };
        let unlit = if emission_map.is_some() { Rgb::ONE } else { Rgb::ZERO };
        let mut material = Material {
            name: from.name.clone(),
            reflectance: reflectance.unwrap_or(unsaid),
            emission: from.emission.unwrap_or(unlit),
            cutoff: cut_out.map(|_| holes::CUTOFF),
            ..Material::default()
        };
        let reflectance_map = cut_out.or(reflectance_map);
        let mapping = attach_pictures(scene, &mut material, reflectance_map, emission_map);
        let used = Use { material: scene.add_material(material), mapping };
        if let Some(short) = without_comment(&from.name) {
            self.by_short_name.insert(short.to_owned(), used);
        }
        if self.by_name.insert(from.name.clone(), used).is_some() {
            let name = from.name;
            scene.notes.push(format!("material \"{name}\" is defined twice; the last one counts"));
        }
    }

    /// The picture of a material's colours with the holes that one of opacities has, if it has any.
    fn cut_out(
        &mut self,
        material: &str,
        colours: Option<MappedTexture>,
        opacities: MappedTexture,
        scene: &mut Scene,
    ) -> Option<MappedTexture> {
        if colours.is_some_and(|colours| colours.mapping != opacities.mapping) {
            scene.notes.push(format!(
                "material \"{material}\": the opacity picture is laid on unlike the colour picture; it is ignored"
            ));
            return None;
        }
        let key = (colours.map(|colours| colours.texture), opacities.texture);
        let made = self.holes.entry(key).or_insert_with(|| with_holes(scene, key.0, key.1));
        made.map(|texture| MappedTexture { texture, ..opacities })
    }

    fn picture(
        &mut self,
        library: &Path,
        map: &TextureMap,
        scene: &mut Scene,
    ) -> Option<MappedTexture> {
        let folder = library.parent().unwrap_or(Path::new(""));
        let names = [Some(map.file.as_str()), without_comment(&map.file)];
        let found = names.into_iter().flatten().find_map(|name| {
            find(folder, name, &mut scene.notes)
                .or_else(|| find(&self.folder, name, &mut scene.notes))
        });
        let file = found.unwrap_or_else(|| folder.join(&map.file));
        let other = (file.clone(), !map.clamp);
        let key = (file, map.clamp);
        if !self.pictures.contains_key(&key) {
            let texture = match self.pictures.get(&other) {
                Some(known) => known.map(|known| scene.add_texture_like(known, map.sampler())),
                None => read_picture(&key.0, map, scene),
            };
            self.pictures.insert(key.clone(), texture);
        }
        let texture = self.pictures.get(&key).copied().flatten()?;
        Some(MappedTexture {
            texture,
            mapping: UvMapping { set: 0, transform: from_bottom_left(map) },
        })
    }

    /// The use of the material that a name in an OBJ file means.
    fn named(&self, name: &str) -> Option<Use> {
        let short = || without_comment(name).and_then(|short| self.by_name.get(short));
        self.by_name.get(name).or_else(short).or_else(|| self.by_short_name.get(name)).copied()
    }

    /// The uses of the materials `named`; unknown ones look like the default, under their own name, with a note.
    pub(super) fn resolve(&mut self, path: &Path, named: &[UseMtl], scene: &mut Scene) -> Vec<Use> {
        let (mut unknown, mut first) = (Vec::new(), 0);
        let mut uses = Vec::with_capacity(named.len());
        for UseMtl { line, name } in named {
            let used = self.named(name);
            uses.push(used.unwrap_or_else(|| {
                first = if unknown.is_empty() { *line } else { first };
                unknown.push(name.clone());
                added(scene, Material { name: name.clone(), ..Material::default() })
            }));
        }
        if !unknown.is_empty() {
            let list = listed(&unknown);
            scene.notes.push(format!(
                "{}:{first}: unknown material {list}; grey of reflectance 0.5 is used",
                path.display()
            ));
        }
        uses
    }

    /// The default material, added to the scene on its first use.
    pub(super) fn fallback(&mut self, scene: &mut Scene) -> Use {
        *self.fallback.get_or_insert_with(|| added(scene, Material::default()))
    }
}

/// A material without pictures, added to the scene.
fn added(scene: &mut Scene, material: Material) -> Use {
    Use { material: scene.add_material(material), mapping: UvMapping::default() }
}

/// One file with spaces in its name, or several files: whichever exists.
fn library_files(folder: &Path, names: &str, notes: &mut Vec<String>) -> Vec<PathBuf> {
    let whole = [Some(names), without_comment(names)].into_iter().flatten();
    // What is several names may as a whole be none that another file was taken for.
    if let Some(file) = whole.clone().map(|name| folder.join(name)).find(|file| file.is_file()) {
        return vec![file];
    }
    let parts: Vec<&str> = words(names).collect();
    if parts.iter().any(|part| folder.join(part).is_file()) {
        return parts.iter().map(|part| folder.join(part)).collect();
    }
    let taken = whole.clone().find_map(|name| find(folder, name, notes));
    let taken = taken
        .map(|file| vec![file])
        .unwrap_or_else(|| parts.iter().filter_map(|part| find(folder, part, notes)).collect());
    if taken.is_empty() { vec![folder.join(names.trim_matches('"'))] } else { taken }
}

fn read_picture(file: &Path, map: &TextureMap, scene: &mut Scene) -> Option<u32> {
    scene.files.push(file.to_owned());
    let bytes = fs::read(file).map_err(|error| error.to_string());
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    match bytes.and_then(|bytes| decode(&name, &bytes, map.sampler())) {
        Ok(texture) => {
            scene.textures.push(Texture { name: map.file.clone(), ..texture });
            Some(scene.textures.len() as u32 - 1)
        }
        Err(why) => {
            scene.notes.push(format!("picture {} left out: {why}", file.display()));
            None
        }
    }
}

/// Scales and moves as the map says, then counts v from the top instead of the bottom.
fn from_bottom_left(map: &TextureMap) -> DAffine2 {
    let laid = DAffine2::from_mat2_translation(DMat2::from_diagonal(map.scale), map.offset);
    let upside_down = DMat2::from_diagonal(DVec2::new(1.0, -1.0));
    DAffine2::from_mat2_translation(upside_down, DVec2::Y) * laid
}
