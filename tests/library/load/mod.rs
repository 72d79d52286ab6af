//! What scene files say is what scenes hold, and no file can break the reader.

pub(crate) mod asset;
mod changed;
mod colours;
mod emission;
pub(crate) mod folder;
mod found;
mod gltf;
mod ies;
mod mutated;
mod names;
mod obj;
mod packed;
mod ply;
mod pose;
mod refused;
mod sides;
mod stl;
mod up;

use folder::{Folder, red_png};

#[test]
fn unknown_endings_and_missing_files_are_named() {
    let folder = Folder::new().with("a.xyz", "");
    assert!(
        folder.load("a.xyz").unwrap_err().to_string().contains(".obj, .gltf, .glb, .stl, .ply")
    );
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
