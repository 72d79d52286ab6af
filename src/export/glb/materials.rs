//! Materials that show light as it is, with the pictures it falls on.

use std::collections::BTreeMap;
use std::io;

use gltf_json::extensions::material::{Material as MaterialExtensions, Unlit};
use gltf_json::image::MimeType;
use gltf_json::material::{AlphaCutoff, AlphaMode, PbrMetallicRoughness, StrengthFactor};
use gltf_json::texture::{Info, MagFilter, MinFilter, Sampler, WrappingMode};
use gltf_json::validation::Checked;
use gltf_json::{Image, Index, Material, Texture};

use super::document::Document;
use super::record::Brightened;
use crate::export::group::Group;
use crate::export::picture::{self, Coding};
use crate::scene::{Texture as Picture, Wrap};

/// The pictures that a document holds already.
#[derive(Debug)]
pub(super) struct Materials<'a> {
    /// The pictures that it may hold, each with what becomes white in the document.
    pictures: Vec<(&'a Picture, f64)>,
    textures: BTreeMap<u32, Index<Texture>>,
    /// The materials that are there already.
    known: BTreeMap<(String, Option<u32>, Option<u64>), Index<Material>>,
}

impl<'a> Materials<'a> {
    pub(super) fn new(pictures: impl Iterator<Item = (&'a Picture, f64)>) -> Self {
        Self { pictures: pictures.collect(), textures: BTreeMap::new(), known: BTreeMap::new() }
    }

    /// The material of `group`, added the first time it is used, with its picture.
    pub(super) fn add(
        &mut self,
        document: &mut Document,
        group: &Group,
    ) -> io::Result<Index<Material>> {
        let (name, texture, cutoff) = group.key();
        let key = (name.to_owned(), texture, cutoff);
        if let Some(&known) = self.known.get(&key) {
            return Ok(known);
        }
        let texture = match texture {
            Some(texture) => Some(self.texture(document, texture)?),
            None => None,
        };
        let pbr_metallic_roughness = PbrMetallicRoughness {
            base_color_texture: texture.map(first_uv),
            metallic_factor: StrengthFactor(0.0),
            ..PbrMetallicRoughness::default()
        };
        let material = document.root.push(Material {
            name: Some(group.name.to_owned()),
            pbr_metallic_roughness,
            alpha_mode: alpha_mode(group.cutoff),
            alpha_cutoff: alpha_cutoff(group.cutoff),
            extensions: Some(MaterialExtensions {
                unlit: Some(Unlit {}),
                ..MaterialExtensions::default()
            }),
            ..Material::default()
        });
        self.known.insert(key, material);
        Ok(material)
    }

    /// The picture of this number, stored once.
    pub(super) fn texture(
        &mut self,
        document: &mut Document,
        number: u32,
    ) -> io::Result<Index<Texture>> {
        if let Some(&known) = self.textures.get(&number) {
            return Ok(known);
        }
        let (texture, white) = self.pictures[number as usize];
        let view = document.view(&picture::encoded(texture, white)?, None);
        let name = (!texture.name.is_empty()).then(|| texture.name.clone());
        let source = document.root.push(Image {
            buffer_view: Some(view),
            mime_type: Some(MimeType(Coding::of(texture, white).mime_type().to_owned())),
            name: name.clone(),
            uri: None,
            extensions: None,
            extras: None,
        });
        let sampler = document.root.push(sampler(texture.sampler));
        let index = document.root.push(Texture {
            name,
            sampler: Some(sampler),
            source,
            extensions: None,
            extras: (white != 1.0).then(|| Brightened { white }.to_raw()).transpose()?,
        });
        self.textures.insert(number, index);
        Ok(index)
    }
}

/// How a material with holes where alpha is below `cutoff`, or without holes, is shown.
pub(super) fn alpha_mode(cutoff: Option<f64>) -> Checked<AlphaMode> {
    Checked::Valid(if cutoff.is_some() { AlphaMode::Mask } else { AlphaMode::Opaque })
}

pub(super) fn alpha_cutoff(cutoff: Option<f64>) -> Option<AlphaCutoff> {
    cutoff.map(|cutoff| AlphaCutoff(cutoff as f32))
}

/// A texture laid on by the first coordinates.
pub(super) fn first_uv(index: Index<Texture>) -> Info {
    Info { index, tex_coord: 0, extensions: None, extras: None }
}

fn sampler(read: crate::scene::Sampler) -> Sampler {
    let [wrap_s, wrap_t] = read.wrap.map(|wrap| {
        Checked::Valid(match wrap {
            Wrap::Repeat => WrappingMode::Repeat,
            Wrap::Mirror => WrappingMode::MirroredRepeat,
            Wrap::Clamp => WrappingMode::ClampToEdge,
        })
    });
    // Blender goes by both, three.js by either in its turn.
    let (near, far) = match read.nearest {
        true => (MagFilter::Nearest, MinFilter::NearestMipmapLinear),
        false => (MagFilter::Linear, MinFilter::LinearMipmapLinear),
    };
    Sampler {
        mag_filter: Some(Checked::Valid(near)),
        min_filter: Some(Checked::Valid(far)),
        wrap_s,
        wrap_t,
        ..Sampler::default()
    }
}
