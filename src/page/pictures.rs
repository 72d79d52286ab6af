//! Pictures on surfaces as a page carries them: small enough to be sent around with it.

use std::borrow::Cow;

use serde::Serialize;

use super::chunks::Chunks;
use crate::colour::Rgb;
use crate::export::picture::{Coding, encoded, encoded_as};
use crate::scene::{Texture, Wrap, mean};

/// Most texels that a side may have: one after another is tried until all pictures together are small enough.
const SIDES: [u32; 4] = [2048, 1024, 512, 256];

/// What the pictures of a viewer may take together, bytes.
const ENOUGH: usize = 4 << 20;

/// The pictures of a viewer's models, each once.
#[derive(Debug, Default)]
pub(super) struct PictureSet<'a> {
    textures: Vec<&'a Texture>,
}

/// A picture as `drawing.js` reads it.
#[derive(Debug, Serialize)]
pub(super) struct PictureRecord {
    mime: &'static str,
    /// Index into the chunks.
    chunk: usize,
    /// What white in it stands for.
    white: f64,
    /// Its mean colour, linear RGB.
    mean: [f64; 3],
    /// Along u and v.
    wrap: [&'static str; 2],
    nearest: bool,
}

impl<'a> PictureSet<'a> {
    /// The number of a texture, added unless it is there.
    pub(super) fn number(&mut self, texture: &'a Texture) -> usize {
        let is_it = |known: &&Texture| {
            known.texels.memory().0 == texture.texels.memory().0 && known.sampler == texture.sampler
        };
        self.textures.iter().position(is_it).unwrap_or_else(|| {
            self.textures.push(texture);
            self.textures.len() - 1
        })
    }

    /// What the scripts get, and the texels that a side has at most if that is less than some picture had; the bytes
    /// go to `chunks`.
    pub(super) fn packed(&self, chunks: &mut Chunks) -> (Vec<PictureRecord>, Option<u32>) {
        let mut pictures: Vec<PackedPicture> =
            self.textures.iter().map(|t| PackedPicture::new(t)).collect();
        let mut limit = None;
        for side in SIDES {
            for picture in &mut pictures {
                if picture.fit(side) {
                    limit = Some(side);
                }
            }
            if pictures.iter().map(|picture| picture.bytes.len()).sum::<usize>() <= ENOUGH {
                break;
            }
        }
        (pictures.iter().map(|picture| picture.record(chunks)).collect(), limit)
    }
}

/// A picture of one size and its bytes.
struct PackedPicture<'a> {
    texture: Cow<'a, Texture>,
    /// That of the picture in its first size, so that each of its sizes is exposed alike.
    white: f64,
    mean: Rgb,
    coding: Coding,
    bytes: Vec<u8>,
}

impl<'a> PackedPicture<'a> {
    fn new(texture: &'a Texture) -> Self {
        let white = texture.white();
        let (coding, bytes) = (Coding::of(texture, white), Vec::new());
        Self { texture: Cow::Borrowed(texture), white, mean: mean(texture), coding, bytes }
    }

    /// Makes the bytes of the picture with at most so many texels a side, and tells whether it had more.
    fn fit(&mut self, side: u32) -> bool {
        let longer = |texture: &Texture| texture.width.max(texture.height);
        let is_larger = longer(&self.texture) > side;
        while longer(&self.texture) > side {
            self.texture = Cow::Owned(self.texture.halved());
        }
        // Bytes that could not be made are none: the browser shows the surface without its picture.
        if is_larger {
            self.coding = Coding::of_shrunk(&self.texture);
            self.bytes = encoded_as(self.coding, &self.texture, self.white).unwrap_or_default();
        } else if self.bytes.is_empty() {
            self.bytes = encoded(&self.texture, self.white).unwrap_or_default().into_owned();
        }
        is_larger
    }

    fn record(&self, chunks: &mut Chunks) -> PictureRecord {
        let sampler = self.texture.sampler;
        PictureRecord {
            mime: self.coding.mime_type(),
            chunk: chunks.add(&self.bytes),
            white: self.white,
            mean: self.mean.to_array(),
            wrap: sampler.wrap.map(|wrap| match wrap {
                Wrap::Repeat => "repeat",
                Wrap::Mirror => "mirror",
                Wrap::Clamp => "clamp",
            }),
            nearest: sampler.nearest,
        }
    }
}
