//! Laws of GLB files, and of reading them again.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use glam::Vec3;
use proptest::prelude::*;
use radiosity::Result;
use radiosity::colour::Rgb;
use radiosity::export::{Stamp, load_solved, save};
use radiosity::reconstruct::{Part, TriMesh};
use radiosity::tone::{Exposure, exposure_scale, tone_map};

use crate::meshes::{bytes_of, in_new_directory, meshes, small_mesh};

fn round_trip(mesh: &TriMesh, stamp: &Stamp) -> Result<(TriMesh, Stamp)> {
    in_new_directory(|directory| {
        let path = directory.join("solved.glb");
        save(mesh, &path, stamp)?;
        load_solved(&path)
    })
}

/// Everything a corner carries, as the bits of single-precision numbers.
type CornerBits = Vec<u32>;

/// The corners of each material's triangles, in order.
fn corners(mesh: &TriMesh) -> BTreeMap<(String, Option<String>), Vec<CornerBits>> {
    let mut corners = BTreeMap::new();
    for part in &mesh.parts {
        let texture = part.texture.map(|index| mesh.textures[index as usize].name.clone());
        let list: &mut Vec<_> = corners.entry((part.name.clone(), texture.clone())).or_default();
        for &vertex in mesh.triangles[part.triangles.clone()].as_flattened() {
            let v = vertex as usize;
            let mut numbers = mesh.positions[v].as_vec3().to_array().to_vec();
            numbers.extend(mesh.normals[v].to_array());
            numbers.extend(mesh.radiosity[v].as_vec3().to_array());
            if texture.is_some() {
                numbers.extend(mesh.uvs[v].to_array());
                numbers.extend(mesh.texture_mean[v].as_vec3().to_array());
            }
            list.push(numbers.into_iter().map(f32::to_bits).collect());
        }
    }
    corners
}

/// The JSON of a GLB and its binary chunk.
fn chunks(glb: &[u8]) -> (gltf_json::Root, Vec<u8>) {
    let glb = gltf::Glb::from_slice(glb).unwrap();
    (gltf_json::Root::from_slice(&glb.json).unwrap(), glb.bin.unwrap().into_owned())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn glb_returns_what_it_was_given_bit_for_bit(mesh in meshes()) {
        let (back, _) = round_trip(&mesh, &Stamp::default()).unwrap();
        prop_assert_eq!(corners(&back), corners(&mesh));
    }

    #[test]
    fn a_glb_read_and_written_again_is_the_same_file(mesh in meshes()) {
        let stamp = Stamp::default();
        let first = round_trip(&mesh, &stamp).unwrap().0;
        let second = round_trip(&first, &stamp).unwrap().0;
        prop_assert_eq!(bytes_of(&first, "a.glb", &stamp), bytes_of(&second, "a.glb", &stamp));
    }

    #[test]
    fn glb_views_are_aligned_and_positions_lie_within_their_bounds(mesh in meshes()) {
        let (root, binary) = chunks(&bytes_of(&mesh, "m.glb", &Stamp::default()));
        for view in &root.buffer_views {
            prop_assert_eq!(view.byte_offset.unwrap().0 % 4, 0);
        }
        for accessor in root.accessors.iter().filter(|accessor| accessor.min.is_some()) {
            let view = &root.buffer_views[accessor.buffer_view.unwrap().value()];
            let start = view.byte_offset.unwrap().0 as usize;
            let bytes = &binary[start..start + view.byte_length.0 as usize];
            let numbers = bytes.as_chunks::<4>().0.iter().map(|&bytes| f32::from_le_bytes(bytes));
            let points: Vec<Vec3> = numbers.collect::<Vec<_>>().as_chunks::<3>().0.iter().map(|&p| p.into()).collect();
            let low = points.iter().copied().reduce(Vec3::min).unwrap().to_array();
            let high = points.iter().copied().reduce(Vec3::max).unwrap().to_array();
            let bound = |value: &Option<serde_json::Value>| -> [f32; 3] {
                serde_json::from_value(value.clone().unwrap()).unwrap()
            };
            prop_assert_eq!(bound(&accessor.min), low);
            prop_assert_eq!(bound(&accessor.max), high);
        }
    }

    #[test]
    fn a_damaged_glb_is_read_or_refused_but_never_panics(place in 0.0..1.0_f64, byte in any::<u8>()) {
        let mut bytes = bytes_of(&small_mesh(), "m.glb", &Stamp::default());
        let place = (place * bytes.len() as f64) as usize;
        bytes[place] = byte;
        in_new_directory(|directory| {
            let path = directory.join("damaged.glb");
            fs::write(&path, &bytes).unwrap();
            if let Ok((mesh, _)) = load_solved(&path) {
                assert!(mesh.triangles.as_flattened().iter().all(|&v| (v as usize) < mesh.positions.len()));
                assert!(mesh.radiosity.iter().all(|radiosity| radiosity.is_finite()));
            }
            fs::write(&path, &bytes[..place]).unwrap();
            assert!(load_solved(&path).is_err());
        });
    }
}

#[test]
fn colour_0_times_the_picture_is_the_tone_mapped_light() {
    let mesh = small_mesh();
    let (root, binary) = chunks(&bytes_of(&mesh, "m.glb", &Stamp::default()));
    let scale = exposure_scale(&mesh, Exposure::Automatic);
    let colours = root.accessors.iter().find(|accessor| accessor.normalized).unwrap();
    let view = &root.buffer_views[colours.buffer_view.unwrap().value()];
    let start = view.byte_offset.unwrap().0 as usize;
    let fractions: Vec<f64> = binary[start..start + 8]
        .as_chunks::<2>()
        .0
        .iter()
        .map(|&bytes| f64::from(u16::from_le_bytes(bytes)) / 65535.0)
        .collect();
    let light = tone_map(Rgb::new(0.1 / 0.5, 0.7 / 0.25, 0.0) * scale).to_array();
    for (fraction, expected) in fractions.iter().zip([light[0], light[1], light[2], 1.0]) {
        assert!((fraction - expected).abs() < 1e-4, "{fractions:?} {light:?}");
    }
}

#[test]
fn glb_keeps_pictures_and_how_they_repeat() {
    let mesh = small_mesh();
    let (back, _) = round_trip(&mesh, &Stamp::default()).unwrap();
    let [texture] = &back.textures[..] else { panic!("{} textures", back.textures.len()) };
    assert_eq!((texture.width, texture.height, texture.repeat), (2, 1, [true, false]));
    for (texel, expected) in texture.texels.iter().zip(mesh.textures[0].texels.iter()) {
        assert!((Vec3::from(texel) - Vec3::from(expected)).length() < 0.005);
    }
}

#[test]
fn glb_keeps_its_stamp() {
    let stamp = Stamp {
        exposure: Exposure::Ev(3.25),
        settings: serde_json::json!({ "tolerance": 0.03, "uniform": null }),
        finished: false,
    };
    assert_eq!(round_trip(&small_mesh(), &stamp).unwrap().1, stamp);
    let default = Stamp::default();
    assert_eq!(round_trip(&small_mesh(), &default).unwrap().1, default);
}

#[test]
fn vertices_that_no_triangle_uses_are_not_written() {
    let (back, _) = round_trip(&small_mesh(), &Stamp::default()).unwrap();
    assert_eq!(back.positions.len(), 4 + 3);
    assert!(back.positions.iter().all(|position| position.x < 9.0));
}

#[test]
fn parts_of_one_material_become_one_part() {
    let mut mesh = small_mesh();
    mesh.parts = vec![
        Part { name: "a".to_owned(), triangles: 0..1, texture: None },
        Part { name: "b".to_owned(), triangles: 1..2, texture: None },
        Part { name: "a".to_owned(), triangles: 2..3, texture: None },
    ];
    let (back, _) = round_trip(&mesh, &Stamp::default()).unwrap();
    let parts: Vec<_> =
        back.parts.iter().map(|part| (&part.name[..], part.triangles.len())).collect();
    assert_eq!(parts, [("a", 2), ("b", 1)]);
}

#[test]
fn a_glb_without_radiosity_is_refused_with_advice() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-box.glb");
    let message = load_solved(&scene).unwrap_err().to_string();
    let place = message.contains("cornell-box.glb");
    assert!(place && message.contains("_RADIOSITY"), "{message}");
}
