//! Numbers out of buffers, after everything an accessor claims has been checked.

use ::gltf::json::accessor::{Accessor, ComponentType, Type, sparse::Sparse};
use ::gltf::json::validation::{Checked, USize64};
use ::gltf::json::{Index, buffer};

use super::file::GltfFile;
use crate::error::Result;

/// Most elements of an accessor without data of its own, all zero but for sparse values.
const MAX_ZEROS: usize = 1 << 24;

/// What an accessor is read for, which decides the types it may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    Position,
    Normal,
    TexCoord,
    Colour,
    Joints,
    Weights,
    InverseBind,
}

impl Purpose {
    fn name(self) -> &'static str {
        match self {
            Self::Position => "POSITION",
            Self::Normal => "NORMAL",
            Self::TexCoord => "TEXCOORD",
            Self::Colour => "COLOR",
            Self::Joints => "JOINTS",
            Self::Weights => "WEIGHTS",
            Self::InverseBind => "inverseBindMatrices",
        }
    }

    fn admits_type(self, type_: Type) -> bool {
        match self {
            Self::Position | Self::Normal => type_ == Type::Vec3,
            Self::TexCoord => type_ == Type::Vec2,
            Self::Colour => matches!(type_, Type::Vec3 | Type::Vec4),
            Self::Joints | Self::Weights => type_ == Type::Vec4,
            Self::InverseBind => type_ == Type::Mat4,
        }
    }

    /// `quantized` tells whether the file uses `KHR_mesh_quantization`.
    fn admits_component(self, component: ComponentType, normalized: bool, quantized: bool) -> bool {
        use ComponentType::{F32, I8, I16, U8, U16, U32};
        match (self, component) {
            (Self::Joints, _) => matches!(component, U8 | U16) && !normalized,
            (_, F32) => !normalized,
            (_, U32) => false,
            (Self::Colour | Self::TexCoord | Self::Weights, U8 | U16) if normalized => true,
            (Self::Normal, I8 | I16) => normalized && quantized,
            (Self::Position | Self::TexCoord, I8 | I16 | U8 | U16) => quantized,
            _ => false,
        }
    }
}

/// What an accessor claims, or what is wrong with the claim.
type Claim<T> = std::result::Result<T, String>;

/// Equally spaced elements whose place inside `bytes` has been checked.
#[derive(Clone, Copy, Debug)]
struct AccessorLayout<'a> {
    bytes: &'a [u8],
    stride: usize,
    component: ComponentType,
    normalized: bool,
}

impl AccessorLayout<'_> {
    /// Component `part` of element `element`; normalized integers become -1..=1 or 0..=1.
    fn number(&self, element: usize, part: usize) -> f64 {
        let b = &self.bytes[element * self.stride + part * self.component.size()..];
        let share = |value: f64, full: f64| {
            if self.normalized { (value / full).max(-1.0) } else { value }
        };
        match self.component {
            ComponentType::I8 => share(f64::from(b[0] as i8), 127.0),
            ComponentType::U8 => share(f64::from(b[0]), 255.0),
            ComponentType::I16 => share(f64::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
            ComponentType::U16 => share(f64::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
            ComponentType::U32 => f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            ComponentType::F32 => f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        }
    }

    /// Component 0 of unsigned integers.
    fn integer(&self, element: usize) -> u32 {
        // Exact: every u32 is an f64.
        self.number(element, 0) as u32
    }
}

/// An accessor's type, encoding and number of elements.
#[derive(Clone, Copy, Debug)]
struct Shape {
    component: ComponentType,
    normalized: bool,
    parts: usize,
    count: usize,
}

impl GltfFile {
    /// An attribute's values, one a vertex, or nothing where the primitive has no such attribute.
    pub(super) fn attribute<const N: usize>(
        &self,
        index: Option<Index<Accessor>>,
        purpose: Purpose,
        expected: usize,
    ) -> Result<Vec<[f64; N]>> {
        let Some(index) = index else { return Ok(Vec::new()) };
        let values = self.floats(index, purpose)?;
        if values.len() != expected {
            let count = values.len();
            let message = format!("accessor {index} has {count} elements for {expected} vertices");
            return Err(self.fail(message));
        }
        Ok(values)
    }

    /// The first `N` components of every element, finite numbers all.
    pub(super) fn floats<const N: usize>(
        &self,
        index: Index<Accessor>,
        purpose: Purpose,
    ) -> Result<Vec<[f64; N]>> {
        let wrong = |why: &str| self.fail(format!("accessor {index} ({}): {why}", purpose.name()));
        let accessor = self.get(index, "accessor")?;
        let shape = shape(accessor).map_err(&wrong)?;
        let type_fits =
            matches!(accessor.type_, Checked::Valid(type_) if purpose.admits_type(type_));
        let quantized =
            self.root.extensions_used.iter().any(|name| name == "KHR_mesh_quantization");
        let encoding_fits = purpose.admits_component(shape.component, shape.normalized, quantized);
        if !(type_fits && encoding_fits && N <= shape.parts) {
            return Err(wrong("its type or component type is not allowed here"));
        }
        let values = self.values::<N>(accessor, shape).map_err(|why| wrong(&why))?;
        if values.iter().flatten().any(|value| !value.is_finite()) {
            return Err(wrong("holds a number that is not finite"));
        }
        Ok(values)
    }

    /// Vertex indices.
    pub(super) fn indices(&self, index: Index<Accessor>) -> Result<Vec<u32>> {
        let wrong = |why: &str| self.fail(format!("accessor {index} (indices): {why}"));
        let accessor = self.get(index, "accessor")?;
        let shape = shape(accessor).map_err(&wrong)?;
        let unsigned =
            matches!(shape.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if !unsigned || shape.normalized || shape.parts != 1 {
            return Err(wrong("indices must be unsigned integer scalars"));
        }
        let values = self.values::<1>(accessor, shape).map_err(|why| wrong(&why))?;
        Ok(values.into_iter().map(|[value]| value as u32).collect())
    }

    fn values<const N: usize>(
        &self,
        accessor: &Accessor,
        shape: Shape,
    ) -> std::result::Result<Vec<[f64; N]>, String> {
        let element = |layout: &AccessorLayout<'_>, index: usize| {
            std::array::from_fn(|part| layout.number(index, part))
        };
        let mut values: Vec<[f64; N]> = match accessor.buffer_view {
            Some(view) => {
                let layout = self.layout(view, accessor.byte_offset.unwrap_or_default(), shape)?;
                (0..shape.count).map(|index| element(&layout, index)).collect()
            }
            None if accessor.sparse.is_none() => {
                return Err("has no data (compressed by an extension that is not read?)".to_owned());
            }
            None if shape.count > MAX_ZEROS => return Err("is too long".to_owned()),
            None => vec![[0.0; N]; shape.count],
        };
        if let Some(sparse) = &accessor.sparse {
            let (places, layout, count) = self.sparse(sparse, shape)?;
            for index in 0..count {
                let place = places.integer(index) as usize;
                let value = values.get_mut(place).ok_or("a sparse index is out of range")?;
                *value = element(&layout, index);
            }
        }
        Ok(values)
    }

    /// Layouts of a sparse accessor's indices and values, and how many there are.
    fn sparse(
        &self,
        sparse: &Sparse,
        shape: Shape,
    ) -> Claim<(AccessorLayout<'_>, AccessorLayout<'_>, usize)> {
        let Checked::Valid(component) = sparse.indices.component_type else {
            return Err("unknown component type of sparse indices".to_owned());
        };
        let count = usize::try_from(sparse.count.0).map_err(|error| error.to_string())?;
        let places = Shape { component: component.0, normalized: false, parts: 1, count };
        let places = self.layout(sparse.indices.buffer_view, sparse.indices.byte_offset, places)?;
        let values = Shape { count, ..shape };
        let values = self.layout(sparse.values.buffer_view, sparse.values.byte_offset, values)?;
        Ok((places, values, count))
    }

    fn layout(
        &self,
        view: Index<buffer::View>,
        offset: USize64,
        shape: Shape,
    ) -> Claim<AccessorLayout<'_>> {
        let (bytes, stride) = self.view(view).map_err(|error| error.to_string())?;
        let size = shape.component.size() * shape.parts;
        let stride = stride.unwrap_or(size);
        if stride < size {
            return Err(format!("a stride of {stride} bytes for elements of {size}"));
        }
        let start = usize::try_from(offset.0).ok();
        let length = match shape.count {
            0 => Some(0),
            count => (count - 1).checked_mul(stride).and_then(|last| last.checked_add(size)),
        };
        let bytes = start
            .zip(length)
            .and_then(|(start, length)| bytes.get(start..start.checked_add(length)?));
        let bytes = bytes.ok_or_else(|| format!("reaches beyond buffer view {view}"))?;
        Ok(AccessorLayout {
            bytes,
            stride,
            component: shape.component,
            normalized: shape.normalized,
        })
    }
}

fn shape(accessor: &Accessor) -> std::result::Result<Shape, &'static str> {
    let (Checked::Valid(component), Checked::Valid(type_)) =
        (&accessor.component_type, &accessor.type_)
    else {
        return Err("unknown type or component type");
    };
    let count = usize::try_from(accessor.count.0).map_err(|_| "is too long")?;
    let normalized = accessor.normalized;
    Ok(Shape { component: component.0, normalized, parts: type_.multiplicity(), count })
}
