//! Materials and their pictures.

use std::collections::HashMap;

use ::gltf::json::material::AlphaMode;
use ::gltf::json::texture::{Info, MagFilter, WrappingMode};
use ::gltf::json::validation::Checked;
use ::gltf::json::{self, Index};
use glam::{DAffine2, DMat2, DVec2, Vec2, Vec3};

use super::file::GltfFile;
use crate::colour::Rgb;
use crate::error::Result;
use crate::scene::notes::listed;
use crate::scene::texture::{
    MappedTexture, UvMapping, attach_pictures, decode, note_missing, without_picture,
};
use crate::scene::{Material, Sampler, Scene, Texture, Wrap};

/// What materials say that does not go into the scene's.
#[derive(Default)]
pub(super) struct ImportedMaterials {
    /// How each of them maps texture coordinates.
    pub(super) mappings: Vec<UvMapping>,
    /// Indices of those that let most light through.
    pub(super) clear: Vec<usize>,
}

/// Reads all materials into `scene`.
pub(super) fn read(file: &GltfFile, scene: &mut Scene) -> Result<ImportedMaterials> {
    let mut reader = MaterialReader {
        file,
        scene,
        pictures: HashMap::new(),
        decoded: HashMap::new(),
        pictureless: Vec::new(),
    };
    let mut known = ImportedMaterials::default();
    let (mut metals, mut clear) = (Vec::new(), Vec::new());
    let mut dim = Vec::new();
    for (index, from) in file.root.materials.iter().enumerate() {
        let (material, mapping) = reader.material(index, from)?;
        if is_metal(from) {
            metals.push(material.name.clone());
        }
        let through = let_through(from);
        if through > MOSTLY_CLEAR && material.emission == Rgb::ZERO {
            clear.push(material.name.clone());
            known.clear.push(index);
        } else if material.cutoff.is_none()
            && (through > 0.0 || from.alpha_mode != Checked::Valid(AlphaMode::Opaque))
        {
            dim.push(material.name.clone());
        }
        reader.scene.materials.push(material);
        known.mappings.push(mapping);
    }
    let pictureless = reader.pictureless;
    note_missing(&mut scene.notes, &pictureless);
    if !metals.is_empty() {
        scene
            .notes
            .push(format!("metals taken as diffuse in their base colour: {}", listed(&metals)));
    }
    if !clear.is_empty() {
        let names = listed(&clear);
        scene.notes.push(format!("left out, as they let most light through: {names}"));
    }
    if !dim.is_empty() {
        scene.notes.push(format!("transparency ignored, taken as opaque: {}", listed(&dim)));
    }
    Ok(known)
}

/// What lets more light through is left out: that is nearer the truth than a wall.
const MOSTLY_CLEAR: f64 = 0.5;

/// Share of the light that a material lets through at least, by its factors alone: textures may let more through
/// where alpha is meant, and less where transmission is.
fn let_through(material: &json::Material) -> f64 {
    let all = material.extensions.as_ref();
    let glossy = all.and_then(|all| all.pbr_specular_glossiness.as_ref());
    let base = &material.pbr_metallic_roughness.base_color_factor.0;
    let alpha = f64::from(glossy.map_or(base[3], |glossy| glossy.diffuse_factor.0[3]));
    let cutoff = material.alpha_cutoff.map_or(0.5, |cutoff| f64::from(cutoff.0));
    let covered = match material.alpha_mode {
        Checked::Valid(AlphaMode::Blend) => alpha.clamp(0.0, 1.0),
        Checked::Valid(AlphaMode::Mask) if alpha < cutoff => 0.0,
        _ => 1.0,
    };
    let glass = all.and_then(|all| all.others.get("KHR_materials_transmission"));
    let glass = glass.filter(|glass| glass.get("transmissionTexture").is_none());
    let factor = glass.and_then(|glass| glass.get("transmissionFactor")?.as_f64());
    1.0 - covered * (1.0 - factor.unwrap_or(0.0).clamp(0.0, 1.0))
}

/// A metallic factor under a metallic-roughness picture, or beside gloss, says nothing by itself.
fn is_metal(material: &json::Material) -> bool {
    let pbr = &material.pbr_metallic_roughness;
    let all = material.extensions.as_ref();
    let glossy = all.is_some_and(|all| all.pbr_specular_glossiness.is_some());
    pbr.metallic_factor.0 > 0.5 && pbr.metallic_roughness_texture.is_none() && !glossy
}

struct MaterialReader<'a> {
    file: &'a GltfFile,
    scene: &'a mut Scene,
    /// Index into the scene's textures by glTF image and sampler; `None` for unreadable ones.
    pictures: HashMap<(usize, Sampler), Option<u32>>,
    /// The first of the textures made of a glTF image.
    decoded: HashMap<usize, u32>,
    /// Names of the materials whose picture is missing and who say nothing else.
    pictureless: Vec<String>,
}

impl MaterialReader<'_> {
    fn material(&mut self, index: usize, from: &json::Material) -> Result<(Material, UvMapping)> {
        let pbr = &from.pbr_metallic_roughness;
        let strength = from.extensions.as_ref().and_then(|all| all.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |strength| strength.emissive_strength.0);
        let glossy = from.extensions.as_ref().and_then(|all| all.pbr_specular_glossiness.as_ref());
        let factor = glossy.map_or(pbr.base_color_factor.0, |glossy| glossy.diffuse_factor.0);
        let [red, green, blue, _] = factor;
        let colours = match glossy {
            Some(glossy) => glossy.diffuse_texture.as_ref(),
            None => pbr.base_color_texture.as_ref(),
        };
        let mut material = Material {
            name: from.name.clone().unwrap_or_else(|| format!("material {index}")),
            reflectance: Vec3::new(red, green, blue).as_dvec3(),
            emission: Vec3::from(from.emissive_factor.0).as_dvec3() * f64::from(strength),
            double_sided: from.double_sided,
            ..Material::default()
        };
        let reflectance = self.picture(colours)?;
        if colours.is_some()
            && reflectance.is_none()
            && let Some(grey) = without_picture(material.reflectance)
        {
            material.reflectance = grey;
            self.pictureless.push(material.name.clone());
        }
        let glows = material.emission != Rgb::ZERO;
        let emission = self.picture(from.emissive_texture.as_ref().filter(|_| glows))?;
        let mapping = attach_pictures(self.scene, &mut material, reflectance, emission);
        let has_holes = |picture: &MappedTexture| {
            !self.scene.textures[picture.texture as usize].alpha.is_empty()
        };
        material.cutoff = cutoff(from).filter(|_| reflectance.as_ref().is_some_and(has_holes));
        Ok((material, mapping))
    }

    fn picture(&mut self, info: Option<&Info>) -> Result<Option<MappedTexture>> {
        let Some(info) = info else { return Ok(None) };
        let texture = self.file.get(info.index, "texture")?;
        if self.file.root.get(texture.source).is_none() {
            let needs = texture.extensions.as_ref().and_then(|all| all.others.keys().next());
            let why = needs.map_or_else(
                || "without picture".to_owned(),
                |name| format!("that needs {name}, which is not read,"),
            );
            self.scene.notes.push(format!("texture {} {why} left out", info.index));
            return Ok(None);
        }
        let sampler = match texture.sampler {
            Some(sampler) => sampler_of(self.file.get(sampler, "sampler")?),
            None => Sampler::default(),
        };
        let key = (texture.source.value(), sampler);
        let texture = match self.pictures.get(&key) {
            Some(&known) => known,
            None => {
                let read = self.decoded(texture.source, sampler);
                self.pictures.insert(key, read);
                read
            }
        };
        Ok(texture.map(|texture| MappedTexture { texture, mapping: mapping(info) }))
    }

    /// Reads a picture into the scene; an unreadable one costs a note, not the scene.
    fn decoded(&mut self, index: Index<json::Image>, sampler: Sampler) -> Option<u32> {
        if let Some(&known) = self.decoded.get(&index.value()) {
            return Some(self.scene.add_texture_like(known, sampler));
        }
        let image = self.file.root.get(index)?;
        let uri = image.uri.as_deref().filter(|uri| !uri.starts_with("data:"));
        let name = image.name.as_deref().or(uri);
        let name = name.map_or_else(|| format!("image {index}"), str::to_owned);
        match self.encoded(image).and_then(|bytes| decode(uri.unwrap_or(&name), &bytes, sampler)) {
            Ok(picture) => {
                self.scene.textures.push(Texture { name, ..picture });
                let texture = self.scene.textures.len() as u32 - 1;
                self.decoded.insert(index.value(), texture);
                Some(texture)
            }
            Err(why) => {
                self.scene.notes.push(format!("picture \"{name}\" left out: {why}"));
                None
            }
        }
    }

    fn encoded(&mut self, image: &json::Image) -> std::result::Result<Vec<u8>, String> {
        let bytes = match (&image.buffer_view, &image.uri) {
            (Some(view), _) => self.file.view(*view).map(|(bytes, _)| bytes.to_vec()),
            (None, Some(uri)) => self.file.resource(uri, &mut self.scene.notes),
            (None, None) => return Err("it has neither data nor a file".to_owned()),
        };
        bytes.map_err(|error| error.to_string())
    }
}

/// How a sampler reads a picture from near; from afar, colours are always mixed.
pub(crate) fn sampler_of(sampler: &json::texture::Sampler) -> Sampler {
    let wrap = |mode| match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        _ => Wrap::Repeat,
    };
    Sampler {
        wrap: [wrap(sampler.wrap_s), wrap(sampler.wrap_t)],
        nearest: sampler.mag_filter == Some(Checked::Valid(MagFilter::Nearest)),
    }
}

/// The alpha below which a cut-out has a hole, once its factor is taken into account.
fn cutoff(material: &json::Material) -> Option<f64> {
    let alpha = f64::from(material.pbr_metallic_roughness.base_color_factor.0[3]);
    let cutoff = material.alpha_cutoff.map_or(0.5, |cutoff| f64::from(cutoff.0));
    let is_masked = material.alpha_mode == Checked::Valid(AlphaMode::Mask);
    (is_masked && alpha > 0.0 && cutoff > 0.0 && cutoff <= alpha).then(|| cutoff / alpha)
}

/// The set of coordinates and the transform (`KHR_texture_transform`) a texture is read with.
///
/// Rotation is counter-clockwise as seen in the picture, whose v points down.
fn mapping(info: &Info) -> UvMapping {
    let transform = info.extensions.as_ref().and_then(|all| all.texture_transform.as_ref());
    let Some(transform) = transform else {
        return UvMapping { set: info.tex_coord, ..UvMapping::default() };
    };
    let rotation = DMat2::from_angle(-f64::from(transform.rotation.0));
    let scale = DMat2::from_diagonal(Vec2::from(transform.scale.0).as_dvec2());
    let offset: DVec2 = Vec2::from(transform.offset.0).as_dvec2();
    UvMapping {
        set: transform.tex_coord.unwrap_or(info.tex_coord),
        transform: DAffine2::from_mat2_translation(rotation * scale, offset),
    }
}
