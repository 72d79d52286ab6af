//! What is bent, and what has to hold: an error with words, or a sound scene whose light is finite.
//!
//! Another format becomes a target by its seeds in `corpus`, a [`Target`] here and a line in `main`.

use std::ops::ControlFlow;
use std::process::Command;
use std::time::{Duration, Instant};

use fastrand::Rng;
use glam::DVec3;
use radiosity::scene::{Light, NamedLight};
use radiosity::solver::Cancellation;
use radiosity::{Length, Scene, Settings, reconstruct, solve, surfaces_of};

use super::bend::{bytes, often, text, tree};
use super::corpus;
use super::run::{Files, Outcome, Target};
use crate::load::asset::Asset;
use crate::load::folder::{Folder, red_png};

/// Larger scenes are only loaded.
const MOST_FACES: usize = 150;

pub(crate) const OBJ: Target = Target { name: "obj", quick: 600, files: obj, check: load };
pub(crate) const MTL: Target = Target { name: "mtl", quick: 300, files: mtl, check: load };
pub(crate) const GLTF: Target = Target { name: "gltf", quick: 600, files: gltf, check: load };
pub(crate) const GLB: Target = Target { name: "glb", quick: 400, files: glb, check: load };
pub(crate) const PACKED: Target = Target { name: "packed", quick: 400, files: packed, check: load };
pub(crate) const STL: Target = Target { name: "stl", quick: 400, files: stl, check: load };
pub(crate) const PLY: Target = Target { name: "ply", quick: 600, files: ply, check: load };
pub(crate) const TOML: Target = Target { name: "toml", quick: 60, files: toml, check: configure };
pub(crate) const IES: Target = Target { name: "ies", quick: 600, files: ies, check: shine };
pub(crate) const SOLVED: Target = Target { name: "solved", quick: 60, files: any, check: light };

fn with_picture(mut files: Files) -> Files {
    files.push(("red.png".to_owned(), red_png()));
    files
}

fn obj(rng: &mut Rng) -> Files {
    let mut files = corpus::OBJ[rng.usize(..corpus::OBJ.len())].clone();
    for _ in 0..often(rng) {
        text(rng, &mut files[0].1);
    }
    with_picture(files)
}

fn mtl(rng: &mut Rng) -> Files {
    let mut files = corpus::OBJ[rng.usize(..corpus::OBJ.len())].clone();
    for _ in 0..often(rng) {
        text(rng, &mut files[1].1);
    }
    let mut files = with_picture(files);
    if rng.u8(..4) == 0 {
        bytes(rng, &mut files[2].1);
    }
    files
}

/// A glTF file of `seeds` bent in its tree and in its numbers.
fn asset(rng: &mut Rng, seeds: &[Asset]) -> Asset {
    let seed = &seeds[rng.usize(..seeds.len())];
    let mut asset = Asset { json: seed.json.clone(), bytes: seed.bytes.clone() };
    for _ in 0..often(rng) {
        if rng.u8(..4) > 0 {
            tree(rng, &mut asset.json);
        } else {
            number(rng, &mut asset.bytes);
        }
    }
    // A tree without an object at its root has no place for buffers.
    if !asset.json.is_object() {
        asset.json = serde_json::json!({ "asset": asset.json });
    }
    asset
}

/// Another float at a place where one may stand.
fn number(rng: &mut Rng, bytes: &mut [u8]) {
    let odd = [0.0, -0.0, f32::NAN, f32::INFINITY, 1e38, -1e30, 1e-38, 1.0, 1e6, 0.5, 1.000_000_1];
    let at = 4 * rng.usize(..bytes.len() / 4);
    bytes[at..at + 4].copy_from_slice(&odd[rng.usize(..odd.len())].to_le_bytes());
}

fn gltf(rng: &mut Rng) -> Files {
    let mut text = asset(rng, &corpus::ASSETS).text().into_bytes();
    if rng.u8(..6) == 0 {
        bytes(rng, &mut text);
    }
    with_picture(vec![("a.gltf".to_owned(), text)])
}

fn glb(rng: &mut Rng) -> Files {
    let mut glb = asset(rng, &corpus::ASSETS).glb();
    for _ in 0..rng.usize(..3) {
        bytes(rng, &mut glb);
    }
    with_picture(vec![("a.glb".to_owned(), glb)])
}

/// Compressed, and bent there as well.
fn packed(rng: &mut Rng) -> Files {
    let mut asset = asset(rng, &corpus::PACKED);
    for _ in 0..rng.usize(..4) {
        bytes(rng, &mut asset.bytes);
    }
    vec![("a.glb".to_owned(), asset.glb())]
}

/// Text is bent by its words, what is binary by its bytes.
fn bent(rng: &mut Rng, seeds: &[Vec<u8>]) -> Vec<u8> {
    let mut file = seeds[rng.usize(..seeds.len())].clone();
    let is_text = std::str::from_utf8(&file).is_ok();
    for _ in 0..often(rng) {
        if is_text {
            text(rng, &mut file);
        } else {
            bytes(rng, &mut file);
        }
    }
    file
}

fn stl(rng: &mut Rng) -> Files {
    vec![("a.stl".to_owned(), bent(rng, &corpus::STL))]
}

fn ply(rng: &mut Rng) -> Files {
    vec![("a.ply".to_owned(), bent(rng, &corpus::PLY))]
}

fn toml(rng: &mut Rng) -> Files {
    let mut config = corpus::TOML.as_bytes().to_vec();
    for _ in 0..often(rng) {
        text(rng, &mut config);
    }
    vec![("c.toml".to_owned(), config)]
}

fn ies(rng: &mut Rng) -> Files {
    let mut file = corpus::IES[rng.usize(..corpus::IES.len())].as_bytes().to_vec();
    for _ in 0..often(rng) {
        text(rng, &mut file);
    }
    if rng.u8(..6) == 0 {
        bytes(rng, &mut file);
    }
    vec![("a.ies".to_owned(), file)]
}

fn any(rng: &mut Rng) -> Files {
    match rng.u8(..8) {
        0 => gltf(rng),
        1 => glb(rng),
        2 => stl(rng),
        3 => ply(rng),
        _ => obj(rng),
    }
}

/// The scene in a file, if it is one.
fn loaded(folder: &Folder, name: &str) -> Option<Scene> {
    match folder.load(name) {
        Ok(scene) => Some(scene),
        Err(error) => {
            assert!(!error.to_string().is_empty());
            None
        }
    }
}

fn load(folder: &Folder, name: &str) -> Outcome {
    let Some(scene) = loaded(folder, name) else { return Outcome::Refused };
    assert!(!scene.faces.is_empty());
    assert!(scene.positions.iter().all(|p| p.is_finite()));
    for face in &scene.faces {
        let count = face.vertices.len();
        assert!(count >= 3 && face.vertices.iter().all(|&v| (v as usize) < scene.positions.len()));
        for carried in [face.normals.len(), face.uvs.len(), face.tints.len()] {
            assert!(carried == 0 || carried == count);
        }
    }
    if scene.faces.len() <= MOST_FACES {
        let surfaces = surfaces_of(&scene);
        assert!(surfaces.area().is_finite());
    }
    Outcome::Accepted
}

/// The program refuses or obeys; the scene does not exist, so that it does little else.
fn configure(folder: &Folder, name: &str) -> Outcome {
    let directory = folder.path("");
    let output = Command::new(env!("CARGO_BIN_EXE_radiosity"))
        .args(["solve", "none.obj", "--config", name])
        .current_dir(&directory)
        .output()
        .expect("a program that starts");
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(matches!(output.status.code(), Some(1 | 2)), "{:?}: {words}", output.status);
    assert!(!words.contains("panicked") && !words.is_empty(), "{words}");
    if words.contains("none.obj") { Outcome::Accepted } else { Outcome::Refused }
}

/// A luminaire sends no less than nothing anywhere, and in all what its directions add up to.
fn shine(folder: &Folder, name: &str) -> Outcome {
    let mut scene = Scene::default();
    if let Err(error) = scene.add_luminaire(&folder.path(name), DVec3::Y, 30.0) {
        assert!(error.to_string().contains(name), "{error}");
        return Outcome::Refused;
    }
    let [NamedLight { light: Light::Luminaire { photometry, .. }, .. }] = scene.lights.as_slice()
    else {
        panic!("{:?}", scene.lights)
    };
    let flux = photometry.flux();
    assert!(flux.is_finite() && flux >= -1e-9, "{flux} lm");
    let most = (0..200).map(|k| {
        let (height, around) = (f64::from(k % 20) / 9.5 - 1.0, f64::from(k));
        let out = (1.0 - height * height).max(0.0).sqrt();
        let candela =
            photometry.candela(DVec3::new(out * around.cos(), height, out * around.sin()));
        assert!(candela.is_finite() && candela >= 0.0, "{candela} cd");
        candela
    });
    let most = most.fold(0.0, f64::max);
    assert!(most == 0.0 || flux > 0.0, "{most} cd and no light");
    Outcome::Accepted
}

fn light(folder: &Folder, name: &str) -> Outcome {
    let Some(mut scene) = loaded(folder, name) else { return Outcome::Refused };
    if scene.faces.len() > MOST_FACES {
        return Outcome::Refused;
    }
    if !scene.is_lit() {
        let lamp = scene.faces[0].material.index();
        scene.materials[lamp].emission = DVec3::ONE;
    }
    let surfaces = surfaces_of(&scene);
    let settings = Settings {
        max_level: 2,
        tolerance: 0.3,
        min_element: Length::OfScene(1.0 / 30.0),
        patch_size: Length::OfScene(1.0 / 4.0),
        hemicube_resolution: 32,
        max_shots: Some(60),
        ..Settings::draft()
    };
    let begun = Instant::now();
    let hurry = |_: &_| match begun.elapsed() < Duration::from_secs(5) {
        true => ControlFlow::Continue(()),
        false => ControlFlow::Break(Cancellation::TimeLimit),
    };
    let Ok(solution) = solve(&surfaces, &settings, hurry) else { return Outcome::Refused };
    let mesh = reconstruct(&surfaces, &solution);
    assert!(mesh.positions.iter().all(|p| p.is_finite()));
    assert!(mesh.normals.iter().all(|n| n.is_finite()));
    assert!(mesh.radiosity.iter().all(|b| b.is_finite() && b.min_element() >= 0.0));
    assert!(mesh.irradiance.iter().all(|i| i.direct.is_finite() && i.indirect.is_finite()));
    assert!(solution.energy.imbalance().is_finite());
    Outcome::Accepted
}
