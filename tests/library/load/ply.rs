//! PLY: what it says, and how it lies.

use glam::{DVec3, Vec3};
use radiosity::Scene;

use super::Folder;

/// A square with a colour at each corner, and a table of no use before its faces.
fn header(format: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty double y\n\
         property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement edge 1\n\
         property list uchar short ends\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
}

const PLACES: [[f64; 3]; 4] = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
const COLOURS: [[u8; 3]; 4] = [[0, 0, 0], [255, 188, 0], [255, 188, 0], [0, 0, 0]];

fn text() -> String {
    let vertex = |(p, c): ([f64; 3], [u8; 3])| {
        format!("{} {} {} {} {} {}\n", p[0], p[1], p[2], c[0], c[1], c[2])
    };
    let vertices: String = PLACES.into_iter().zip(COLOURS).map(vertex).collect();
    format!("{}{vertices}2 0 1\n4 0 1 2 3\n", header("ascii"))
}

fn binary(big: bool) -> Vec<u8> {
    let ordered = |mut bytes: Vec<u8>| {
        if big {
            bytes.reverse();
        }
        bytes
    };
    let format = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut bytes = header(format).into_bytes();
    for ([x, y, z], colour) in PLACES.into_iter().zip(COLOURS) {
        bytes.extend(ordered((x as f32).to_le_bytes().to_vec()));
        bytes.extend(ordered(y.to_le_bytes().to_vec()));
        bytes.extend(ordered((z as f32).to_le_bytes().to_vec()));
        bytes.extend(colour);
    }
    bytes.push(2);
    [0i16, 1].iter().for_each(|end| bytes.extend(ordered(end.to_le_bytes().to_vec())));
    bytes.push(4);
    (0..4i32).for_each(|corner| bytes.extend(ordered(corner.to_le_bytes().to_vec())));
    bytes
}

fn load(file: impl AsRef<[u8]>) -> radiosity::Result<Scene> {
    Folder::new().with("a.ply", file).load("a.ply")
}

#[test]
fn every_encoding_holds_the_same_square() {
    for file in
        [text().into_bytes(), text().replace('\n', "\r\n").into(), binary(false), binary(true)]
    {
        let scene = load(file).unwrap();
        assert_eq!(scene.positions, PLACES.map(DVec3::from));
        assert_eq!(scene.faces[0].vertices[..], [0, 1, 2, 3]);
        // Integers are codes of sRGB: 188 is half of the light.
        let tint = scene.faces[0].tints[1];
        assert!((tint - Vec3::new(1.0, 0.503, 0.0)).abs().max_element() < 1e-3, "{tint}");
        assert_eq!(scene.materials[0].reflectance, DVec3::splat(0.99));
        assert_eq!(scene.notes, ["1 row that is neither vertex nor face ignored"]);
        assert_eq!(radiosity::surfaces_of(&scene).list.len(), 1);
    }
}

#[test]
fn faces_may_have_colours_and_floats_are_linear() {
    let plain = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar uint vertex_index\nproperty float red\nproperty float green\n\
        property float blue\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.25 0.5 2\n";
    let scene = load(plain).unwrap();
    assert_eq!(scene.faces[0].tints[..], [Vec3::new(0.25, 0.5, 1.0); 3]);
    let grey = plain.replace("property float red", "property float heat");
    let scene = load(grey).unwrap();
    assert!(scene.faces[0].tints.is_empty());
    assert_eq!(scene.materials[0].reflectance, DVec3::splat(0.5));
}

#[test]
fn files_that_lie_are_refused() {
    let error = |file: Vec<u8>| load(file).unwrap_err().to_string();
    let text_with = |from: &str, to: &str| error(text().replacen(from, to, 1).into());
    for element in ["vertex 4", "edge 1", "face 1"] {
        let name = element.split(' ').next().unwrap();
        let many = text_with(element, &format!("{name} 4000000000"));
        assert!(many.contains("element "), "{many}");
    }
    let mut long = binary(false);
    let place = long.len() - 17;
    long[place] = 255;
    assert!(error(long).contains("the file ends here"));
    assert!(text_with("4 0 1 2 3", "4 0 1 2 9").contains("vertex 9 is used"));
    assert!(text_with("4 0 1 2 3", "4 0 1 2 -1").contains("-1 is no number of a vertex"));
    assert!(text_with("1 1 0", "nan 1 0").contains("row 2"));
    assert!(text_with("float x", "float a").contains("no x, y and z"));
    assert!(text_with("format ascii", "format utf-8").contains("a.ply:2"));
    assert!(text_with("end_header", "end").contains("a.ply"));
    assert!(text_with("property double y", "property quad y").contains("a.ply:6"));
    assert!(error(b"solid".to_vec()).contains("not PLY"));
}
