//! Laws of exported files: what is written can be read again, and holds what formats ask for.

mod glb;
mod meshes;
mod text;

use std::fs;

use radiosity::Error;
use radiosity::export::{Stamp, check_writable, save};
use radiosity::reconstruct::TriMesh;

use meshes::{bytes_of, in_new_directory, small_mesh};

#[test]
fn same_mesh_gives_the_same_bytes() {
    for name in ["m.glb", "m.obj", "m.ply"] {
        let write = || bytes_of(&small_mesh(), name, &Stamp::default());
        assert_eq!(write(), write(), "{name}");
    }
}

#[test]
fn endings_are_known_in_any_case_and_others_are_refused() {
    in_new_directory(|directory| {
        let stamp = Stamp::default();
        save(&small_mesh(), &directory.join("new/M.GLB"), &stamp).unwrap();
        assert!(directory.join("new/M.GLB").is_file());
        for name in ["m.stl", "m", "glb"] {
            let path = directory.join(name);
            let error = save(&small_mesh(), &path, &stamp).unwrap_err();
            assert!(matches!(error, Error::UnknownFormat { .. }), "{error}");
            assert!(matches!(check_writable(&path), Err(Error::UnknownFormat { .. })));
        }
    });
}

#[test]
fn a_place_that_cannot_be_written_is_told_beforehand() {
    in_new_directory(|directory| {
        let file = directory.join("m.glb");
        check_writable(&file).unwrap();
        assert_eq!(fs::read_dir(directory).unwrap().count(), 0);
        fs::write(&file, "old").unwrap();
        check_writable(&file).unwrap();
        assert!(check_writable(&file.join("below-a-file.glb")).is_err());
        fs::create_dir(directory.join("directory.ply")).unwrap();
        assert!(check_writable(&directory.join("directory.ply")).is_err());
    });
}

#[test]
fn a_failed_write_keeps_the_old_file_and_leaves_nothing_behind() {
    let mut mesh = small_mesh();
    mesh.textures[0].texels = Default::default();
    in_new_directory(|directory| {
        let path = directory.join("m.glb");
        fs::write(&path, "old").unwrap();
        save(&mesh, &path, &Stamp::default()).unwrap_err();
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(directory).unwrap().count(), 1);
    });
}

#[test]
fn a_mesh_without_triangles_is_an_error() {
    in_new_directory(|directory| {
        let path = directory.join("m.glb");
        assert!(save(&TriMesh::default(), &path, &Stamp::default()).is_err());
        assert!(!path.exists());
    });
}
