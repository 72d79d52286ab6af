//! Scenes with light and materials that their files do not have.

use std::f64::consts::PI;

use proptest::prelude::*;
use radiosity::Scene;
use radiosity::colour::{LUMENS_PER_WATT, Rgb};
use radiosity::scene::MaterialId;
use radiosity::scene::{Amount, AreaLight, Face, Material};

use glam::DVec3;

/// Two squares of 2 m × 2 m of `lamp 1`, one of them of `lamp 2`, and a material without faces.
fn squares() -> Scene {
    let named = |name: &str| Material { name: name.to_owned(), ..Material::default() };
    let corner = |x: f64, z: f64| DVec3::new(2.0 * x, 0.0, 2.0 * z);
    let face = |material| Face {
        vertices: [0, 1, 2, 3].into_iter().collect(),
        material,
        ..Face::default()
    };
    Scene {
        positions: vec![corner(0., 0.), corner(0., 1.), corner(1., 1.), corner(1., 0.)],
        faces: vec![face(MaterialId(0)), face(MaterialId(1))],
        materials: vec![named("lamp 1"), named("lamp 2"), named("none")],
        ..Scene::default()
    }
}

#[test]
fn lumens_are_those_of_all_faces_that_match() {
    let mut scene = squares();
    scene.emit("lamp*", Amount::Flux(1000.0)).expect("there are lamps");
    // Φ = π L A of 8 m².
    let expected = 1000.0 / (LUMENS_PER_WATT * PI * 8.0);
    assert!((scene.materials[0].emission.x / expected - 1.0).abs() < 1e-12);
    assert_eq!(scene.materials[0].emission, scene.materials[1].emission);
    scene.materials[0].double_sided = true;
    scene.emit("lamp 1", Amount::Flux(1000.0)).expect("there are lamps");
    assert!((scene.materials[0].emission.x / expected - 1.0).abs() < 1e-12, "two sides of 4 m²");
    assert_eq!(scene.materials[2].emission, Rgb::ZERO);
}

#[test]
fn nothing_emits_lumens_from_no_area_and_no_unknown_name_anything() {
    let mut scene = squares();
    let message = |result: radiosity::Result<()>| result.expect_err("it is wrong").to_string();
    assert!(message(scene.emit("none", Amount::Flux(1.0))).contains("\"none\" is on no face"));
    let unknown = message(scene.emit("Lamp1", Amount::Flux(1.0)));
    assert!(unknown.contains("there are \"lamp 1\", \"lamp 2\", \"none\""), "{unknown}");
    scene.emit("none", Amount::Radiance(Rgb::ONE)).expect("radiance needs no area");
}

#[test]
fn an_area_light_is_a_black_surface_of_its_own() {
    let mut scene = squares();
    let lamp = AreaLight {
        centre: DVec3::new(1.0, 2.0, 1.0),
        size: [0.5, 0.25],
        direction: DVec3::NEG_Y,
        amount: Amount::Flux(800.0),
    };
    for _ in 0..2 {
        scene.add_area_light(&lamp).expect("it is right");
    }
    let last = &scene.materials[4];
    assert_eq!((last.name.as_str(), last.reflectance), ("area light 2", Rgb::ZERO));
    let flux = last.emission.x * PI * 0.125 * LUMENS_PER_WATT;
    assert!((flux - 800.0).abs() < 1e-9, "{flux}");
    for wrong in [
        AreaLight { size: [0.0, 1.0], ..lamp },
        AreaLight { size: [1.0, f64::NAN], ..lamp },
        AreaLight { direction: DVec3::ZERO, ..lamp },
        AreaLight { centre: DVec3::splat(1e9), ..lamp },
    ] {
        assert!(scene.add_area_light(&wrong).is_err(), "{wrong:?}");
    }
    assert_eq!(scene.faces.len(), 4);
}

fn overridden(text: &str) -> Result<Scene, String> {
    let directory = tempfile::tempdir().expect("temporary directories can be made");
    let path = directory.path().join("m.toml");
    std::fs::write(&path, text).expect("temporary files can be written");
    let mut scene = squares();
    let done = scene.override_materials(&path);
    done.map(|()| scene).map_err(|error| error.to_string())
}

#[test]
fn a_file_of_materials_replaces_what_it_names() {
    let text = "[\"lamp*\"]\nreflectance = 0.2\nemission = [3, 2, 1.5]\n\n\
                [\"lamp 2\"]\nemission = \"100lm\"\ndouble_sided = true\nreflectance = [1, 0.5, 0]\n";
    let scene = overridden(text).expect("the file is right");
    let [first, second, none] = scene.materials.as_slice() else { panic!() };
    assert_eq!((first.reflectance, first.emission), (Rgb::splat(0.2), Rgb::new(3.0, 2.0, 1.5)));
    assert_eq!((second.reflectance, second.double_sided), (Rgb::new(0.99, 0.5, 0.0), true));
    let flux = second.emission.x * PI * 8.0 * LUMENS_PER_WATT;
    assert!((flux - 100.0).abs() < 1e-9, "from both sides: {flux}");
    assert!(!first.double_sided && none.emission == Rgb::ZERO);
    assert!(scene.notes[0].contains("clamped in \"lamp 2\""), "{:?}", scene.notes);
}

#[test]
fn removed_materials_have_no_faces_and_a_note() {
    let text = "[\"lamp 2\"]\nremoved = true\n[\"lamp*\"]\nemission = \"100lm\"\nremoved = false\n";
    let scene = overridden(text).expect("the file is right");
    assert!(scene.faces.len() == 1 && scene.faces[0].material == MaterialId(0));
    assert_eq!(scene.notes, ["1 face of \"lamp 2\" removed: open, not even glass"]);
    let flux = scene.materials[0].emission.x * PI * 4.0 * LUMENS_PER_WATT;
    assert!((flux - 100.0).abs() < 1e-9, "from what is left: {flux}");
}

#[test]
fn wrong_lines_of_a_file_of_materials_are_named() {
    for (text, words) in [
        ("[lampe]\nemission = 1\n", ["m.toml:1", "no material \"lampe\""]),
        ("[\"lamp 1\"]\n\nemision = 1\n", ["m.toml:3", "unknown key \"emision\""]),
        ("[\"lamp 1\"]\nreflectance = 1.5\n", ["m.toml:2", "0 to 1"]),
        ("[\"lamp 1\"]\nreflectance = [1, 2]\n", ["m.toml:2", "three"]),
        ("[\"lamp 1\"]\nemission = \"800l\"\n", ["m.toml:2", "emission"]),
        ("[\"lamp 1\"]\nemission = -1\n", ["m.toml:2", "emission"]),
        ("[\"*\"]\nremoved = true\n", ["m.toml:2", "no face is left"]),
        ("[\"lamp 1\"]\nremoved = 1\n", ["m.toml:2", "removed: write true or false"]),
        ("[\"lamp 1\"]\ndouble_sided = 1\n", ["m.toml:2", "true or false"]),
        ("[none]\nemission = \"1lm\"\n", ["m.toml:2", "on no face"]),
        ("\nemission = 1\n", ["m.toml:2", ""]),
    ] {
        let message = overridden(text).expect_err(text);
        assert!(words.iter().all(|word| message.contains(word)), "{text}: {message}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_file_of_materials_is_too_strange(text in "[\\[\\]\"a-z0-9=_.*\n -]{0,60}", value in "[\\[\\]\"0-9a-z,. -]{0,12}") {
        for text in [text, format!("[\"*\"]\nemission = {value}\nreflectance = {value}")] {
            let scene = overridden(&text);
            let sound = |colour: Rgb| colour.is_finite() && colour.min_element() >= 0.0;
            let is_sound = |m: &Material| sound(m.emission) && sound(m.reflectance);
            let refused_or_sound = scene.is_err() || scene.is_ok_and(|s| s.materials.iter().all(is_sound));
            prop_assert!(refused_or_sound, "{}", text);
        }
    }

    #[test]
    fn no_amount_and_no_name_is_too_strange(text in ".{0,20}") {
        let radiance = text.parse::<Amount>().and_then(|amount| amount.radiance(1.0));
        if let Ok(radiance) = radiance {
            prop_assert!(radiance.is_finite() && radiance.min_element() >= 0.0);
        }
        let _ = squares().emit(&text, Amount::Flux(1.0));
    }
}
