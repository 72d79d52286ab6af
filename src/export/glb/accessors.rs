//! Reading the arrays of a GLB, with every claim of its JSON checked.

use gltf_json::accessor::{ComponentType, Type};
use gltf_json::buffer::View;
use gltf_json::validation::Checked;
use gltf_json::{Accessor, Index, Root};

/// What was read of a GLB, or what is wrong with it, in words.
pub(super) type ReadResult<T> = Result<T, String>;

/// The JSON of a GLB and the bytes it points into.
#[derive(Debug)]
pub(super) struct GlbArrays<'a> {
    pub(super) root: &'a Root,
    pub(super) binary: &'a [u8],
}

impl<'a> GlbArrays<'a> {
    /// The bytes of a view.
    pub(super) fn view(&self, index: Index<View>) -> ReadResult<&'a [u8]> {
        let missing = || format!("buffer view {index} reaches beyond the file");
        let view = self.root.buffer_views.get(index.value()).ok_or_else(missing)?;
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let end = start.checked_add(view.byte_length.0).ok_or_else(missing)?;
        let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
        range.and_then(|(start, end)| self.binary.get(start..end)).ok_or_else(missing)
    }

    /// Vectors of two or three finite single-precision numbers.
    pub(super) fn vectors<const N: usize>(
        &self,
        index: Index<Accessor>,
    ) -> ReadResult<Vec<[f32; N]>> {
        let shape = if N == 2 { Type::Vec2 } else { Type::Vec3 };
        let bytes = self.packed(index, ComponentType::F32, shape)?;
        let numbers = bytes.as_chunks::<4>().0.iter().map(|&bytes| f32::from_le_bytes(bytes));
        let numbers: Vec<f32> = numbers.collect();
        if numbers.iter().any(|number| !number.is_finite()) {
            return Err(format!("accessor {index} holds a value that is not a number"));
        }
        Ok(numbers.as_chunks::<N>().0.to_vec())
    }

    /// Corners of triangles, each below `vertices`.
    pub(super) fn triangles(
        &self,
        index: Index<Accessor>,
        vertices: usize,
    ) -> ReadResult<Vec<[u32; 3]>> {
        let component =
            self.root.accessors.get(index.value()).map(|accessor| accessor.component_type);
        let corners: Vec<u32> = match component {
            Some(Checked::Valid(component)) if component.0 == ComponentType::U16 => {
                let bytes = self.packed(index, ComponentType::U16, Type::Scalar)?;
                let corners = bytes.as_chunks::<2>().0;
                corners.iter().map(|&bytes| u16::from_le_bytes(bytes).into()).collect()
            }
            _ => {
                let bytes = self.packed(index, ComponentType::U32, Type::Scalar)?;
                bytes.as_chunks::<4>().0.iter().map(|&bytes| u32::from_le_bytes(bytes)).collect()
            }
        };
        let (triangles, rest) = corners.as_chunks::<3>();
        if !rest.is_empty() || corners.iter().any(|&corner| corner as usize >= vertices) {
            return Err(format!("accessor {index} does not hold the corners of triangles"));
        }
        Ok(triangles.to_vec())
    }

    /// The bytes of an accessor of the given type whose items lie one after another.
    fn packed(
        &self,
        index: Index<Accessor>,
        component: ComponentType,
        shape: Type,
    ) -> ReadResult<&'a [u8]> {
        let wrong = |what: &str| format!("accessor {index} {what}");
        let accessor =
            self.root.accessors.get(index.value()).ok_or_else(|| wrong("does not exist"))?;
        let same_component =
            matches!(accessor.component_type, Checked::Valid(found) if found.0 == component);
        if !same_component || accessor.type_ != Checked::Valid(shape) {
            return Err(wrong("is not of the type that radiosity writes"));
        }
        let item = component.size() * shape.multiplicity();
        let view = accessor.buffer_view.filter(|_| accessor.sparse.is_none());
        let view = view.ok_or_else(|| wrong("is sparse"))?;
        let stride = self.root.buffer_views.get(view.value()).and_then(|view| view.byte_stride);
        if stride.is_some_and(|stride| stride.0 != item) {
            return Err(wrong("is interleaved, which radiosity does not write"));
        }
        let length = usize::try_from(accessor.count.0).ok().and_then(|n| n.checked_mul(item));
        let start = usize::try_from(accessor.byte_offset.map_or(0, |offset| offset.0)).ok();
        start
            .zip(length)
            .and_then(|(start, length)| start.checked_add(length).map(|end| start..end))
            .and_then(|range| self.view(view).ok()?.get(range))
            .ok_or_else(|| wrong("reaches beyond its buffer view"))
    }
}
