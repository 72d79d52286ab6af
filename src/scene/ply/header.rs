//! What a PLY file says about itself.

use std::path::Path;

use crate::error::{Error, Result};

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// A type of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Number {
    fn named(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// What an integer means by 1 as a share.
    pub(super) fn full(self) -> Option<f64> {
        match self {
            Self::I8 => Some(f64::from(i8::MAX)),
            Self::U8 => Some(f64::from(u8::MAX)),
            Self::I16 => Some(f64::from(i16::MAX)),
            Self::U16 => Some(f64::from(u16::MAX)),
            Self::I32 => Some(f64::from(i32::MAX)),
            Self::U32 => Some(f64::from(u32::MAX)),
            Self::F32 | Self::F64 => None,
        }
    }
}

/// A number, or a list with the type of its length first.
#[derive(Clone, Copy, Debug)]
pub(super) enum PropertyKind {
    One(Number),
    List(Number, Number),
}

#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: PropertyKind,
}

/// A table.
#[derive(Debug)]
pub(super) struct PlyElement {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

#[derive(Debug)]
pub(super) struct PlyHeader {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<PlyElement>,
    /// Whether a comment names a picture.
    pub(super) has_picture: bool,
}

/// Longer headers are none.
const LONGEST: usize = 1 << 16;

/// The header of the file at `path`, and where its numbers begin.
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<(PlyHeader, usize)> {
    let mut header =
        PlyHeader { encoding: Encoding::Text, elements: Vec::new(), has_picture: false };
    let (mut start, mut number, mut formatted) = (0, 0, false);
    while let Some((line, next)) = line(bytes, start) {
        (start, number) = (next, number + 1);
        let wrong = |why: String| Error::at_line(path, number, why);
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            _ if number == 1 && line.trim() != "ply" => break,
            ["end_header", ..] if formatted => return Ok((header, start)),
            ["end_header", ..] => {
                return Err(wrong("no line says which format this is".to_owned()));
            }
            ["format", format, ..] => {
                header.encoding = encoding(format).map_err(&wrong)?;
                formatted = true;
            }
            ["comment" | "obj_info", ..] => header.has_picture |= line.contains("TextureFile"),
            ["element", name, count] => {
                let count = count.parse().map_err(|_| wrong(format!("\"{count}\" is no count")))?;
                let name = name.to_ascii_lowercase();
                header.elements.push(PlyElement { name, count, properties: Vec::new() });
            }
            ["property", .., name] => {
                let kind = kind(&words[1..words.len() - 1]);
                let kind = kind.ok_or_else(|| wrong(format!("\"{line}\" is no property")))?;
                let element = header.elements.last_mut();
                let element = element.ok_or_else(|| wrong("a property of nothing".to_owned()))?;
                element.properties.push(Property { name: name.to_ascii_lowercase(), kind });
            }
            [] | ["ply"] => {}
            _ => return Err(wrong(format!("\"{line}\" is no line of a PLY header"))),
        }
    }
    Err(Error::format(path, "not PLY: its header has no beginning or no end"))
}

/// The line from `start` on and where the next one begins, whichever way it ends.
fn line(bytes: &[u8], start: usize) -> Option<(&str, usize)> {
    let rest = bytes.get(start..bytes.len().min(LONGEST))?;
    let length = rest.iter().position(|byte| matches!(byte, b'\r' | b'\n'))?;
    let ending = if rest[length..].starts_with(b"\r\n") { 2 } else { 1 };
    let line = std::str::from_utf8(&rest[..length]).unwrap_or("?");
    Some((line, start + length + ending))
}

fn encoding(name: &str) -> std::result::Result<Encoding, String> {
    match name.to_ascii_lowercase().as_str() {
        "ascii" => Ok(Encoding::Text),
        "binary_little_endian" => Ok(Encoding::LittleEndian),
        "binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err(format!(
            "format \"{name}\"; ascii, binary_little_endian and binary_big_endian are read"
        )),
    }
}

fn kind(words: &[&str]) -> Option<PropertyKind> {
    match *words {
        ["list", length, item] => {
            Some(PropertyKind::List(Number::named(length)?, Number::named(item)?))
        }
        [number] => Some(PropertyKind::One(Number::named(number)?)),
        _ => None,
    }
}
