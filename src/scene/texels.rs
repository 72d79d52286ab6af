//! The texels of a picture, kept as they came and shared by all that show them.

use std::sync::{Arc, LazyLock};

use serde::Serialize;

use crate::colour::linear_from_srgb;

/// Linear RGB, row by row from the top; a copy takes no memory of its own.
///
/// What came in 8 bits a channel takes three bytes a texel, all else twelve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Texels(Kept);

#[derive(Clone, Debug, PartialEq, Serialize)]
enum Kept {
    /// In sRGB, three bytes a texel.
    Coded(Arc<Vec<u8>>),
    Linear(Arc<Vec<[f32; 3]>>),
}

/// What the codes of sRGB stand for.
static DECODED: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| linear_from_srgb(code as f64 / 255.0) as f32));

impl Texels {
    /// Those of a picture coded in sRGB, three bytes a texel.
    pub fn from_srgb(codes: Vec<u8>) -> Self {
        Self(Kept::Coded(Arc::new(codes)))
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        match &self.0 {
            Kept::Coded(codes) => codes.len() / 3,
            Kept::Linear(texels) => texels.len(),
        }
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The texel of this number, if there is one.
    pub fn get(&self, index: usize) -> Option<[f32; 3]> {
        match &self.0 {
            Kept::Coded(codes) => {
                let texel = codes.as_chunks::<3>().0.get(index);
                texel.map(|texel| texel.map(|code| DECODED[usize::from(code)]))
            }
            Kept::Linear(texels) => texels.get(index).copied(),
        }
    }

    /// One after another.
    pub fn iter(&self) -> impl Iterator<Item = [f32; 3]> + '_ {
        (0..self.len()).filter_map(|index| self.get(index))
    }

    /// Where they lie, which is the same for copies, and how many bytes they take.
    pub fn memory(&self) -> (usize, u64) {
        let (place, bytes) = match &self.0 {
            Kept::Coded(codes) => (codes.as_ptr().addr(), codes.len()),
            Kept::Linear(texels) => (texels.as_ptr().addr(), size_of_val(texels.as_slice())),
        };
        (place, bytes as u64)
    }

    /// The same with no channel above 1.
    pub(crate) fn at_most_one(self) -> Self {
        let has_more = |texels: &[[f32; 3]]| texels.iter().flatten().any(|&x| x > 1.0);
        match &self.0 {
            Kept::Linear(texels) if has_more(texels) => {
                texels.iter().map(|texel| texel.map(|x| x.min(1.0))).collect()
            }
            _ => self,
        }
    }
}

impl Default for Texels {
    fn default() -> Self {
        Self(Kept::Linear(Arc::default()))
    }
}

impl From<Vec<[f32; 3]>> for Texels {
    fn from(texels: Vec<[f32; 3]>) -> Self {
        Self(Kept::Linear(Arc::new(texels)))
    }
}

impl FromIterator<[f32; 3]> for Texels {
    fn from_iter<I: IntoIterator<Item = [f32; 3]>>(texels: I) -> Self {
        texels.into_iter().collect::<Vec<_>>().into()
    }
}
