//! Laws of OBJ and PLY files.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use glam::DVec3;
use proptest::prelude::*;
use radiosity::colour::{Rgb, linear_from_srgb};
use radiosity::export::{Stamp, save};
use radiosity::tone::{Exposure, exposure_scale, tone_map};

use super::meshes::{bytes_of, in_new_directory, meshes, small_mesh};

fn used(triangles: &[[u32; 3]]) -> usize {
    triangles.as_flattened().iter().collect::<BTreeSet<_>>().len()
}

/// Vertex numbers in order of first use.
fn renumbered(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut numbers = BTreeMap::new();
    let mut number = |vertex: u32| {
        let next = numbers.len() as u32;
        *numbers.entry(vertex).or_insert(next)
    };
    triangles.iter().map(|corners| corners.map(&mut number)).collect()
}

struct Ply {
    header: String,
    /// Position and normal, colour, radiosity.
    vertices: Vec<([f32; 6], [u8; 3], [f32; 3])>,
    faces: Vec<[u32; 3]>,
}

fn read_ply(bytes: &[u8]) -> Ply {
    const END: &[u8] = b"end_header\n";
    const VERTEX: usize = 6 * 4 + 3 + 3 * 4;
    const FACE: usize = 1 + 3 * 4;
    let body = bytes.windows(END.len()).position(|window| window == END).unwrap() + END.len();
    let header = String::from_utf8(bytes[..body].to_vec()).unwrap();
    let count = |element: &str| -> usize {
        let line = header.lines().find_map(|line| line.strip_prefix(element)).unwrap();
        line.trim().parse().unwrap()
    };
    let (vertices, faces) = bytes[body..].split_at(count("element vertex") * VERTEX);
    assert_eq!(faces.len(), count("element face") * FACE);
    let single = |bytes: &[u8], i: usize| f32::from_le_bytes(bytes[i..i + 4].try_into().unwrap());
    let corner = |face: &[u8], i: usize| u32::from_le_bytes(face[i..i + 4].try_into().unwrap());
    Ply {
        vertices: vertices
            .chunks(VERTEX)
            .map(|v| {
                let place = std::array::from_fn(|i| single(v, 4 * i));
                let radiosity = std::array::from_fn(|i| single(v, 27 + 4 * i));
                (place, [v[24], v[25], v[26]], radiosity)
            })
            .collect(),
        faces: faces.chunks(FACE).map(|f| std::array::from_fn(|i| corner(f, 1 + 4 * i))).collect(),
        header,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn ply_and_obj_hold_as_many_vertices_and_faces_as_are_used(mesh in meshes()) {
        let ply = read_ply(&bytes_of(&mesh, "m.ply", &Stamp::default()));
        prop_assert_eq!(&ply.faces, &renumbered(&mesh.triangles));
        prop_assert_eq!(ply.vertices.len(), used(&mesh.triangles));

        let (models, triangles) = in_new_directory(|directory| {
            let path = directory.join("m.obj");
            save(&mesh, &path, &Stamp::default()).unwrap();
            let (models, materials) = tobj::load_obj(&path, &tobj::GPU_LOAD_OPTIONS).unwrap();
            materials.unwrap();
            let corners: usize = models.iter().map(|model| model.mesh.indices.len()).sum();
            (models, corners / 3)
        });
        prop_assert_eq!(triangles, mesh.triangles.len());
        prop_assert!(models.iter().all(|model| model.mesh.material_id.is_some()));
    }
}

#[test]
fn ply_keeps_radiosity_exactly_and_shows_it_tone_mapped() {
    let mesh = small_mesh();
    let stamp = Stamp { finished: false, ..Stamp::default() };
    let ply = read_ply(&bytes_of(&mesh, "m.ply", &stamp));
    let scale = exposure_scale(&mesh, Exposure::Automatic);
    let (place, colour, radiosity) = ply.vertices[1];
    assert_eq!(place, [0.0, 0.1, 1.0, 0.0, 1.0, 0.0]);
    assert_eq!(radiosity, mesh.radiosity[1].as_vec3().to_array());
    let shown = tone_map(mesh.radiosity[1] * scale).to_array();
    for (byte, linear) in colour.into_iter().zip(shown) {
        let decoded = linear_from_srgb(f64::from(byte) / 255.0);
        assert!((decoded - linear).abs() < 0.005, "{decoded} {linear}");
    }
    assert!(ply.header.contains("W/m^2") && ply.header.contains("Unfinished"), "{}", ply.header);
}

#[test]
fn obj_colours_are_the_light_that_falls_on_a_picture() {
    let mesh = small_mesh();
    let obj = String::from_utf8(bytes_of(&mesh, "m.obj", &Stamp::default())).unwrap();
    let first = obj.lines().find_map(|line| line.strip_prefix("v ")).unwrap();
    let numbers: Vec<f64> = first.split(' ').map(|number| number.parse().unwrap()).collect();
    assert_eq!(numbers[..3], [0.0, 0.1, 0.0]);
    let scale = exposure_scale(&mesh, Exposure::Automatic);
    let light = tone_map(Rgb::new(0.1 / 0.5, 0.7 / 0.25, 0.1 / 0.5) * scale).to_array();
    for (&coded, linear) in numbers[3..].iter().zip(light) {
        assert!((linear_from_srgb(coded) - linear).abs() < 2e-4, "{numbers:?} {light:?}");
    }
}

#[test]
fn obj_brings_its_materials_and_pictures() {
    in_new_directory(|directory| {
        save(&small_mesh(), &directory.join("m.obj"), &Stamp::default()).unwrap();
        let mtl = fs::read_to_string(directory.join("m.mtl")).unwrap();
        assert!(mtl.contains("newmtl carpet") && mtl.contains("newmtl bare_floor"), "{mtl}");
        assert!(mtl.contains("map_Kd m-0.png"), "{mtl}");
        image::open(directory.join("m-0.png")).unwrap();
        assert_eq!(fs::read_dir(directory).unwrap().count(), 3);
    });
}

#[test]
fn far_from_the_origin_coordinates_keep_all_their_digits_and_objects_keep_their_names() {
    let mut mesh = small_mesh();
    let at = DVec3::new(448_262.25, 35.5, -5_411_932.125);
    mesh.positions.iter_mut().for_each(|position| *position += at);
    mesh.objects = vec!["rug".to_owned()];
    mesh.parts[0].object = Some(0);
    let obj = String::from_utf8(bytes_of(&mesh, "m.obj", &Stamp::default())).unwrap();
    assert!(obj.contains("\nv 448263.25 35.6 -5411931.125 "), "{obj}");
    assert_eq!(obj.lines().filter(|line| line.starts_with("o ")).collect::<Vec<_>>(), ["o rug"]);
    let ply = bytes_of(&mesh, "m.ply", &Stamp::default());
    let body = ply.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    assert!(String::from_utf8_lossy(&ply[..body]).contains("property double x"));
    let number = |i: usize| f64::from_le_bytes(ply[body + 8 * i..][..8].try_into().unwrap());
    assert_eq!([0, 1, 2].map(number), mesh.positions[0].to_array());
}
