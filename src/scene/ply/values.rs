//! The numbers of a PLY file, one after another.

use super::header::{Encoding, Number, Property, PropertyKind};

/// What is left to read.
pub(super) struct Values<'a> {
    rest: &'a [u8],
    encoding: Encoding,
}

impl<'a> Values<'a> {
    pub(super) fn new(rest: &'a [u8], encoding: Encoding) -> Self {
        Self { rest, encoding }
    }

    /// The number of a property; of a list its length, its items in `items` if they are wanted.
    pub(super) fn property(
        &mut self,
        property: &Property,
        items: Option<&mut Vec<f64>>,
    ) -> Result<f64, String> {
        let told = |why: String| format!("{}: {why}", property.name);
        let (length, item) = match property.kind {
            PropertyKind::One(number) => return self.next(number).map_err(told),
            PropertyKind::List(length, item) => (self.next(length).map_err(told)?, item),
        };
        if !(length >= 0.0 && length.fract() == 0.0) {
            return Err(told(format!("a list of {length} items")));
        }
        let mut items = items;
        if let Some(items) = &mut items {
            items.clear();
        }
        // However long a list claims to be, the file ends first.
        for _ in 0..length as u64 {
            let value = self.next(item).map_err(told)?;
            if let Some(items) = &mut items {
                items.push(value);
            }
        }
        Ok(length)
    }

    fn next(&mut self, number: Number) -> Result<f64, String> {
        if self.encoding == Encoding::Text {
            return self.word();
        }
        Ok(match number {
            Number::I8 => i8::from_le_bytes(self.bytes()?).into(),
            Number::U8 => u8::from_le_bytes(self.bytes()?).into(),
            Number::I16 => i16::from_le_bytes(self.bytes()?).into(),
            Number::U16 => u16::from_le_bytes(self.bytes()?).into(),
            Number::I32 => i32::from_le_bytes(self.bytes()?).into(),
            Number::U32 => u32::from_le_bytes(self.bytes()?).into(),
            Number::F32 => f32::from_le_bytes(self.bytes()?).into(),
            Number::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    /// The next bytes, the least of them first.
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (&bytes, rest) = self.rest.split_first_chunk().ok_or("the file ends here")?;
        self.rest = rest;
        let mut bytes: [u8; N] = bytes;
        if self.encoding == Encoding::BigEndian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    fn word(&mut self) -> Result<f64, String> {
        let start = self.rest.iter().position(|byte| !byte.is_ascii_whitespace());
        let rest = &self.rest[start.ok_or("the file ends here")?..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        self.rest = rest;
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        number.ok_or_else(|| format!("\"{}\" is not a number", String::from_utf8_lossy(word)))
    }
}
