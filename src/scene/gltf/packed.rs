//! Buffers that extensions compress, unpacked: what reads them after that finds them as if they had been plain.

use std::collections::BTreeMap;

use ::gltf::json::Index;
use ::gltf::json::accessor::{Accessor, ComponentType, GenericComponentType, Type};
use ::gltf::json::buffer::{Buffer, View};
use ::gltf::json::mesh::Mode;
use ::gltf::json::validation::{Checked, USize64};
use draco_core::{DecoderBuffer, Mesh, MeshDecoder};
use meshoptimizer_rs::Workspace;
use meshoptimizer_rs::codec::{BufferView, Filter, Mode as Packing};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use smallvec::SmallVec;

use super::extensions::{DRACO, MESHOPT};
use super::file::GltfFile;
use crate::error::Result;

/// Most bytes that one byte of meshopt's may stand for; its densest code is a quarter of a byte for 16 equal ones.
const MOST_UNPACKED: usize = 256;

/// What meshopt says of a view.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct PackedView {
    buffer: Index<Buffer>,
    #[serde(default)]
    byte_offset: USize64,
    byte_length: USize64,
    byte_stride: usize,
    count: usize,
    mode: String,
    filter: Option<String>,
}

/// What Draco says of a primitive: where its bytes are, and their numbers for its attributes.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct PackedPrimitive {
    buffer_view: Index<View>,
    attributes: BTreeMap<String, u32>,
}

/// What an extension says, if it is there; an error if that cannot be understood.
fn said<T: DeserializeOwned>(
    name: &str,
    extensions: Option<&Map<String, Value>>,
) -> Option<std::result::Result<T, String>> {
    let value = extensions?.get(name)?;
    Some(serde_json::from_value(value.clone()).map_err(|error| format!("{name}: {error}")))
}

impl GltfFile {
    /// Unpacks all that is compressed.
    pub(super) fn unpack(&mut self) -> Result<()> {
        for number in 0..self.root.buffer_views.len() {
            let view = &self.root.buffer_views[number];
            let stride = view.byte_stride;
            let said = said(MESHOPT, view.extensions.as_ref().map(|all| &all.others));
            let Some(packed) = said else { continue };
            let bytes = packed.and_then(|packed| self.unpacked_view(&packed));
            let bytes = bytes.map_err(|why| self.fail(format!("buffer view {number}: {why}")))?;
            self.root.buffer_views[number] = self.add_bytes(bytes, stride);
        }
        for mesh in 0..self.root.meshes.len() {
            for number in 0..self.root.meshes[mesh].primitives.len() {
                self.unpack_primitive(mesh, number)?;
            }
        }
        Ok(())
    }

    fn unpacked_view(&self, packed: &PackedView) -> std::result::Result<Vec<u8>, String> {
        let wrong = |error: meshoptimizer_rs::Error| format!("{MESHOPT}: {error}");
        let bytes = self.bytes(packed.buffer, packed.byte_offset, packed.byte_length);
        let bytes = bytes.ok_or_else(|| format!("{MESHOPT}: it lies outside its buffer"))?;
        let mode = Packing::parse(&packed.mode).map_err(wrong)?;
        let filter = packed.filter.as_deref().map_or(Ok(Filter::None), Filter::parse);
        let view = BufferView::new(mode, filter.map_err(wrong)?, packed.count, packed.byte_stride);
        let view = view.map_err(wrong)?;
        if view.byte_length() / MOST_UNPACKED > bytes.len() {
            return Err(format!("{MESHOPT}: {} bytes cannot hold so much", bytes.len()));
        }
        view.decode(bytes, &mut Workspace::default()).map_err(wrong)
    }

    fn unpack_primitive(&mut self, mesh: usize, number: usize) -> Result<()> {
        let primitive = &self.root.meshes[mesh].primitives[number];
        let said = said(DRACO, primitive.extensions.as_ref().map(|all| &all.others));
        let Some(packed) = said else { return Ok(()) };
        let packed: PackedPrimitive = packed.map_err(|why| self.fail(why))?;
        let (bytes, _) = self.view(packed.buffer_view)?;
        let shape = unpacked(bytes).map_err(|why| self.fail(format!("{DRACO}: {why}")))?;
        let mut attributes = primitive.attributes.clone();
        for (semantic, index) in &mut attributes {
            let Some(&id) = packed.attributes.get(&semantic.to_string()) else { continue };
            let missing = || self.fail(format!("{DRACO}: attribute {id} does not exist"));
            let values = shape.attribute_by_unique_id(id).ok_or_else(missing)?;
            let accessor = self.get(*index, "accessor")?;
            let (Checked::Valid(type_), Checked::Valid(component)) =
                (accessor.type_, accessor.component_type)
            else {
                continue;
            };
            let numbers = values.read_f32s(shape.num_points(), type_.multiplicity());
            let bytes = numbers.iter().flat_map(|&number| coded(component.0, number)).collect();
            let plain = Accessor { count: shape.num_points().into(), ..accessor.clone() };
            *index = self.add_accessor(plain, bytes);
        }
        let corners = shape.faces().iter().flatten().flat_map(|corner| corner.0.to_le_bytes());
        let corners = corners.collect();
        let indices = self.add_accessor(indices(3 * shape.num_faces()), corners);
        let primitive = &mut self.root.meshes[mesh].primitives[number];
        (primitive.attributes, primitive.indices) = (attributes, Some(indices));
        primitive.mode = Checked::Valid(Mode::Triangles);
        Ok(())
    }

    /// Adds an accessor like one that there is, or was to be, of these bytes.
    fn add_accessor(&mut self, like: Accessor, bytes: Vec<u8>) -> Index<Accessor> {
        let view = self.add_bytes(bytes, None);
        let view = self.root.push(view);
        let own = Accessor { buffer_view: Some(view), byte_offset: None, sparse: None, ..like };
        self.root.push(own)
    }
}

/// The triangles that Draco's bytes stand for.
fn unpacked(bytes: &[u8]) -> std::result::Result<Mesh, String> {
    let mut mesh = Mesh::new();
    let decoded = MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes), &mut mesh);
    decoded.map(|()| mesh).map_err(|error| error.to_string())
}

/// An accessor of so many indices.
fn indices(count: usize) -> Accessor {
    Accessor {
        buffer_view: None,
        byte_offset: None,
        count: count.into(),
        component_type: Checked::Valid(GenericComponentType(ComponentType::U32)),
        extensions: None,
        extras: None,
        type_: Checked::Valid(Type::Scalar),
        min: None,
        max: None,
        name: None,
        normalized: false,
        sparse: None,
    }
}

/// A number as an accessor's component has it.
fn coded(component: ComponentType, number: f32) -> SmallVec<[u8; 4]> {
    match component {
        ComponentType::I8 => (number as i8).to_le_bytes()[..].into(),
        ComponentType::U8 => (number as u8).to_le_bytes()[..].into(),
        ComponentType::I16 => (number as i16).to_le_bytes()[..].into(),
        ComponentType::U16 => (number as u16).to_le_bytes()[..].into(),
        ComponentType::U32 => (number as u32).to_le_bytes()[..].into(),
        ComponentType::F32 => number.to_le_bytes()[..].into(),
    }
}
