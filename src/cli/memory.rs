//! Memory that a solution takes, measured: limits and estimates are of one mind.

use radiosity::{Error, Result};

/// Bytes that are taken in any case.
const AT_LEAST: u64 = 10_000_000;

/// Bytes of a face of the scene, by the time that surfaces are made of it; of scenes with 7 000 to 100 000 faces.
const PER_FACE: u64 = 1_200;

/// Bytes of a patch, with its surface and what it sees of lamps.
const PER_PATCH: u64 = 3_000;

/// Bytes of an element with its vertices, triangles, and what is gathered at them; of rooms with up to 30 000.
const PER_ELEMENT: u64 = 2_300;

/// Bytes of a pixel of a picture that is drawn.
const PER_PIXEL: u64 = 120;

/// Bytes of a texel of a lightmap.
const PER_TEXEL: u64 = 70;

/// Bytes in memory that a byte of a scene's file becomes, at least.
const PER_BYTE: u64 = 8;

/// What takes memory.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Needs {
    pub(crate) faces: usize,
    pub(crate) patches: usize,
    pub(crate) elements: usize,
    /// Of the largest picture.
    pub(crate) pixels: u64,
    /// Of the lightmap.
    pub(crate) texels: u64,
    /// Of the scene's textures, which surfaces and meshes share.
    pub(crate) texture_bytes: u64,
}

impl Needs {
    /// Bytes in all, about.
    pub(crate) fn bytes(&self) -> u64 {
        // What a face has become by then is counted as a patch.
        let faces = (self.faces as u64 * PER_FACE).max(self.patches as u64 * PER_PATCH);
        let drawn = (self.pixels * PER_PIXEL).max(self.texels * PER_TEXEL);
        AT_LEAST + faces + self.texture_bytes + self.elements as u64 * PER_ELEMENT + drawn
    }
}

/// Most memory to take, bytes, if there is a limit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MemoryLimit(pub(crate) Option<u64>);

impl MemoryLimit {
    /// Whether a scene's file of so many bytes can be read.
    pub(crate) fn check_file(self, bytes: u64) -> Result<()> {
        self.check(bytes * PER_BYTE, "to read the scene")
    }

    /// Whether there is room for what is needed in any case; of `what`, for those who read it.
    pub(crate) fn check_needs(self, needs: &Needs, what: &str) -> Result<()> {
        self.check(needs.bytes(), what)
    }

    /// Elements for which there is room beside all else that is needed.
    pub(crate) fn elements(self, needs: &Needs) -> Option<usize> {
        let room = self.0?.saturating_sub(Needs { elements: 0, ..*needs }.bytes());
        Some(usize::try_from(room / PER_ELEMENT).unwrap_or(usize::MAX))
    }

    fn check(self, needed: u64, what: &str) -> Result<()> {
        match self.0 {
            Some(most) if needed > most => {
                let [needed, most] = [needed, most].map(|bytes| bytes.div_ceil(1_000_000));
                let message = format!(
                    "some {needed} MB are needed {what}, and {most} MB are allowed; a larger --patch-size needs less"
                );
                Err(Error::Setting { name: "max-memory", message })
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_room_for_as_many_elements_as_fit() {
        let limit = MemoryLimit(Some(500_000_000));
        let needs = Needs { faces: 5_000, patches: 20_000, pixels: 500_000, ..Needs::default() };
        let elements = limit.elements(&needs).unwrap();
        let full = Needs { elements, ..needs };
        assert!(limit.check_needs(&full, "").is_ok());
        let more = Needs { elements: elements + 1, ..needs };
        assert!(limit.check_needs(&more, "").is_err());
        assert!(MemoryLimit(None).elements(&needs).is_none());
    }
}
