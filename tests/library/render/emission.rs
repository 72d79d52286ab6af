//! Surfaces that shine and have pictures: what they emit is on the picture of the emission, what they reflect on that
//! of the colour.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use glam::DVec2;
use radiosity::export::{self, Stamp};
use radiosity::scene::{Face, Material, NamedLight, Scene};
use radiosity::{Settings, reconstruct, solve, surfaces_of};

use super::*;

/// Halves of the colour, quarters of the emission.
const COLOUR: [f32; 2] = [0.5, 1.0];
const EMISSION: [f32; 4] = [0.0, 1.0, 0.0, 0.25];

/// W/m²: what a white emission picture sends, and what a white colour picture reflects.
const EMITTED: f64 = 2.0 * PI;
const REFLECTED: f64 = 0.8 * 5.0;

fn picture(greys: &[f32]) -> Texture {
    Texture {
        width: greys.len() as u32,
        height: 1,
        texels: greys.iter().map(|&grey| [grey; 3]).collect(),
        sampler: Sampler { nearest: true, ..Sampler::default() },
        ..Texture::default()
    }
}

/// The mesh of a square of 2 m that shines, on elements half as wide as it, under a sun of 5 W/m².
fn lamp(texture: Option<u32>, emission_texture: Option<u32>) -> TriMesh {
    let corners = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].map(DVec2::from);
    let place = |uv: DVec2| DVec3::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.0);
    let sun = Light::Directional { direction: DVec3::NEG_Z, irradiance: DVec3::splat(5.0) };
    let scene = Scene {
        positions: corners.map(place).to_vec(),
        faces: vec![Face {
            vertices: [0, 1, 2, 3].into_iter().collect(),
            uvs: corners.into_iter().collect(),
            ..Face::default()
        }],
        objects: vec!["lamp".to_owned()],
        materials: vec![Material {
            reflectance: DVec3::splat(0.8),
            emission: DVec3::splat(EMITTED / PI),
            texture,
            emission_texture,
            ..Material::default()
        }],
        textures: vec![picture(&COLOUR), picture(&EMISSION)],
        lights: vec![NamedLight { name: "sun".to_owned(), light: sun }],
        ..Scene::default()
    };
    let surfaces = surfaces_of(&scene.build().unwrap());
    let settings = Settings { uniform: Some(1.0), ..Settings::draft() };
    let solution = solve(&surfaces, &settings, |_| ControlFlow::Continue(())).unwrap();
    reconstruct(&surfaces, &solution)
}

/// Most that a picture of the lamp differs from what it should be, W/(m² sr).
fn error(mesh: &TriMesh, [texture, emission_texture]: [Option<u32>; 2]) -> f64 {
    let radiances = render(mesh, &camera_in_front(5.0), &small(40, 20)).values;
    let texel = |picture: Option<u32>, greys: &[f32], share: f64| {
        picture.map_or(1.0, |_| f64::from(greys[(share * greys.len() as f64) as usize]))
    };
    let difference = |column: usize| {
        let share = (column as f64 + 0.5 - 10.0) / 20.0;
        let emitted = EMITTED * texel(emission_texture, &EMISSION, share);
        let reflected = REFLECTED * texel(texture, &COLOUR, share);
        (f64::from(radiances[10 * 40 + column].x) - (emitted + reflected) / PI).abs()
    };
    (10..30).map(difference).fold(0.0, f64::max)
}

#[test]
fn what_shines_shows_both_its_pictures_here_and_in_files() {
    for pictures in [[Some(0), Some(1)], [None, Some(1)], [Some(0), None]] {
        let mesh = lamp(pictures[0], pictures[1]);
        assert!(error(&mesh, pictures) < 1e-5, "{pictures:?}: {}", error(&mesh, pictures));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lamp.glb");
        export::save(&mesh, &path, &Stamp::default()).unwrap();
        let (read, _) = export::load_solved(&path).unwrap();
        // Half a step of 8 bits at the bright end.
        let most = 0.005 * (EMITTED + REFLECTED) / PI;
        assert!(error(&read, pictures) < most, "{pictures:?}: {}", error(&read, pictures));
    }
}
