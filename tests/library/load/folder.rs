//! A folder of small files for tests to load.

use std::path::PathBuf;

use radiosity::scene::{LoadOptions, Scene, load};
use tempfile::TempDir;

/// A folder of small files that vanishes with the test.
pub(crate) struct Folder(TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(TempDir::new().expect("a temporary folder"))
    }

    pub(crate) fn with(self, name: &str, content: impl AsRef<[u8]>) -> Self {
        std::fs::write(self.path(name), content).expect("a writable temporary folder");
        self
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn load(&self, name: &str) -> radiosity::Result<Scene> {
        load(&self.path(name), &LoadOptions::default())
    }
}

/// A red PNG of one texel.
pub(crate) fn red_png() -> Vec<u8> {
    let picture = image::RgbImage::from_pixel(1, 1, image::Rgb([255, 0, 0]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).expect("an encoded picture");
    bytes.into_inner()
}
