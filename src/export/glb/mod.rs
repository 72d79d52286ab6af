//! GLB: the scene's nodes, one mesh an object, one primitive a material, shown as it is lit; and the way back.

mod accessors;
mod document;
mod hung;
mod lightmap;
mod materials;
mod read;
mod record;
mod tree;

use std::collections::BTreeMap;
use std::io::{self, Write};

use gltf_json::Asset;
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;

use super::group::{self, Group};
use super::look::{Look, singles};
use crate::reconstruct::TriMesh;
use document::Document;
use materials::Materials;
use record::Record;
use tree::Tree;

pub(crate) use lightmap::write as write_lightmap;
pub use read::load_solved;

/// Attribute with the radiosity, W/m² per channel; glTF puts an underscore before it.
const RADIOSITY: &str = "RADIOSITY";

/// Attribute with the mean of the picture under a vertex, only on textured primitives.
const TEXTURE_MEAN: &str = "TEXTURE_MEAN";

/// Attributes with the radiosity by each of the lights in `asset.extras`, at a strength of 1, W/m² per channel; a
/// number follows.
const LIGHT: &str = "LIGHT_";

/// Writes a mesh that has triangles as GLB.
pub(crate) fn write(look: &Look, out: &mut impl Write) -> io::Result<()> {
    let mut document = Document::default();
    let pictures = look.mesh.textures.iter().zip(look.whites.iter().copied());
    let mut materials = Materials::new(pictures);
    let mut meshes: BTreeMap<Option<u32>, Vec<Primitive>> = BTreeMap::new();
    for group in group::by_object(look.mesh) {
        let material = materials.add(&mut document, &group)?;
        let mut primitive = primitive(&mut document, look, &group);
        primitive.material = Some(material);
        meshes.entry(group.object).or_default().push(primitive);
    }
    let TriMesh { objects, nodes, cameras, .. } = look.mesh;
    let (low, high) = look.mesh.bounds();
    let tree = Tree { objects, nodes, cameras, origin: look.origin, extent: low.distance(high) };
    tree.add(&mut document.root, meshes);
    document.root.asset = Asset {
        generator: Some(concat!("radiosity ", env!("CARGO_PKG_VERSION")).to_owned()),
        extras: Some(Record::new(look).to_raw()?),
        ..Asset::default()
    };
    document.root.extensions_used = vec!["KHR_materials_unlit".to_owned()];
    document.write(out)
}

fn primitive(document: &mut Document, look: &Look, group: &Group) -> Primitive {
    let mesh = look.mesh;
    let vertices = || group.vertices.iter().map(|&vertex| vertex as usize);
    let positions: Vec<_> = vertices().map(|v| singles(mesh.positions[v] - look.origin)).collect();
    let normals: Vec<_> = vertices().map(|v| mesh.normals[v].to_array()).collect();
    let radiosity: Vec<_> = vertices().map(|v| singles(mesh.radiosity[v])).collect();
    let light = group.vertices.iter().map(|&vertex| look.shown(vertex, group).to_array());
    let mut attributes = BTreeMap::from([
        (Semantic::Positions, document.positions(&positions)),
        (Semantic::Normals, document.vectors(&normals)),
        (Semantic::Colors(0), document.colours(light)),
        (Semantic::Extras(RADIOSITY.to_owned()), document.vectors(&radiosity)),
    ]);
    for (number, light) in mesh.lights.iter().enumerate() {
        let radiosity: Vec<_> = vertices().map(|v| singles(light.radiosity[v])).collect();
        let name = format!("{LIGHT}{number}");
        attributes.insert(Semantic::Extras(name), document.vectors(&radiosity));
    }
    if group.texture.is_some() {
        let uvs: Vec<_> = vertices().map(|v| mesh.uvs[v].to_array()).collect();
        let means: Vec<_> = vertices().map(|v| singles(mesh.texture_mean[v])).collect();
        attributes.insert(Semantic::TexCoords(0), document.vectors(&uvs));
        attributes.insert(Semantic::Extras(TEXTURE_MEAN.to_owned()), document.vectors(&means));
    }
    Primitive {
        attributes: attributes.into_iter().map(|(key, to)| (Checked::Valid(key), to)).collect(),
        indices: Some(document.indices(&group.triangles, group.vertices.len())),
        material: None,
        mode: Checked::Valid(Mode::Triangles),
        targets: None,
        extensions: None,
        extras: None,
    }
}
