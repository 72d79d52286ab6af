//! OBJ and MTL.

use glam::{DVec2, DVec3, Vec3};
use radiosity::scene::{LoadOptions, Scene, Sides, Wrap, load};

use super::{Folder, red_png};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn scene(text: &str) -> Scene {
    Folder::new().with("s.obj", text).load("s.obj").expect("a readable scene")
}

fn error(text: &str) -> String {
    Folder::new().with("s.obj", text).load("s.obj").unwrap_err().to_string()
}

fn with_material(mtl: &str) -> Scene {
    let obj = format!("mtllib m.mtl\n{SQUARE}usemtl a\nf 1 2 3 4\n");
    let folder = Folder::new().with("s.obj", obj).with("m.mtl", mtl).with("red.png", red_png());
    folder.load("s.obj").expect("a readable scene")
}

#[test]
fn coordinates_are_the_nearest_doubles() {
    let scene = scene("v 0.5528 0 0\nv 1 0 0\nv 0 1e-3 0.1\nf 1 2 3\n");
    assert_eq!(scene.positions[0].x, 0.5528);
    assert_eq!(scene.positions[2], DVec3::new(0.0, 1e-3, 0.1));
}

#[test]
fn units_scale_positions() {
    let folder = Folder::new().with("s.obj", format!("{SQUARE}f 1 2 3 4"));
    let options = |metres_per_unit| LoadOptions { metres_per_unit, ..LoadOptions::default() };
    let scene = load(&folder.path("s.obj"), &options(0.01)).unwrap();
    assert_eq!(scene.bounds(), Some((DVec3::ZERO, DVec3::new(0.01, 0.01, 0.0))));
    assert!((scene.extent() - 0.01 * 2f64.sqrt()).abs() < 1e-15);
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(load(&folder.path("s.obj"), &options(wrong)).is_err());
    }
}

#[test]
fn polygons_stay_polygons_and_triangles_triangles() {
    let l = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\nf 1 2 -1\n";
    let sizes = |scene: Scene| scene.faces.iter().map(|f| f.vertices.len()).collect::<Vec<_>>();
    assert_eq!(sizes(scene(l)), [6, 3]);
    assert_eq!(sizes(scene(&format!("{SQUARE}f 1 2 3\nf 1 3 4\n"))), [3, 3]);
}

#[test]
fn odd_but_legal_syntax_is_read() {
    let text = b"\xef\xbb\xbfv\t0 0 0 # origin\r\nv 1 0 \\\r\n 0\r\n# caf\xe9\r\ng\tw\xe4nde\r\nv 1 1 0 1\r\nf -3//  -2//\t-1// # end\r\n";
    let folder = Folder::new().with("s.obj", text);
    let scene = folder.load("s.obj").unwrap();
    assert_eq!(scene.positions, [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)]);
    assert_eq!(scene.objects, ["w\u{fffd}nde"]);
}

#[test]
fn faces_may_stand_before_their_vertices() {
    assert_eq!(scene(&format!("f 1 2 3 4\n{SQUARE}")).faces.len(), 1);
}

#[test]
fn wrong_numbers_and_indices_are_refused_with_their_line() {
    for (line, word) in [
        ("v 0 nan 0", "nan"),
        ("v 0 0 1e999", "1e999"),
        ("v 0 0", "3 coordinates"),
        ("v 1 1 1 0", "infinitely far"),
        ("vt x", "\"x\""),
        ("f 1 2 5", "only 4"),
        ("f 1 2 0", "count from 1"),
        ("f 1 2 -5", "only 4 so far"),
        ("f 1/1 2/1 3/1", "texture coordinate 1"),
        ("f 1//9 2 3", "normal 9"),
        ("f a b c", "\"a\""),
        ("f 1/1/1/1 2 3", "too many"),
    ] {
        let message = error(&format!("{SQUARE}{line}\nf 1 2 3 4\n"));
        assert!(message.contains("s.obj:5: ") && message.contains(word), "{line}: {message}");
    }
}

#[test]
fn coordinates_beyond_sense_are_refused() {
    assert!(error("v 0 0 0\nv 1 0 0\nv 0 1e200 0\nf 1 2 3\n").contains("beyond"));
}

#[test]
fn points_and_lines_are_ignored_with_a_note() {
    let scene = scene(&format!("{SQUARE}p 1 2 3\nl 1 2 3\nf 1 2\nf\nf 1 2 3 4\n"));
    assert_eq!(scene.faces.len(), 1);
    assert!(
        scene.notes.contains(&"4 point-or-line elements ignored".to_owned()),
        "{:?}",
        scene.notes
    );
}

#[test]
fn faces_with_some_texture_coordinates_have_none() {
    let text = format!(
        "mtllib m.mtl\n{SQUARE}vt 0 0\nvt 1 0\nvt 1 1\nusemtl a\nf 1 2 3/3\nf 1/1 2/2 4/3\n"
    );
    let folder = Folder::new()
        .with("s.obj", text)
        .with("m.mtl", "newmtl a\nmap_Kd red.png")
        .with("red.png", red_png());
    let scene = folder.load("s.obj").unwrap();
    assert!(scene.faces[0].uvs.is_empty());
    assert_eq!(scene.faces[1].uvs.len(), 3);
}

#[test]
fn unknown_material_is_grey_with_a_note() {
    let scene = scene(&format!("mtllib none.mtl\n{SQUARE}usemtl x y\nf 1 2 3 4\n"));
    assert_eq!(scene.materials[0].reflectance, DVec3::splat(0.5));
    assert!(scene.faces[0].tints.is_empty());
    assert!(scene.notes[0].contains("none.mtl"), "{:?}", scene.notes);
    assert!(scene.notes[1].contains("s.obj:6: unknown material \"x y\""), "{:?}", scene.notes);
}

#[test]
fn libraries_may_be_several_or_have_spaces_in_their_name() {
    let text = format!(
        "mtllib my lib.mtl\nmtllib\ta.mtl b.mtl\n{SQUARE}usemtl one\nf 1 2 3\nusemtl\ttwo\nf 1 3 4\nusemtl three\nf 4 3 2\n"
    );
    let folder = Folder::new()
        .with("s.obj", text)
        .with("my lib.mtl", "newmtl one\nKd 0.1")
        .with("a.mtl", "newmtl two\nKd 0.2")
        .with("b.mtl", "newmtl three\nKd 0.3");
    let scene = folder.load("s.obj").unwrap();
    let reflectance = |face: usize| scene[scene.faces[face].material].reflectance.x;
    assert_eq!([0, 1, 2].map(reflectance), [0.1, 0.2, 0.3]);
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
}

#[test]
fn emission_is_radiance_and_white_is_clamped() {
    let scene = with_material("newmtl a\nKd 1 0.5 0\nKe 10 20 30\n");
    assert_eq!(scene.materials[0].reflectance, DVec3::new(0.99, 0.5, 0.0));
    assert_eq!(scene.materials[0].emission, DVec3::new(10.0, 20.0, 30.0));
    assert!(scene.is_lit());
    assert_eq!(scene.emitters().collect::<Vec<_>>(), [0]);
    assert_eq!(scene.notes, ["reflectance above 0.99 clamped in \"a\""]);
}

#[test]
fn two_sidedness_can_be_overridden() {
    let folder = Folder::new().with("s.obj", format!("{SQUARE}f 1 2 3 4"));
    let options = LoadOptions { two_sided: Sides::Both, ..LoadOptions::default() };
    assert!(load(&folder.path("s.obj"), &options).unwrap().materials[0].double_sided);
}

#[test]
fn textures_are_counted_from_the_top_after_their_options() {
    let obj = format!(
        "mtllib m.mtl\n{SQUARE}vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3 4/4\n"
    );
    let folder = Folder::new()
        .with("s.obj", obj)
        .with("m.mtl", "newmtl a\nmap_Kd -s 2 4 -o 0.5 0.25 -clamp on red.png\n")
        .with("red.png", red_png());
    let scene = folder.load("s.obj").unwrap();
    let expected = [[0.5, 0.75], [2.5, 0.75], [2.5, -3.25], [0.5, -3.25]].map(DVec2::from);
    assert_eq!(scene.faces[0].uvs[..], expected);
    assert_eq!(scene.textures[0].sampler.wrap, [Wrap::Clamp; 2]);
    assert_eq!(scene.textures[0].texels.iter().collect::<Vec<_>>(), [[1.0, 0.0, 0.0]]);
    assert_eq!(scene.materials[0].reflectance, DVec3::splat(0.99));
}

#[test]
fn quads_with_a_warped_picture_are_split_without_a_word() {
    let obj = "mtllib m.mtl\nv 0 0 0\nv 2 0 0\nv 1.5 1 0\nv 0.5 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
        usemtl a\nf 1/1 2/2 3/3 4/4\n";
    let folder = Folder::new().with("s.obj", obj).with("red.png", red_png());
    let textured = folder.with("m.mtl", "newmtl a\nmap_Kd red.png\nKd 0.5").load("s.obj").unwrap();
    assert_eq!((textured.faces.len(), textured.notes.len()), (2, 0), "{:?}", textured.notes);
    assert_eq!(textured.faces[1].uvs.len(), 3);
    let plain = Folder::new().with("s.obj", obj).with("m.mtl", "newmtl a\nKd 0.5");
    assert_eq!(plain.load("s.obj").unwrap().faces.len(), 1);
}

#[test]
fn missing_picture_leaves_the_factor_and_a_note() {
    let scene = with_material("newmtl a\nKd 0.25\nmap_Kd gone.png\n");
    assert_eq!(scene.materials[0].texture, None);
    assert_eq!(scene.materials[0].reflectance, DVec3::splat(0.25));
    assert!(scene.notes[0].contains("gone.png"), "{:?}", scene.notes);
}

#[test]
fn black_or_white_under_a_missing_picture_is_taken_as_grey_with_a_note() {
    for (colour, expected) in [("0 0 0", 0.5), ("1 1 1", 0.5), ("0.8 0.8 0.8", 0.8)] {
        let scene = with_material(&format!("newmtl a\nKd {colour}\nmap_Kd gone.png\n"));
        assert_eq!(scene.materials[0].reflectance, DVec3::splat(expected), "{colour}");
        let told = "picture missing in \"a\"; grey of reflectance 0.5 is used".to_owned();
        assert_eq!(scene.notes.contains(&told), expected == 0.5, "{:?}", scene.notes);
    }
    let black = with_material("newmtl a\nKd 0 0 0\n");
    assert_eq!((black.materials[0].reflectance, black.notes.len()), (DVec3::ZERO, 0));
}

#[test]
fn white_under_a_picture_is_no_reason_for_a_note() {
    let folder = Folder::new()
        .with("s.obj", format!("mtllib m.mtl\n{SQUARE}vt 0 0\nusemtl a\nf 1/1 2/1 3/1 4/1\n"))
        .with("m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd grey.png\n");
    let picture = |grey: u8| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        let image = image::RgbImage::from_pixel(2, 2, image::Rgb([grey; 3]));
        image.write_to(&mut bytes, image::ImageFormat::Png).expect("an encoded picture");
        bytes.into_inner()
    };
    let grey = folder.with("grey.png", picture(200)).load("s.obj").unwrap();
    assert!(grey.notes.is_empty(), "{:?}", grey.notes);
    let white = Folder::new()
        .with("s.obj", format!("mtllib m.mtl\n{SQUARE}vt 0 0\nusemtl a\nf 1/1 2/1 3/1 4/1\n"))
        .with("m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd grey.png\n")
        .with("grey.png", picture(255));
    let notes = white.load("s.obj").unwrap().notes;
    assert_eq!(notes, ["reflectance above 0.99 clamped in \"a\""]);
}

/// Two squares that meet at a right angle in the edge between vertices 2 and 3.
const ROOF: &str = "v -1 -1 0\nv 0 0 0\nv 0 0 1\nv -1 -1 1\nv 1 -1 0\nv 1 -1 1\n";

#[test]
fn smoothing_groups_average_by_area_inside_the_group_only() {
    let scene = scene(&format!("{ROOF}s 1\nf 3 2 1 4\nf 2 3 6 5\n"));
    let normals = &scene.faces[0].normals;
    assert!((normals[0] - Vec3::Y).length() < 1e-6, "{normals:?}");
    assert!((normals[2] - Vec3::new(-1.0, 1.0, 0.0).normalize()).length() < 1e-6, "{normals:?}");
    for apart in ["s 1\nf 3 2 1 4\ns 2\nf 2 3 6 5\n", "s off\nf 3 2 1 4\nf 2 3 6 5\n"] {
        let scene = super::obj::scene(&format!("{ROOF}{apart}"));
        assert!(scene.faces.iter().all(|face| face.normals.is_empty()), "{apart}");
    }
}

#[test]
fn given_normals_win_over_smoothing_groups() {
    let flat = "vn -0.7071 0.7071 0\nvn 0.7071 0.7071 0\n";
    let scene = scene(&format!("{ROOF}{flat}s 1\nf 3//1 2//1 1//1 4//1\nf 2//2 3//2 6//2 5//2\n"));
    assert!(scene.faces.iter().all(|face| face.normals.is_empty()));
}

/// A square whose vertices have one colour on the left and one on the right.
fn tinted(left: &str, right: &str) -> String {
    let colours = [left, right, right, left];
    let corners = SQUARE.lines().zip(colours).map(|(line, colour)| format!("{line} {colour}\n"));
    corners.collect()
}

#[test]
fn colours_of_vertices_are_factors_of_reflectance_in_srgb() {
    let obj = format!("mtllib m.mtl\n{}usemtl a\nf 1 2 3 4\n", tinted("0.5 0 2", "1 1 1"));
    let load = |mtl: &str| {
        let folder =
            Folder::new().with("s.obj", &obj).with("m.mtl", mtl).with("red.png", red_png());
        folder.load("s.obj").expect("a readable scene")
    };
    let plain = load("newmtl a\nKd 0.8 0.6 0.4\n");
    assert_eq!(plain.materials[0].reflectance, DVec3::new(0.8, 0.6, 0.4));
    let [left, right, ..] = plain.faces[0].tints[..] else { panic!("no tints") };
    assert!(left.abs_diff_eq(Vec3::new(0.214_041, 0.0, 1.0), 1e-6) && right == Vec3::ONE);
    assert_eq!(plain.notes, ["1 face tinted by the colours of its vertices, taken as sRGB"]);
    let pictured = load("newmtl a\nmap_Kd red.png\n");
    assert!(pictured.faces[0].tints.is_empty());
    assert!(pictured.notes.concat().contains("colours of its vertices are ignored"));
}

#[test]
fn colours_are_all_that_is_known_of_what_has_no_material_and_white_says_nothing() {
    let coloured = scene(&format!("{}f 1 2 3 4\n", tinted("0.5 0.5 0.5", "0.5 0.5 0.5")));
    assert_eq!(coloured.materials[0].reflectance, DVec3::splat(0.99));
    assert!((coloured.faces[0].tints[3].x - 0.214_041).abs() < 1e-6);
    let white = scene(&format!("{}f 1 2 3 4\n", tinted("1 1 1", "1.0 1 1")));
    let plain = scene(&format!("{SQUARE}f 1 2 3 4\n"));
    assert_eq!(white.materials[0].reflectance, plain.materials[0].reflectance);
    assert!(white.faces[0].tints.is_empty() && white.notes == plain.notes, "{:?}", white.notes);
    // What is far behind the first vertices is told apart from them.
    let late = format!("{SQUARE}v 0 0 1\nv 1 0 1 0 0 0\nv 1 1 1\nf 1 2 3 4\nf 5 6 7\n");
    let late = scene(&late);
    assert!(late.faces[0].tints.is_empty());
    assert_eq!(late.faces[1].tints[..], [Vec3::ONE, Vec3::ZERO, Vec3::ONE]);
}

#[test]
fn opacity_pictures_cut_holes_into_colours_and_into_what_has_none() {
    let grey = image::GrayImage::from_fn(2, 1, |x, _| image::Luma([255 * x as u8]));
    let mut mask = std::io::Cursor::new(Vec::new());
    grey.write_to(&mut mask, image::ImageFormat::Png).unwrap();
    let obj = format!(
        "mtllib m.mtl\n{SQUARE}vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3 4/4\n"
    );
    let load = |mtl: &str| {
        let folder =
            Folder::new().with("s.obj", &obj).with("m.mtl", mtl).with("red.png", red_png());
        folder.with("mask.png", mask.get_ref()).load("s.obj").unwrap()
    };
    for (colours, expected) in [("map_Kd red.png\n", DVec3::X), ("Kd 0.5 0.5 0.5\n", DVec3::ONE)] {
        let scene = load(&format!("newmtl a\n{colours}map_d mask.png\n"));
        assert_eq!(scene.materials[0].cutoff, Some(0.5));
        let texture = &scene.textures[scene.materials[0].texture.unwrap() as usize];
        assert_eq!(texture.alpha, [0, 255]);
        assert_eq!(texture.sample(DVec2::new(0.75, 0.5)), expected);
        let area = radiosity::surfaces_of(&scene).area();
        assert!((area - 0.5).abs() < 1e-9, "{area} m²");
    }
    let turned = load("newmtl a\nmap_Kd red.png\nmap_d -s 2 2 mask.png\n");
    assert_eq!(turned.materials[0].cutoff, None);
    assert!(turned.notes[0].contains("laid on unlike"), "{:?}", turned.notes);
}
