//! Laws of GLB files, and of reading them again.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use radiosity::Result;
use radiosity::colour::{Rgb, linear_from_srgb, srgb_from_linear};
use radiosity::export::{Stamp, load_solved, save};
use radiosity::reconstruct::{MeshPart, TriMesh};
use radiosity::scene::{Camera, Node};
use radiosity::tone::{Exposure, exposure_scale, tone_map, tone_map_picture};

use super::meshes::{bytes_of, in_new_directory, meshes, small_mesh};

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
    // What the picture has no blue of is lit as its red.
    let light = tone_map(Rgb::new(0.1 / 0.5, 0.7 / 0.25, 0.1 / 0.5) * scale).to_array();
    for (fraction, expected) in fractions.iter().zip([light[0], light[1], light[2], 1.0]) {
        assert!((fraction - expected).abs() < 1e-4, "{fractions:?} {light:?}");
    }
}

#[test]
fn glb_keeps_pictures_and_how_they_repeat() {
    let mesh = small_mesh();
    let (back, _) = round_trip(&mesh, &Stamp::default()).unwrap();
    let [texture] = &back.textures[..] else { panic!("{} textures", back.textures.len()) };
    assert_eq!((texture.width, texture.height), (2, 1));
    assert_eq!((texture.sampler, &texture.alpha), (mesh.textures[0].sampler, &vec![255, 40]));
    assert_eq!(back.parts.iter().map(|part| part.cutoff).collect::<Vec<_>>(), [Some(0.25), None]);
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
        MeshPart {
            name: "a".to_owned(),
            triangles: 0..1,
            texture: None,
            cutoff: None,
            object: None,
        },
        MeshPart {
            name: "b".to_owned(),
            triangles: 1..2,
            texture: None,
            cutoff: None,
            object: None,
        },
        MeshPart {
            name: "a".to_owned(),
            triangles: 2..3,
            texture: None,
            cutoff: None,
            object: None,
        },
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

/// What a viewer shows at a corner of the textured part, and what our picture has there, both linear.
fn shown_at_a_corner(texels: Vec<[f32; 3]>, radiosity: Rgb) -> [Rgb; 2] {
    let mut mesh = small_mesh();
    let mean = texels.iter().map(|&texel| Vec3::from(texel).as_dvec3()).sum::<Rgb>() / 2.0;
    mesh.textures[0].texels = texels.into();
    mesh.texture_mean.fill(mean);
    mesh.radiosity.fill(radiosity * mean);
    let stamp = Stamp { exposure: Exposure::Ev(9.0), ..Stamp::default() };
    let (root, binary) = chunks(&bytes_of(&mesh, "m.glb", &stamp));
    let bytes = |view: gltf_json::Index<gltf_json::buffer::View>| {
        let view = &root.buffer_views[view.value()];
        let start = view.byte_offset.unwrap().0 as usize;
        &binary[start..start + view.byte_length.0 as usize]
    };
    let colours = root.accessors.iter().find(|accessor| accessor.normalized).unwrap();
    let codes = bytes(colours.buffer_view.unwrap()).as_chunks::<2>().0;
    let factor = |k: usize| f64::from(u16::from_le_bytes(codes[k])) / 65535.0;
    let picture = image::load_from_memory(bytes(root.images[0].buffer_view.unwrap())).unwrap();
    let texel =
        picture.to_rgb8().get_pixel(0, 0).0.map(|code| linear_from_srgb(f64::from(code) / 255.0));
    let scale = exposure_scale(&mesh, stamp.exposure);
    let white = mesh.textures[0].white();
    let light = mesh.light(0) * scale;
    let ours = Vec3::from(mesh.textures[0].texels.get(0).unwrap()).as_dvec3() * light;
    [
        Rgb::new(factor(0), factor(1), factor(2)) * Rgb::from(texel),
        tone_map_picture(ours, light * white),
    ]
}

#[test]
fn dark_and_saturated_pictures_are_shown_as_our_own_picture_has_them() {
    let bright = Rgb::splat(300.0);
    for texels in [
        vec![[0.02, 0.01, 0.005], [0.01, 0.01, 0.01]],
        vec![[1.0, 0.0097, 0.0], [1.0, 0.0091, 0.0]],
        vec![[0.9, 0.8, 0.7], [0.1, 0.05, 0.0]],
    ] {
        for radiosity in [bright * 0.01, bright, bright * 30.0, Rgb::new(300.0, 200.0, 0.0)] {
            let [theirs, ours] = shown_at_a_corner(texels.clone(), radiosity);
            let code = |linear: Rgb| Rgb::from(linear.to_array().map(srgb_from_linear)) * 255.0;
            let apart = (code(theirs) - code(ours)).abs().max_element();
            assert!(apart < 1.5, "{texels:?} {radiosity}: {apart}");
        }
    }
}

#[test]
fn a_dark_picture_is_brightened_in_the_file_and_dark_again_when_read() {
    let mut mesh = small_mesh();
    mesh.textures[0].texels = vec![[0.02, 0.01, 0.0], [0.005, 0.01, 0.015]].into();
    let (back, stamp) = round_trip(&mesh, &Stamp::default()).unwrap();
    for (texel, expected) in back.textures[0].texels.iter().zip(mesh.textures[0].texels.iter()) {
        let apart = (Vec3::from(texel) - Vec3::from(expected)).abs().max_element();
        assert!(apart < 0.02 * 0.01, "{texel:?}");
    }
    let (again, _) = round_trip(&back, &stamp).unwrap();
    assert!(bytes_of(&back, "a.glb", &stamp) == bytes_of(&again, "a.glb", &stamp));
}

/// The small mesh as two objects, one in a room, and a camera; `at` is where it stands.
fn furnished(at: DVec3) -> TriMesh {
    let mut mesh = small_mesh();
    mesh.positions.iter_mut().for_each(|position| *position += at);
    mesh.objects = vec!["table".to_owned(), "rug".to_owned()];
    let node = |name: &str, parent, object, camera| {
        let name = name.to_owned();
        Node { name, parent, object, camera }
    };
    mesh.nodes = vec![
        node("house", None, None, None),
        node("room", Some(0), Some(1), None),
        node("view", Some(0), None, Some(0)),
    ];
    mesh.cameras = vec![Camera {
        name: "view".to_owned(),
        eye: at + DVec3::new(0.0, 3.0, 4.0),
        target: at,
        up: DVec3::Y,
        vertical_fov: 0.8,
    }];
    mesh.parts[0].object = Some(1);
    mesh.parts[1].object = Some(0);
    mesh
}

#[test]
fn objects_hierarchy_and_cameras_come_back() {
    let mesh = furnished(DVec3::ZERO);
    let (root, _) = chunks(&bytes_of(&mesh, "m.glb", &Stamp::default()));
    let names: Vec<_> = root.nodes.iter().map(|node| node.name.as_deref().unwrap()).collect();
    assert_eq!(names, ["house", "room", "view", "table"]);
    assert!(
        root.nodes
            .iter()
            .filter(|node| node.camera.is_none())
            .all(|node| node.translation.is_none())
    );
    assert_eq!((root.meshes.len(), root.materials.len(), root.scenes[0].nodes.len()), (2, 2, 2));
    let (back, stamp) = round_trip(&mesh, &Stamp::default()).unwrap();
    let object = |part: &MeshPart| back.objects[part.object.unwrap() as usize].clone();
    let found: Vec<_> = back.parts.iter().map(|part| (part.name.as_str(), object(part))).collect();
    assert_eq!(found, [("bare floor", "table".to_owned()), ("carpet", "rug".to_owned())]);
    let [camera] = &back.cameras[..] else { panic!("{:?}", back.cameras) };
    let [seen, meant] =
        [camera, &mesh.cameras[0]].map(|camera| (camera.target - camera.eye).normalize());
    assert!(camera.eye.distance(mesh.cameras[0].eye) < 1e-6 && seen.distance(meant) < 1e-6);
    let (again, _) = round_trip(&back, &stamp).unwrap();
    assert!(bytes_of(&back, "a.glb", &stamp) == bytes_of(&again, "a.glb", &stamp));
}

#[test]
fn a_mesh_far_from_the_origin_keeps_its_shape() {
    let at = DVec3::new(448_262.25, 35.5, -5_411_932.125);
    let mesh = furnished(at);
    let (root, _) = chunks(&bytes_of(&mesh, "m.glb", &Stamp::default()));
    let largest = root.accessors.iter().filter_map(|accessor| accessor.max.clone());
    let largest = largest.flat_map(|max| serde_json::from_value::<[f64; 3]>(max).unwrap());
    assert!(largest.map(f64::abs).fold(0.0, f64::max) < 10.0);
    let (back, _) = round_trip(&mesh, &Stamp::default()).unwrap();
    let near = |a: &DVec3| mesh.positions.iter().any(|b| a.distance(*b) < 1e-5);
    assert!(back.positions.iter().all(near), "{:?}", back.positions);
    assert!(back.cameras[0].eye.distance(mesh.cameras[0].eye) < 1e-5, "{:?}", back.cameras);
    assert_eq!(
        back.nodes,
        mesh.nodes[..]
            .iter()
            .cloned()
            .chain([Node { name: "table".to_owned(), object: Some(0), ..Node::default() }])
            .collect::<Vec<_>>()
    );
}

#[test]
fn a_mesh_that_another_program_has_turned_is_refused() {
    let bytes = bytes_of(&furnished(DVec3::splat(1e5)), "m.glb", &Stamp::default());
    let moves = b"\"translation\":";
    let place = bytes.windows(moves.len()).rposition(|window| window == moves).unwrap();
    let mut changed = bytes.clone();
    changed[place..][..moves.len()].copy_from_slice(b"\"scale\":      ");
    in_new_directory(|directory| {
        let path = directory.join("turned.glb");
        fs::write(&path, &changed).unwrap();
        let told = load_solved(&path).unwrap_err().to_string();
        assert!(told.contains("rearranged"), "{told}");
    });
}
