//! The coarse mesh that a lightmap lies on: colours of surfaces and emission, for engines to multiply and add.

use std::collections::BTreeMap;
use std::io::{self, Write};

use glam::DVec3;
use gltf_json::extensions::material::{
    EmissiveStrength, EmissiveStrengthFactor, Material as MaterialExtensions,
};
use gltf_json::material::{
    EmissiveFactor, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor,
};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;
use gltf_json::{Asset, Index, Material};
use serde_json::json;

use super::document::Document;
use super::materials::{Materials, alpha_cutoff, alpha_mode, first_uv};
use super::record::GlbRecord;
use super::tree::NodeTree;
use crate::export::exposed::{ExposedMesh, singles};
use crate::lightmap::{CoarsePart, Lightmap};

/// Writes the mesh of a lightmap as GLB; `maps` are the names of the linear and of the exposed picture.
pub(crate) fn write(
    map: &Lightmap,
    exposed: &ExposedMesh,
    maps: &[String; 2],
    out: &mut impl Write,
) -> io::Result<()> {
    let mut coarse = CoarseGlb::new(map, exposed.origin);
    let parts = map.atlas.mesh.parts.iter();
    let primitives = parts.map(|part| coarse.primitive(part)).collect::<io::Result<_>>()?;
    let mut document = coarse.document;
    let (objects, nodes, cameras) = (&[][..], &[][..], &map.surfaces.cameras);
    let tree =
        NodeTree { objects, nodes, cameras, origin: exposed.origin, extent: map.surfaces.extent };
    tree.add(&mut document.root, BTreeMap::from([(None, primitives)]));
    let mut record = serde_json::to_value(GlbRecord::new(exposed))?;
    if let Some(fields) = record.as_object_mut() {
        fields.remove("unit");
        fields.insert("lightmap".to_owned(), about(map, maps));
    }
    document.root.asset = Asset {
        generator: Some(concat!("radiosity ", env!("CARGO_PKG_VERSION")).to_owned()),
        extras: Some(serde_json::value::to_raw_value(&record)?),
        ..Asset::default()
    };
    if document.root.materials.iter().any(|material| material.extensions.is_some()) {
        document.root.extensions_used = vec!["KHR_materials_emissive_strength".to_owned()];
    }
    document.write(out)
}

/// What there is to know of the maps.
fn about(map: &Lightmap, [linear, exposed]: &[String; 2]) -> serde_json::Value {
    json!({
        "linear": linear,
        "exposed": exposed,
        "texel": "irradiance / pi, W/(m^2 sr): radiance = albedo * texel + emission",
        "texCoord": 1,
        "size": map.atlas.size,
        "texelsPerMetre": map.atlas.density,
    })
}

/// The file under construction.
struct CoarseGlb<'a> {
    map: &'a Lightmap<'a>,
    /// Where the file's coordinates begin, m.
    origin: DVec3,
    document: Document,
    materials: Materials<'a>,
}

impl<'a> CoarseGlb<'a> {
    fn new(map: &'a Lightmap<'_>, origin: DVec3) -> Self {
        let pictures = map.surfaces.textures.iter().map(|picture| (picture, 1.0));
        Self { map, origin, document: Document::default(), materials: Materials::new(pictures) }
    }

    /// The surfaces' own colour and emission.
    fn material(&mut self, part: &CoarsePart) -> io::Result<Index<Material>> {
        let own = &self.map.surfaces[part.material];
        let mut texture = |number: Option<u32>| {
            let stored = number.map(|n| self.materials.texture(&mut self.document, n));
            stored.transpose().map(|index| index.map(first_uv))
        };
        let (base_color_texture, emissive_texture) =
            (texture(own.texture)?, texture(own.emission_texture)?);
        let [r, g, b] = singles(own.reflectance);
        let strength = own.emission.max_element().max(1.0);
        let beyond_one = EmissiveStrength {
            emissive_strength: EmissiveStrengthFactor(strength.min(f64::from(f32::MAX)) as f32),
        };
        Ok(self.document.root.push(Material {
            name: Some(own.name.clone()),
            pbr_metallic_roughness: PbrMetallicRoughness {
                base_color_factor: PbrBaseColorFactor([r, g, b, 1.0]),
                base_color_texture,
                metallic_factor: StrengthFactor(0.0),
                ..PbrMetallicRoughness::default()
            },
            alpha_mode: alpha_mode(own.cutoff),
            alpha_cutoff: alpha_cutoff(own.cutoff),
            emissive_factor: EmissiveFactor(singles(own.emission / strength)),
            emissive_texture: emissive_texture.filter(|_| own.emission.max_element() > 0.0),
            extensions: (strength > 1.0).then(|| MaterialExtensions {
                emissive_strength: Some(beyond_one),
                ..MaterialExtensions::default()
            }),
            ..Material::default()
        }))
    }

    /// The triangles of a part, with its material.
    fn primitive(&mut self, part: &CoarsePart) -> io::Result<Primitive> {
        let material = self.material(part)?;
        let Self { document, origin, .. } = self;
        let mesh = &self.map.atlas.mesh;
        let triangles = &mesh.triangles[part.triangles.clone()];
        // A part's vertices are its own, one after another.
        let corners = || triangles.as_flattened().iter().copied();
        let first = corners().min().unwrap_or_default();
        let range = first as usize..corners().max().map_or(0, |last| last as usize + 1);
        let indices: Vec<[u32; 3]> =
            triangles.iter().map(|t| t.map(|corner| corner - first)).collect();

        let positions: Vec<_> =
            mesh.positions[range.clone()].iter().map(|&p| singles(p - *origin)).collect();
        let normals: Vec<_> = mesh.normals[range.clone()].iter().map(|n| n.to_array()).collect();
        let uvs: Vec<_> = mesh.uvs[range.clone()].iter().map(|uv| uv.to_array()).collect();
        let light_uvs: Vec<_> =
            mesh.light_uvs[range.clone()].iter().map(|uv| uv.to_array()).collect();
        // The first coordinates are there without a picture, too: a second set alone is against the format's rules.
        let mut attributes = BTreeMap::from([
            (Semantic::Positions, document.positions(&positions)),
            (Semantic::Normals, document.vectors(&normals)),
            (Semantic::TexCoords(0), document.vectors(&uvs)),
            (Semantic::TexCoords(1), document.vectors(&light_uvs)),
        ]);
        let tints: Vec<_> = mesh.tints[range.clone()].iter().map(|tint| tint.to_array()).collect();
        if tints.iter().any(|tint| *tint != [1.0; 3]) {
            attributes.insert(Semantic::Colors(0), document.vectors(&tints));
        }
        Ok(Primitive {
            attributes: attributes.into_iter().map(|(key, to)| (Checked::Valid(key), to)).collect(),
            indices: Some(document.indices(&indices, range.len())),
            material: Some(material),
            mode: Checked::Valid(Mode::Triangles),
            targets: None,
            extensions: None,
            extras: None,
        })
    }
}
