//! Laws of the files of a lightmap.

use std::fs;
use std::path::Path;

use radiosity::Error;
use radiosity::export::{Stamp, check_writable_lightmap, lightmap_files, save_lightmap};
use radiosity::lightmap::{Atlas, bake};
use rayon::ThreadPoolBuilder;

use super::scenes::{BALL, Lit};

fn written(lit: &Lit, size: u32) -> Vec<Vec<u8>> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("ball.lightmap.glb");
    let atlas = Atlas::new(&lit.surfaces, size).unwrap();
    let map = bake(&lit.surfaces, &atlas, &lit.solution, &lit.mesh);
    save_lightmap(&map, &lit.mesh, &path, &Stamp::default()).unwrap();
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 3);
    lightmap_files(&path).iter().map(|file| fs::read(file).unwrap()).collect()
}

#[test]
fn one_and_two_threads_write_the_same_bytes() {
    let [one, two] = [1, 2].map(|threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| written(&BALL, 64))
    });
    assert!(one == two);
}

#[test]
fn the_linear_map_keeps_its_numbers_and_the_mesh_names_it() {
    let lit = &*BALL;
    let atlas = Atlas::new(&lit.surfaces, 64).unwrap();
    let map = bake(&lit.surfaces, &atlas, &lit.solution, &lit.mesh);
    let files = written(lit, 64);
    let exr = image::load_from_memory(&files[1]).unwrap().into_rgb32f();
    let texels: Vec<[f32; 3]> = exr.pixels().map(|pixel| pixel.0).collect();
    assert!(texels.iter().zip(&map.texels).all(|(a, b)| *a == b.to_array()));
    let png = image::load_from_memory(&files[2]).unwrap().into_rgb8();
    assert_eq!(png.dimensions(), (64, 64));

    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(&files[0]).unwrap();
    let mut triangles = 0;
    for primitive in document.meshes().flat_map(|mesh| mesh.primitives()) {
        let reader = primitive.reader(|_| blob.as_deref());
        let uvs = reader.read_tex_coords(1).unwrap().into_f32();
        assert_eq!(uvs.len(), reader.read_positions().unwrap().len());
        triangles += reader.read_indices().unwrap().into_u32().len() / 3;
    }
    assert_eq!(triangles, atlas.mesh.triangles.len());
    let lamp = document.materials().find(|material| material.emissive_factor()[0] > 0.0).unwrap();
    assert_eq!(lamp.emissive_strength(), Some(10.0));
    let extras = document.into_json().asset.extras.unwrap();
    let extras: serde_json::Value = serde_json::from_str(extras.get()).unwrap();
    assert_eq!(extras["lightmap"]["linear"], "ball.lightmap.exr");
    assert_eq!(extras["lightmap"]["texCoord"], 1);
}

#[test]
fn other_endings_are_refused_beforehand() {
    let refused = |name: &str| check_writable_lightmap(Path::new(name)).unwrap_err();
    for name in ["room.obj", "room", "glb"] {
        assert!(matches!(refused(name), Error::UnknownFormat { .. }), "{name}");
    }
}
