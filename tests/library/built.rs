//! Scenes made in code: right, or refused with a word; never a panic.

use std::ops::ControlFlow;

use radiosity::colour::Rgb;
use radiosity::glam::{DVec3, Vec3};
use radiosity::scene::{Face, Light, Material, MaterialId, NamedLight};
use radiosity::{Error, Scene, Settings, compare, faces_of, load, solve, surfaces_of};

/// A lamp over a floor, each a square with positions of its own.
fn lamp_over_floor() -> Scene {
    let mut scene = Scene { objects: vec!["room".to_owned()], ..Scene::default() };
    let material = |name: &str, emission| Material {
        name: name.to_owned(),
        emission: Rgb::splat(emission),
        ..Material::default()
    };
    scene.materials = vec![material("floor", 0.0), material("lamp", 5.0)];
    let square = |y: f64, corners: [[f64; 2]; 4]| corners.map(|[x, z]| DVec3::new(x, y, z));
    let up = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
    let down = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    scene.positions = [square(0.0, up), square(1.0, down)].concat();
    let face = |material: u32| Face {
        vertices: (4 * material..4 * material + 4).collect(),
        material: MaterialId(material),
        ..Face::default()
    };
    scene.faces = vec![face(0), face(1)];
    scene
}

fn lit(scene: &Scene) -> radiosity::Result<()> {
    let settings = Settings { uniform: Some(0.5), hemicube_resolution: 32, ..Settings::draft() };
    solve(&surfaces_of(scene), &settings, |_| ControlFlow::Continue(())).map(|_| ())
}

/// What is wrong, and a word of the message.
type Flaw = (fn(&mut Scene), &'static str);

/// What would lead nowhere, so that nothing can be made of it.
const UNSOUND: [Flaw; 14] = [
    (|scene| scene.faces[1].vertices = [4, 4, 5].into_iter().collect(), "face 1 has no area"),
    (|scene| scene.faces.clear(), "no faces"),
    (|scene| scene.positions[1].x = f64::NAN, "position 1"),
    (|scene| scene.positions[7].y = f64::INFINITY, "position 7"),
    (|scene| scene.faces[1].vertices[2] = 99, "face 1 has a corner at position 99, of 8"),
    (|scene| scene.faces[0].vertices.truncate(2), "face 0 has 2 corners"),
    (|scene| scene.faces[1].material = MaterialId(2), "face 1 is of material 2, of 2"),
    (|scene| scene.faces[0].normals.push(Vec3::Y), "not as many normals"),
    (|scene| scene.faces[0].tints = [Vec3::NAN; 4].into_iter().collect(), "face 0 has a normal"),
    (|scene| scene.materials[0].texture = Some(3), "\"floor\" has a texture beyond the 0"),
    (|scene| scene.materials[0].reflectance.x = f64::NAN, "\"floor\" reflects"),
    (|scene| scene.materials[1].emission.z = -1.0, "\"lamp\" emits"),
    (|scene| scene.materials[1].emission.z = f64::INFINITY, "\"lamp\" emits"),
    (
        |scene| {
            let (direction, irradiance) = (DVec3::ZERO, Rgb::ONE);
            scene.lights.push(NamedLight::from(Light::Sun { direction, irradiance }));
        },
        "light \"sun\"",
    ),
];

/// What can be looked at, and is wrong.
const OUT_OF_RANGE: [Flaw; 3] = [
    (|scene| scene.positions[2].y = 0.3, "face 0 is bent by"),
    (|scene| scene.materials[0].reflectance.x = 1.0, "\"floor\" reflects"),
    (|scene| scene.materials[1].emission.z = 1e13, "\"lamp\" emits"),
];

#[test]
fn what_is_right_is_built_and_lit() {
    let scene = lamp_over_floor().build().expect("nothing is wrong");
    lit(&scene).expect("it can be lit");
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
}

#[test]
fn what_is_wrong_is_refused_by_name() {
    for (spoil, words) in UNSOUND.into_iter().chain(OUT_OF_RANGE) {
        let mut scene = lamp_over_floor();
        spoil(&mut scene);
        let error = scene.build().expect_err(words);
        assert!(matches!(error, Error::Scene(_)) && error.to_string().contains(words), "{error}");
    }
}

/// Whoever does not build it is told all the same.
#[test]
fn what_leads_nowhere_cannot_be_lit() {
    for (spoil, words) in UNSOUND {
        let mut scene = lamp_over_floor();
        spoil(&mut scene);
        let error = lit(&scene).expect_err(words).to_string();
        assert!(error.contains(words), "{error}");
        assert!(faces_of(&scene).list.is_empty());
        let compared =
            compare::compare(&scene, &Default::default(), &mut |_| ControlFlow::Break(()));
        assert!(compared.is_err_and(|error| error.to_string().contains(words)));
    }
    for (spoil, _) in OUT_OF_RANGE {
        let mut scene = lamp_over_floor();
        spoil(&mut scene);
        let _ = lit(&scene);
    }
}

#[test]
fn scenes_of_files_are_sound() {
    for name in ["cornell-box.obj", "cornell-box.glb", "office.obj", "furnace.obj", "canopy.obj"] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
        let scene = load(&path, &Default::default()).expect("it can be read");
        let count = scene.faces.len();
        assert_eq!(scene.build().map(|scene| scene.faces.len()).ok(), Some(count), "{name}");
    }
}
