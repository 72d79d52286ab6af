//! What scene files say is what scenes hold, and no file can break the reader.

mod asset;
mod changed;
mod gltf;
mod ies;
mod mutated;
mod obj;
mod refused;

use std::path::PathBuf;

use radiosity::scene::{LoadOptions, Scene, load};
use tempfile::TempDir;

/// A folder of small files that vanishes with the test.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(TempDir::new().expect("a temporary folder"))
    }

    fn with(self, name: &str, content: impl AsRef<[u8]>) -> Self {
        std::fs::write(self.path(name), content).expect("a writable temporary folder");
        self
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn load(&self, name: &str) -> radiosity::Result<Scene> {
        load(&self.path(name), &LoadOptions::default())
    }
}

/// A red PNG of one texel.
fn red_png() -> Vec<u8> {
    let picture = image::RgbImage::from_pixel(1, 1, image::Rgb([255, 0, 0]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).expect("an encoded picture");
    bytes.into_inner()
}

#[test]
fn unknown_endings_and_missing_files_are_named() {
    let folder = Folder::new().with("a.xyz", "");
    assert!(folder.load("a.xyz").unwrap_err().to_string().contains(".obj, .gltf, .glb"));
    assert!(folder.load("none.obj").unwrap_err().to_string().contains("none.obj"));
}

#[test]
fn a_file_without_faces_is_no_scene() {
    let folder =
        Folder::new().with("a.obj", "v 0 0 0\n").with("b.gltf", r#"{"asset":{"version":"2.0"}}"#);
    for name in ["a.obj", "b.gltf"] {
        assert!(folder.load(name).unwrap_err().to_string().contains("no faces"));
    }
}
