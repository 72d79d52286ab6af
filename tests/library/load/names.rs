//! Lines, keywords and names of files as exporters of other machines write them.

use glam::DVec3;
use radiosity::scene::{Scene, Wrap};
use serde_json::json;

use super::asset::{Asset, FLOAT, floats};
use super::{Folder, red_png};

const OBJ: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
    usemtl wood\nf 1/1 2/2 3/3 4/4\n";
const MTL: &str = "newmtl wood\nKd 0.25 0.5 0.125\n";

fn load(obj: &str, mtl: (&str, &str)) -> Scene {
    let folder = Folder::new().with("a.obj", obj).with(mtl.0, mtl.1).with("red.png", red_png());
    folder.load("a.obj").unwrap()
}

fn reflectance(scene: &Scene) -> DVec3 {
    scene[scene.faces[0].material].reflectance
}

const WOOD: DVec3 = DVec3::new(0.25, 0.5, 0.125);

#[test]
fn lines_may_end_in_carriage_returns_and_keywords_be_in_capitals() {
    let old = |text: &str| text.replace('\n', "\r");
    let loud = |text: &str| {
        let words = ["mtllib", "v", "vt", "usemtl", "f", "newmtl", "Kd"];
        let line = |line: &str| match line.split_once(' ') {
            Some((word, rest)) if words.contains(&word) => {
                format!("{} {rest}", word.to_uppercase())
            }
            _ => line.to_owned(),
        };
        text.lines().map(line).collect::<Vec<_>>().join("\n")
    };
    for (obj, mtl) in [(old(OBJ), old(MTL)), (loud(OBJ), loud(MTL)), (old(&loud(OBJ)), MTL.into())]
    {
        let scene = load(&obj, ("a.mtl", &mtl));
        assert_eq!((scene.faces.len(), reflectance(&scene)), (1, WOOD));
        assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    }
    let wrong = OBJ.replace("v 1 1 0", "v 1 x 0").replace('\n', "\r");
    let error = Folder::new().with("a.obj", wrong).load("a.obj").unwrap_err().to_string();
    assert!(error.contains("a.obj:4"), "{error}");
}

#[test]
fn comments_after_names_are_none_of_them() {
    for (library, user, definition) in [
        ("a.mtl # all of it", "wood # oak", "wood"),
        ("a.mtl #all", "wood #oak", "wood\t# from the shop"),
        ("\"a.mtl\"", "wood", "wood #oak"),
        ("a.mtl", "Material #25", "Material #25"),
    ] {
        let obj = OBJ.replace("a.mtl", library).replace("wood", user);
        let other = "newmtl Material #1\nKd 0.9\n";
        let scene = load(&obj, ("a.mtl", &format!("{}{other}", MTL.replace("wood", definition))));
        assert_eq!(reflectance(&scene), WOOD, "{library}, {user}, {definition}: {:?}", scene.notes);
        assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    }
}

#[test]
fn names_of_files_elsewhere_or_in_another_case_mean_those_beside_the_scene() {
    for name in [
        "A.MTL",
        "C:\\Users\\me\\A.mtl",
        "/srv/models/a.mtl",
        "file:///srv/my%20models/a.mtl",
        "\\\\server\\share\\a.mtl",
        "../gone/a.mtl",
    ] {
        let scene = load(&OBJ.replace("a.mtl", name), ("a.mtl", MTL));
        assert_eq!(reflectance(&scene), WOOD, "{name}: {:?}", scene.notes);
        let [note] = &scene.notes[..] else { panic!("{name}: {:?}", scene.notes) };
        assert!(note.contains("\"a.mtl\" beside the scene is taken"), "{note}");
    }
    for name in ["RED.png", "D:\\tex\\Red.PNG", "/srv/red.png # it", "tex/red.png"] {
        let scene = load(OBJ, ("a.mtl", &format!("{MTL}map_Kd {name}\n")));
        assert_eq!(scene.materials[0].texture, Some(0), "{name}: {:?}", scene.notes);
        assert_eq!(scene.notes.len(), 1, "{name}: {:?}", scene.notes);
    }
    let scene = load(OBJ, ("a.mtl", &format!("{MTL}map_Kd red.png # it\n")));
    assert!(scene.materials[0].texture.is_some() && scene.notes.is_empty(), "{:?}", scene.notes);
}

/// The triangle with a texture for each of the samplers.
fn textured(uri: &str, samplers: serde_json::Value) -> Asset {
    let count = samplers.as_array().unwrap().len();
    let textures = (0..count).map(|sampler| json!({"source": 0, "sampler": sampler}));
    let material =
        |index: usize| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": index}}});
    Asset::triangle()
        .attribute("TEXCOORD_0", &floats(&[0.; 6]), FLOAT, "VEC2")
        .set("/images", json!([{"uri": uri}]))
        .set("/samplers", samplers)
        .set("/textures", textures.collect())
        .set("/materials", (0..count).map(material).collect())
}

#[test]
fn pictures_of_gltf_files_are_found_likewise() {
    for uri in ["RED.png", "C:\\a\\red.PNG", "/srv/red.png", "file:///srv/red.png"] {
        let folder = Folder::new().with("red.png", red_png());
        let scene =
            folder.with("a.gltf", textured(uri, json!([{}])).text()).load("a.gltf").unwrap();
        assert_eq!(scene.materials[0].texture, Some(0), "{uri}: {:?}", scene.notes);
        assert!(scene.notes[0].contains("\"red.png\" beside the scene"), "{:?}", scene.notes);
    }
}

#[test]
fn a_picture_is_decoded_once_and_takes_as_much_as_it_came_with() {
    let picture = image::RgbImage::from_pixel(64, 32, image::Rgb([9, 99, 199]));
    let mut png = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut png, image::ImageFormat::Png).unwrap();
    let samplers = json!([{}, {"wrapS": 33071, "wrapT": 33071}]);
    let asset = textured("wood.png", samplers);
    let folder = Folder::new().with("wood.png", png.get_ref()).with("a.gltf", asset.text());
    let gltf = folder.load("a.gltf").unwrap();
    let mtl = "newmtl wood\nmap_Kd wood.png\nnewmtl b\nmap_Kd -clamp on wood.png\n";
    let folder = folder.with("a.obj", OBJ).with("a.mtl", mtl);
    for scene in [gltf, folder.load("a.obj").unwrap()] {
        let [tiled, clamped] = &scene.textures[..] else { panic!("{:?}", scene.textures.len()) };
        assert_eq!(tiled.sampler.wrap, [Wrap::Repeat; 2]);
        assert_eq!(clamped.sampler.wrap, [Wrap::Clamp; 2]);
        assert_eq!(tiled.texels.memory(), clamped.texels.memory());
        assert_eq!(tiled.texels.memory().1, 64 * 32 * 3);
        let shown = radiosity::surfaces_of(&scene).textures;
        assert_eq!(shown[0].texels.memory(), tiled.texels.memory());
    }
}
