//! Reading a solved GLB again.

use std::fs;
use std::path::Path;

use glam::{DVec3, Vec2, Vec3};
use gltf_json::Root;
use gltf_json::material::AlphaMode;
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;

use super::accessors::{GlbArrays, ReadResult};
use super::hung::Hung;
use super::record::{Brightened, GlbRecord};
use super::semantics::{LIGHT, RADIOSITY, TEXTURE_MEAN};
use crate::colour::Rgb;
use crate::error::{Error, Result};
use crate::export::stamp::Stamp;
use crate::reconstruct::{LightShare, MeshPart, TriMesh};
use crate::scene::{Texture, decode, sampler_of};
use crate::surface::LightGroup;

const NO_RADIOSITY: &str = "carries no radiosity (attribute _RADIOSITY); `radiosity solve SCENE -o FILE.glb` makes such a file";

const REARRANGED: &str = "was rearranged by another program; write it anew with radiosity";

/// Reads a mesh and its stamp from a GLB that [`save`](crate::export::save) wrote.
///
/// # Errors
/// When the file cannot be read, is no GLB, carries no `_RADIOSITY`, or was reshaped by another program.
pub fn load_solved(path: &Path) -> Result<(TriMesh, Stamp)> {
    let bytes = fs::read(path).map_err(Error::io(path))?;
    read(&bytes).map_err(|message| Error::format(path, message))
}

fn read(bytes: &[u8]) -> ReadResult<(TriMesh, Stamp)> {
    let (json, binary) = chunks(bytes)?;
    let root = Root::from_slice(json).map_err(|error| format!("no valid glTF: {error}"))?;
    let arrays = GlbArrays { root: &root, binary };
    let extras = root.asset.extras.as_ref();
    let record = extras.and_then(|extras| serde_json::from_str::<GlbRecord>(extras.get()).ok());
    let lights = record.iter().flat_map(|record| &record.lights);
    let share = |group: &LightGroup| LightShare { group: group.clone(), radiosity: Vec::new() };
    let mut mesh = TriMesh { lights: lights.map(share).collect(), ..TriMesh::default() };
    let (hung, mut objects) = (Hung::new(&root), Vec::new());
    for (number, primitives) in root.meshes.iter().map(|mesh| &mesh.primitives).enumerate() {
        let offset = hung.offset(number).ok_or(REARRANGED)?;
        let (object, first) = (hung.object(&mut mesh, number), mesh.positions.len());
        for primitive in primitives {
            append(&mut mesh, &arrays, primitive, object)?;
        }
        mesh.positions[first..].iter_mut().for_each(|position| *position += offset);
        objects.push(object);
    }
    hung.read(&mut mesh, &objects);
    mesh.textures = textures(&arrays)?;
    if mesh.triangles.is_empty() {
        return Err("holds no triangles".to_owned());
    }
    Ok((mesh, record.map(GlbRecord::into_stamp).unwrap_or_default()))
}

/// The JSON and the binary chunk.
fn chunks(bytes: &[u8]) -> ReadResult<(&[u8], &[u8])> {
    // The reader below subtracts the header from the length that the file states.
    let stated = bytes.get(8..12).and_then(|field| field.try_into().ok()).map(u32::from_le_bytes);
    if stated.is_none_or(|length| length < 12) {
        return Err("no GLB file".to_owned());
    }
    let glb = gltf::Glb::from_slice(bytes).map_err(|error| format!("no GLB file: {error}"))?;
    match (glb.json, glb.bin) {
        (std::borrow::Cow::Borrowed(json), Some(std::borrow::Cow::Borrowed(binary))) => {
            Ok((json, binary))
        }
        _ => Err("a GLB without binary data".to_owned()),
    }
}

/// Adds one primitive of an object as one part.
fn append(
    mesh: &mut TriMesh,
    arrays: &GlbArrays,
    primitive: &Primitive,
    object: Option<u32>,
) -> ReadResult<()> {
    if primitive.mode != Checked::Valid(Mode::Triangles) {
        return Err("holds points or lines, which radiosity does not write".to_owned());
    }
    let first = mesh.positions.len();
    append_vertices(mesh, arrays, primitive)?;
    let count = mesh.positions.len() - first;
    let offset =
        u32::try_from(mesh.positions.len()).map_err(|_| "holds too many vertices")? - count as u32;

    let indices = primitive.indices.ok_or("a primitive has no indices")?;
    let triangles = arrays.triangles(indices, count)?;
    let start = mesh.triangles.len();
    mesh.triangles.extend(triangles.iter().map(|corners| corners.map(|corner| offset + corner)));
    let like = material(arrays, primitive)?;
    mesh.parts.push(MeshPart { triangles: start..mesh.triangles.len(), object, ..like });
    Ok(())
}

fn append_vertices(
    mesh: &mut TriMesh,
    arrays: &GlbArrays,
    primitive: &Primitive,
) -> ReadResult<()> {
    let find = |semantic: Semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
    let extra = |name: &str| find(Semantic::Extras(name.to_owned()));
    let vectors = |index| -> ReadResult<Vec<Vec3>> {
        Ok(arrays.vectors::<3>(index)?.into_iter().map(Vec3::from).collect())
    };
    let doubles = |index| -> ReadResult<Vec<DVec3>> {
        Ok(vectors(index)?.into_iter().map(Vec3::as_dvec3).collect())
    };
    let radiosity = extra(RADIOSITY).ok_or(NO_RADIOSITY)?;
    let positions = doubles(find(Semantic::Positions).ok_or("a primitive has no POSITION")?)?;
    let count = positions.len();
    let normals = vectors(find(Semantic::Normals).ok_or("a primitive has no NORMAL")?)?;
    let radiosity = doubles(radiosity)?;
    let uvs = match find(Semantic::TexCoords(0)) {
        Some(index) => arrays.vectors::<2>(index)?.into_iter().map(Vec2::from).collect(),
        None => vec![Vec2::ZERO; count],
    };
    let means = match extra(TEXTURE_MEAN) {
        Some(index) => doubles(index)?,
        None => vec![Rgb::ONE; count],
    };
    if [normals.len(), radiosity.len(), uvs.len(), means.len()] != [count; 4] {
        return Err("a primitive's attributes differ in length".to_owned());
    }
    for (number, light) in mesh.lights.iter_mut().enumerate() {
        let missing = || format!("a primitive has no _{LIGHT}{number}");
        let values = doubles(extra(&format!("{LIGHT}{number}")).ok_or_else(missing)?)?;
        if values.len() != count {
            return Err("a primitive's attributes differ in length".to_owned());
        }
        light.radiosity.extend(values);
    }
    mesh.positions.extend(positions);
    mesh.normals.extend(normals);
    mesh.radiosity.extend(radiosity);
    mesh.uvs.extend(uvs);
    mesh.texture_mean.extend(means);
    Ok(())
}

/// A part without triangles that has the name of a primitive's material, its texture and its holes.
fn material(arrays: &GlbArrays, primitive: &Primitive) -> ReadResult<MeshPart> {
    let Some(index) = primitive.material else {
        return Ok(MeshPart::default());
    };
    let materials = &arrays.root.materials;
    let material = materials.get(index.value()).ok_or("a primitive's material is missing")?;
    let texture = material.pbr_metallic_roughness.base_color_texture.as_ref();
    let texture = texture.map(|info| info.index.value());
    if texture.is_some_and(|texture| texture >= arrays.root.textures.len()) {
        return Err("a material's texture is missing".to_owned());
    }
    let is_cut_out = material.alpha_mode == Checked::Valid(AlphaMode::Mask);
    let cutoff = material.alpha_cutoff.map_or(0.5, |cutoff| f64::from(cutoff.0));
    Ok(MeshPart {
        name: material.name.clone().unwrap_or_default(),
        texture: texture.map(|texture| texture as u32),
        cutoff: is_cut_out.then_some(cutoff),
        ..MeshPart::default()
    })
}

fn textures(arrays: &GlbArrays) -> ReadResult<Vec<Texture>> {
    arrays.root.textures.iter().map(|texture| read_texture(arrays, texture)).collect()
}

fn read_texture(arrays: &GlbArrays, texture: &gltf_json::Texture) -> ReadResult<Texture> {
    let root = arrays.root;
    let image = root.images.get(texture.source.value()).ok_or("a texture has no image")?;
    let view = image.buffer_view.ok_or("an image is outside of the file")?;
    let sampler = texture.sampler.and_then(|index| root.samplers.get(index.value()));
    let sampler = sampler.map(sampler_of).unwrap_or_default();
    let name = image.name.as_deref().unwrap_or_default();
    let picture = decode(name, arrays.view(view)?, sampler)
        .map_err(|error| format!("picture {name}: {error}"))?;
    Ok(match white(texture) {
        Some(white) => darkened(picture, white),
        None => picture,
    })
}

/// What white in a brightened picture stands for.
fn white(texture: &gltf_json::Texture) -> Option<f64> {
    let extras = texture.extras.as_ref()?;
    let Brightened { white } = serde_json::from_str(extras.get()).ok()?;
    (white > 0.0 && white < 1.0).then_some(white)
}

/// A picture as it was before it was brightened; its file is no longer it.
fn darkened(picture: Texture, white: f64) -> Texture {
    let darker = |texel: [f32; 3]| texel.map(|x| (f64::from(x) * white) as f32);
    let texels = picture.texels.iter().map(darker).collect();
    Texture { texels, encoded: [].into(), ..picture }
}
