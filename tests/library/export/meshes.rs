//! Meshes to export, and directories to export them into.

use std::fs;
use std::path::Path;

use glam::{DVec3, Vec2, Vec3};
use proptest::prelude::*;
use radiosity::colour::Rgb;
use radiosity::export::{Stamp, save};
use radiosity::reconstruct::{MeshPart, TriMesh};
use radiosity::scene::{Sampler, Texture, Wrap};

/// Two triangles on a picture and one beside it; vertex 4 belongs to no triangle.
pub(crate) fn small_mesh() -> TriMesh {
    let corner = |x: f64, z: f64| DVec3::new(x, 0.1, z);
    TriMesh {
        positions: vec![
            corner(0.0, 0.0),
            corner(0.0, 1.0),
            corner(1.0, 1.0),
            corner(1.0, 0.0),
            corner(9.0, 9.0),
            corner(2.0, 1.0),
        ],
        normals: vec![Vec3::Y; 6],
        uvs: [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0), (0.0, 0.0)]
            .map(Vec2::from)
            .to_vec(),
        radiosity: (1..=6).map(|i| Rgb::new(0.1, 0.7, 3.0) * f64::from(i)).collect(),
        texture_mean: vec![Rgb::new(0.5, 0.25, 0.0); 6],
        triangles: vec![[0, 1, 2], [0, 2, 3], [3, 2, 5]],
        parts: vec![
            MeshPart {
                name: "carpet".to_owned(),
                triangles: 0..2,
                texture: Some(0),
                cutoff: Some(0.25),
                object: None,
            },
            MeshPart {
                name: "bare floor".to_owned(),
                triangles: 2..3,
                texture: None,
                cutoff: None,
                object: None,
            },
        ],
        textures: vec![Texture {
            name: "stripes".to_owned(),
            width: 2,
            height: 1,
            texels: vec![[1.0, 0.5, 0.0], [0.0, 0.0, 0.0]].into(),
            alpha: vec![255, 40],
            sampler: Sampler { wrap: [Wrap::Mirror, Wrap::Clamp], nearest: true },
            ..Texture::default()
        }],
        ..TriMesh::default()
    }
}

pub(crate) fn in_new_directory<T>(act: impl FnOnce(&Path) -> T) -> T {
    let directory = tempfile::tempdir().unwrap();
    act(directory.path())
}

pub(crate) fn bytes_of(mesh: &TriMesh, name: &str, stamp: &Stamp) -> Vec<u8> {
    in_new_directory(|directory| {
        let path = directory.join(name);
        save(mesh, &path, stamp).unwrap();
        fs::read(path).unwrap()
    })
}

pub(crate) fn meshes() -> impl Strategy<Value = TriMesh> {
    let vertex = (
        prop::array::uniform3(-20.0..20.0_f64),
        prop::array::uniform3(0.0..5e3_f64),
        prop::array::uniform3(0.01..1.0_f64),
        prop::array::uniform2(-3.0..3.0_f32),
    );
    let part = (prop::sample::select(vec!["a", "b", ""]), any::<bool>(), 1..5_usize);
    (prop::collection::vec(vertex, 3..20), prop::collection::vec(part, 1..5)).prop_flat_map(
        |(vertices, parts)| {
            let triangles = parts.iter().map(|part| part.2).sum::<usize>();
            let corner = 0..vertices.len() as u32;
            prop::collection::vec(prop::array::uniform3(corner), triangles)
                .prop_map(move |triangles| assemble(&vertices, &parts, triangles))
        },
    )
}

type VertexParts = ([f64; 3], [f64; 3], [f64; 3], [f32; 2]);

fn assemble(
    vertices: &[VertexParts],
    parts: &[(&str, bool, usize)],
    triangles: Vec<[u32; 3]>,
) -> TriMesh {
    let mut mesh = TriMesh { triangles, textures: small_mesh().textures, ..TriMesh::default() };
    for &(position, radiosity, mean, uv) in vertices {
        mesh.positions.push(DVec3::from(position));
        mesh.normals.push(DVec3::from(position).normalize_or(DVec3::Y).as_vec3());
        mesh.radiosity.push(Rgb::from(radiosity));
        mesh.texture_mean.push(Rgb::from(mean));
        mesh.uvs.push(Vec2::from(uv));
    }
    let mut start = 0;
    for &(name, textured, count) in parts {
        let triangles = start..start + count;
        start += count;
        mesh.parts.push(MeshPart {
            name: name.to_owned(),
            triangles,
            texture: textured.then_some(0),
            cutoff: None,
            object: None,
        });
    }
    mesh
}
