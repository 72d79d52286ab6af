//! A solved mesh, shown as it is lit, with what is needed to compute with it.

use std::collections::BTreeMap;
use std::io::{self, Write};

use gltf_json::Asset;
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;

use super::document::Document;
use super::materials::Materials;
use super::record::GlbRecord;
use super::semantics::{LIGHT, RADIOSITY, TEXTURE_MEAN};
use super::tree::NodeTree;
use crate::export::exposed::{ExposedMesh, singles};
use crate::export::group::{self, Group};
use crate::reconstruct::TriMesh;

/// Writes a mesh that has triangles as GLB.
pub(crate) fn write(exposed: &ExposedMesh, out: &mut impl Write) -> io::Result<()> {
    let mut document = Document::default();
    let pictures = exposed.mesh.textures.iter().zip(exposed.whites.iter().copied());
    let mut materials = Materials::new(pictures);
    let mut meshes: BTreeMap<Option<u32>, Vec<Primitive>> = BTreeMap::new();
    for group in group::by_object(exposed.mesh) {
        let material = materials.add(&mut document, &group)?;
        let mut primitive = primitive(&mut document, exposed, &group);
        primitive.material = Some(material);
        meshes.entry(group.object).or_default().push(primitive);
    }
    let TriMesh { objects, nodes, cameras, .. } = exposed.mesh;
    let (low, high) = exposed.mesh.bounds();
    let tree =
        NodeTree { objects, nodes, cameras, origin: exposed.origin, extent: low.distance(high) };
    tree.add(&mut document.root, meshes);
    document.root.asset = Asset {
        generator: Some(concat!("radiosity ", env!("CARGO_PKG_VERSION")).to_owned()),
        extras: Some(GlbRecord::new(exposed).to_raw()?),
        ..Asset::default()
    };
    document.root.extensions_used = vec!["KHR_materials_unlit".to_owned()];
    document.write(out)
}

fn primitive(document: &mut Document, exposed: &ExposedMesh, group: &Group) -> Primitive {
    let mesh = exposed.mesh;
    let vertices = || group.vertices.iter().map(|&vertex| vertex as usize);
    let positions: Vec<_> =
        vertices().map(|v| singles(mesh.positions[v] - exposed.origin)).collect();
    let normals: Vec<_> = vertices().map(|v| mesh.normals[v].to_array()).collect();
    let radiosity: Vec<_> = vertices().map(|v| singles(mesh.radiosity[v])).collect();
    let light = group.vertices.iter().map(|&vertex| exposed.shown(vertex, group).to_array());
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
