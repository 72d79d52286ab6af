//! What is bent: the scenes of the project, and small files with something of everything.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use radiosity::scene::Scene;
use serde_json::json;

use super::run::Files;
use crate::load::asset::{Asset, FLOAT, floats};

/// Larger scenes are left out: small ones have the same errors, sooner.
const LARGEST: u64 = 6_000;

/// Something of everything that OBJ files hold.
const ODD: &str = "mtllib m.mtl\no box\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nv 0.5 0.5 2 1 0 0\n\
    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0.1 1\ns 1\nusemtl a\nf 1/1/1 2/2/1 3/3/1 4/4/1\n\
    usemtl lamp\nf -1 -2 -3\ns off\ng other\nl 1 2\nf 1 2 5\nf 5 4 3 2 1\n";

/// A floor with an L, a hole by a bridge, a face in its plane, one hovering, one through it, a closed box.
const ROOM: &str = "mtllib m.mtl\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\nv -1 0 1\nv 1 0 1\nv 1 0 -1\n\
    v -1 0 -1\nv 0 -1 0\nv 1 1 0\nv 0 1 1\nv -1 0.001 0\nv 0 0.001 1\nv 0 0.001 0\nv -1 2 -1\nv 1 2 -1\n\
    v 1 2 1\nv -1 2 1\nv 0 0 1\nusemtl a\nf 1 2 3 4 1 5 8 7 6 5\nf 5 6 7 8\nf 5 19 7 8\nf 9 10 11\nf 12 13 14\nf 14 13 12\n\
    usemtl lamp\nf 15 16 17 18\nusemtl none\nf 1 2 16 15\n";

pub(crate) const MTL: &str = "newmtl a\nKd 0.5 0.25 1\nmap_Kd -s 2 2 1 -o 0.5 -clamp on red.png\n\
    newmtl lamp\nKd 0.7\nKe 10 9 8\nillum 1\nmap_Ke -mm 0 1 red.png\nnewmtl floor\nKd 0.1 0.2\nKa 1 1 1\n";

fn scenes(ending: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let entries = fs::read_dir(folder).expect("the project's scenes");
    let mut found: Vec<PathBuf> = entries
        .map(|entry| entry.expect("a readable folder").path())
        .filter(|path| path.extension().is_some_and(|found| found == ending))
        .filter(|path| path.metadata().is_ok_and(|data| data.len() <= LARGEST))
        .collect();
    found.sort();
    found
}

fn read(path: &Path) -> Vec<u8> {
    fs::read(path).expect("a scene of the project")
}

/// OBJ files, each with its MTL files.
pub(crate) static OBJ: LazyLock<Vec<Files>> = LazyLock::new(|| {
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let own =
        |text: &str| vec![("s.obj".to_owned(), text.into()), ("m.mtl".to_owned(), MTL.into())];
    let shipped = scenes("obj").into_iter().map(|path| {
        let library = path.with_extension("mtl");
        vec![("s.obj".to_owned(), read(&path)), (name(&library), read(&library))]
    });
    [own(ODD), own(ROOM)].into_iter().chain(shipped).collect()
});

/// glTF with something of everything, and scenes of the project turned into it.
pub(crate) static ASSETS: LazyLock<Vec<Asset>> = LazyLock::new(|| {
    let scene = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
        asset_of(&radiosity::load(&path, &Default::default()).expect("a scene of the project"))
    };
    vec![everything(), everything(), scene("cornell-box.obj"), scene("blocker.obj")]
});

/// Compressed glTF.
pub(crate) static PACKED: LazyLock<Vec<Asset>> = LazyLock::new(|| {
    let asset = |name: &str| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/library/load/packed");
        let bytes = read(&folder.join(name));
        let number = |at: usize| u32::from_le_bytes([0, 1, 2, 3].map(|k| bytes[at + k])) as usize;
        let end = 20 + number(12);
        let json = serde_json::from_slice(&bytes[20..end]).expect("a GLB begins with JSON");
        Asset { json, bytes: bytes[end + 8..].to_vec() }
    };
    [
        "draco.glb",
        "draco-valence.glb",
        "draco-sequential.glb",
        "meshopt.glb",
        "meshopt-filtered.glb",
    ]
    .map(asset)
    .into()
});

fn everything() -> Asset {
    let mut asset = Asset::triangle();
    let uvs = asset.add(&floats(&[0., 0., 1., 0., 0., 1.]), FLOAT, "VEC2", 3);
    let normals = asset.add(&floats(&[0.1, 0., 1., 0., 0., 1., 0., 0., 1.]), FLOAT, "VEC3", 3);
    let colours = asset.add(&[200; 12], 5121, "VEC4", 3);
    let indices = asset.add(&[0, 1, 2], 5121, "SCALAR", 3);
    let joints = asset.add(&[0, 1, 0, 0].repeat(3), 5121, "VEC4", 3);
    let weights = asset.add(&floats(&[0.5, 0.5, 0., 0.].repeat(3)), FLOAT, "VEC4", 3);
    let moves = asset.add(&floats(&[0., 0.1, 0.].repeat(3)), FLOAT, "VEC3", 3);
    let inverses =
        asset.add(&floats(&glam::Mat4::IDENTITY.to_cols_array().repeat(2)), FLOAT, "MAT4", 2);
    asset.json["accessors"][colours]["normalized"] = true.into();
    asset.json["accessors"][0]["sparse"] = json!({"count": 1,
        "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": 0}});
    let primitive = &mut asset.json["meshes"][0]["primitives"][0];
    primitive["attributes"] = json!({"POSITION": 0, "NORMAL": normals, "TEXCOORD_0": uvs, "COLOR_0": colours,
            "JOINTS_0": joints, "WEIGHTS_0": weights});
    primitive["targets"] = json!([{"POSITION": moves}]);
    primitive["indices"] = indices.into();
    asset.json["images"] = json!([{"uri": "red.png"}]);
    asset.json["samplers"] = json!([{"wrapS": 33071}]);
    asset.json["textures"] = json!([{"source": 0, "sampler": 0}]);
    asset.json["materials"] = json!([{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.5, 1], "baseColorTexture": {"index": 0,
            "extensions": {"KHR_texture_transform": {"scale": [2, 2], "rotation": 1.5}}}},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}}}]);
    asset.json["cameras"] =
        json!([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}]);
    asset.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "spot", "intensity": 100, "range": 5, "spot": {"outerConeAngle": 0.5}}]}});
    asset.json["skins"] = json!([{"joints": [0, 1], "inverseBindMatrices": inverses}]);
    asset.json["meshes"][0]["weights"] = json!([0.5]);
    asset.json["nodes"] = json!([{"mesh": 0, "skin": 0, "camera": 0, "scale": [1, 2, -3], "children": [1]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}}]);
    asset
}

/// One primitive a material, fans of the faces.
fn asset_of(scene: &Scene) -> Asset {
    let mut asset = Asset::triangle();
    let places: Vec<f32> = scene.positions.iter().flat_map(|p| p.as_vec3().to_array()).collect();
    let places = asset.add(&floats(&places), FLOAT, "VEC3", scene.positions.len() as u64);
    let (mut primitives, mut materials) = (Vec::new(), Vec::new());
    for (number, material) in scene.materials.iter().enumerate() {
        let faces = scene.faces.iter().filter(|face| face.material.index() == number);
        let fans = faces.flat_map(|face| {
            let hub = face.vertices[0];
            face.vertices[1..]
                .windows(2)
                .flat_map(move |pair| [hub, pair[0], pair[1]])
                .collect::<Vec<_>>()
        });
        let indices: Vec<u16> = fans.map(|index| index as u16).collect();
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = asset.add(&bytes, 5123, "SCALAR", indices.len() as u64);
        primitives.push(
            json!({"attributes": {"POSITION": places}, "indices": indices, "material": number}),
        );
        materials.push(json!({"name": material.name, "emissiveFactor": material.emission.clamp(glam::DVec3::ZERO, glam::DVec3::ONE).to_array(),
            "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": material.reflectance.extend(1.0).to_array()}}));
    }
    asset.json["meshes"] = json!([{"primitives": primitives}]);
    asset.json["materials"] = json!(materials);
    asset
}

/// A corner of a room and a lamp, as text and as bytes.
pub(crate) static STL: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| {
    let corners = |lamp: bool| match lamp {
        false => [[0.0f32, 0., 0.], [4., 0., 0.], [0., 0., 4.]],
        true => [[1., 2., 1.], [2., 2., 1.], [1., 2., 2.]],
    };
    let facet = |lamp: bool| {
        let vertex = corners(lamp).map(|[x, y, z]| format!("vertex {x} {y} {z}\n")).concat();
        format!(
            "solid {lamp}\nfacet normal 0 1 0\nouter loop\n{vertex}endloop\nendfacet\nendsolid\n"
        )
    };
    let mut binary = b"solid \xff by a program".to_vec();
    binary.resize(80, 0);
    binary.extend(2u32.to_le_bytes());
    for lamp in [false, true] {
        let numbers = [0.0; 3].into_iter().chain(corners(lamp).into_iter().flatten());
        binary.extend(numbers.flat_map(f32::to_le_bytes).chain([0, 0]));
    }
    vec![format!("{}{}", facet(false), facet(true)).into_bytes(), binary]
});

/// A folded sheet with colours and normals, a table more and a list more, in each encoding.
pub(crate) static PLY: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| {
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment TextureFile a.png\nelement vertex 5\nproperty float x\nproperty float y\n\
             property float z\nproperty float ny\nproperty float nx\nproperty float nz\nproperty uchar red\n\
             property uchar green\nproperty uchar blue\nelement edge 1\nproperty int a\nelement face 2\n\
             property list uchar uchar vertex_indices\nproperty list uchar float weights\nend_header\n"
        )
    };
    let places = [[0.0f32, 0., 0.], [0., 0., 2.], [2., 0., 2.], [2., 0., 0.], [2., 1., 0.]];
    let faces: [&[u8]; 2] = [&[0, 1, 2, 3], &[2, 4, 3]];
    let mut text = header("ascii");
    for [x, y, z] in places {
        text += &format!("{x} {y} {z} 1 0 0.1 10 200 {}\n", x * 100.0);
    }
    text += "7\n4 0 1 2 3 1 0.5\n3 2 4 3 0\n";
    let binary = |format: &str, of: fn(f32) -> [u8; 4]| {
        let mut bytes = header(format).into_bytes();
        for place in places {
            bytes
                .extend(place.into_iter().chain([1.0, 0.0, 0.1]).flat_map(of).chain([10, 200, 90]));
        }
        bytes.extend([0; 4]);
        for face in faces {
            bytes.push(face.len() as u8);
            bytes.extend(face);
            bytes.push(1);
            bytes.extend(of(0.5));
        }
        bytes
    };
    vec![
        text.into_bytes(),
        binary("binary_little_endian", f32::to_le_bytes),
        binary("binary_big_endian", f32::to_be_bytes),
    ]
});

/// Luminaires of each kind of symmetry and version.
pub(crate) const IES: [&str; 4] = [
    "IESNA:LM-63-2002\n[TEST] none\n[MANUFAC] nobody\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 60\n0 45 90\n0\n800 400 0\n",
    "IESNA:LM-63-1995\nTILT=NONE\n2 1000 1.5 4 2 1 1 0.1 0.2 0\n1.0 1.0 30\n0 30 60 90\n0 90\n900 700 300 0\n\
     900 600 200 0\n",
    "A LAMP OF 1986\nTILT=NONE\n1 1200 1.0 3 3 1 2 0 0 0 1 1 40\n90 135 180\n0 90 180\n0 100 200 0 90\n190 0 110\n210\n",
    "IESNA91\nTILT=NONE\n1 -1 1 3 5 1 2 -0.1 0 0.1\n1 1 60\n0 90 180\n0 90 180 270 360\n100 50 0\n100 40 0\n\
     100 30 0\n100 20 0\n100 50 0\n",
];

/// Configurations for `solve`.
pub(crate) const TOML: &str = "# coarse\nuniform = 0.3\nstop = \"5%\"\nhemicube-resolution = 32\njson = true\n\
    output = [\"a.glb\", \"b.ply\"]\nimage = \"a.png\"\nsize = \"40x30\"\neye = [0.3, 0.3, -1]\n\
    target = [0.3, 0.3, 0]\nview = [\"radiosity\"]\nfinal-gather = true\ntwo-sided = \"auto\"\nunits = \"cm\"\n\
    quality = \"draft\"\nsolver = \"jacobi\"\nomega = 1.0\nmax-shots = 3\nquiet = true\n";
