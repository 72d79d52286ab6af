//! A GLB under construction: its JSON, and the bytes that the JSON points into.

use std::io::{self, Write};

use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::buffer::{Target, View};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Accessor, Buffer, Index, Root};

/// Bytes of the file header and of the header of a chunk.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// The JSON and the binary chunk; views begin at multiples of four bytes.
#[derive(Debug, Default)]
pub(crate) struct Document {
    pub(crate) root: Root,
    binary: Vec<u8>,
}

impl Document {
    /// Stores `bytes` and returns the view of them.
    pub(crate) fn view(&mut self, bytes: &[u8], target: Option<Target>) -> Index<View> {
        pad(&mut self.binary, 0);
        let offset = self.binary.len();
        self.binary.extend_from_slice(bytes);
        self.root.push(View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(offset)),
            byte_stride: None,
            name: None,
            target: target.map(Checked::Valid),
            extensions: None,
            extras: None,
        })
    }

    /// Stores vectors of two or three numbers a vertex.
    pub(crate) fn vectors<const N: usize>(&mut self, values: &[[f32; N]]) -> Index<Accessor> {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes, Some(Target::ArrayBuffer));
        let shape = if N == 2 { Type::Vec2 } else { Type::Vec3 };
        self.root.push(accessor(view, ComponentType::F32, shape, values.len()))
    }

    /// Stores positions, whose bounds glTF asks for.
    pub(crate) fn positions(&mut self, values: &[[f32; 3]]) -> Index<Accessor> {
        let mut bounds = [[f32::MAX; 3], [f32::MIN; 3]];
        for value in values {
            for axis in 0..3 {
                bounds[0][axis] = bounds[0][axis].min(value[axis]);
                bounds[1][axis] = bounds[1][axis].max(value[axis]);
            }
        }
        let index = self.vectors(values);
        let accessor = &mut self.root.accessors[index.value()];
        accessor.min = Some(serde_json::json!(bounds[0]));
        accessor.max = Some(serde_json::json!(bounds[1]));
        index
    }

    /// Stores colours, 0..=1, as 16-bit fractions with an opaque alpha.
    pub(crate) fn colours(
        &mut self,
        values: impl ExactSizeIterator<Item = [f64; 3]>,
    ) -> Index<Accessor> {
        let count = values.len();
        let fraction = |x: f64| (x.clamp(0.0, 1.0) * f64::from(u16::MAX)).round() as u16;
        let bytes: Vec<u8> = values
            .flat_map(|[r, g, b]| [fraction(r), fraction(g), fraction(b), u16::MAX])
            .flat_map(u16::to_le_bytes)
            .collect();
        let view = self.view(&bytes, Some(Target::ArrayBuffer));
        let mut accessor = accessor(view, ComponentType::U16, Type::Vec4, count);
        accessor.normalized = true;
        self.root.push(accessor)
    }

    /// Stores the corners of triangles over `vertices` vertices, in two bytes each where that does.
    pub(crate) fn indices(&mut self, corners: &[[u32; 3]], vertices: usize) -> Index<Accessor> {
        let corners = corners.as_flattened();
        // The largest index of each width is kept from use: some graphics interfaces end strips by it.
        let short = vertices <= usize::from(u16::MAX);
        let (bytes, component): (Vec<u8>, _) = if short {
            let bytes = corners.iter().flat_map(|&corner| (corner as u16).to_le_bytes());
            (bytes.collect(), ComponentType::U16)
        } else {
            let bytes = corners.iter().flat_map(|corner| corner.to_le_bytes());
            (bytes.collect(), ComponentType::U32)
        };
        let view = self.view(&bytes, Some(Target::ElementArrayBuffer));
        self.root.push(accessor(view, component, Type::Scalar, corners.len()))
    }

    /// Writes the file; fails if it is longer than the format can say.
    pub(crate) fn write(mut self, out: &mut impl Write) -> io::Result<()> {
        pad(&mut self.binary, 0);
        self.root.push(Buffer {
            byte_length: USize64::from(self.binary.len()),
            name: None,
            uri: None,
            extensions: None,
            extras: None,
        });
        let mut json = self.root.to_vec()?;
        pad(&mut json, b' ');
        let length = HEADER + 2 * CHUNK_HEADER + json.len() + self.binary.len();

        out.write_all(b"glTF")?;
        out.write_all(&2_u32.to_le_bytes())?;
        out.write_all(&length_field(length)?)?;
        for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &self.binary)] {
            out.write_all(&length_field(chunk.len())?)?;
            out.write_all(kind)?;
            out.write_all(chunk)?;
        }
        Ok(())
    }
}

fn accessor(view: Index<View>, component: ComponentType, shape: Type, count: usize) -> Accessor {
    Accessor {
        buffer_view: Some(view),
        byte_offset: None,
        count: USize64::from(count),
        component_type: Checked::Valid(GenericComponentType(component)),
        type_: Checked::Valid(shape),
        min: None,
        max: None,
        name: None,
        normalized: false,
        sparse: None,
        extensions: None,
        extras: None,
    }
}

fn pad(bytes: &mut Vec<u8>, filler: u8) {
    bytes.resize(bytes.len().next_multiple_of(4), filler);
}

fn length_field(length: usize) -> io::Result<[u8; 4]> {
    let length = u32::try_from(length).map_err(|_| {
        io::Error::new(
            io::ErrorKind::FileTooLarge,
            "a GLB cannot be longer than 4 GiB; write .ply, or solve with a larger smallest element",
        )
    })?;
    Ok(length.to_le_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_beyond_four_gibibytes_is_an_error() {
        assert_eq!(length_field(u32::MAX as usize).unwrap(), [0xff; 4]);
        assert!(length_field(u32::MAX as usize + 1).is_err());
    }

    #[test]
    fn indices_take_two_bytes_until_the_largest_would_be_used() {
        let component = |vertices| {
            let mut document = Document::default();
            let index = document.indices(&[[0, 1, 2]], vertices);
            document.root.accessors[index.value()].component_type.unwrap().0
        };
        assert_eq!(component(65_535), ComponentType::U16);
        assert_eq!(component(65_536), ComponentType::U32);
    }
}
