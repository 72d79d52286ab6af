//! Pictures of what surfaces emit.

use std::f64::consts::PI;
use std::path::Path;

use glam::DVec3;
use image::{Rgb, RgbImage};
use radiosity::direct::Emitters;
use radiosity::form_factor::contour::point_to_polygon;
use radiosity::light::Optics;
use radiosity::mesh::Mesh;
use radiosity::visibility::Occluders;
use radiosity::{Settings, Surfaces, load, surfaces_of};

/// A floor below a panel of 2 × 2 m that faces it, half a metre above; of the panel's picture, the left half, x < 0,
/// glows.
fn panel(material: &str, faces: &str) -> Surfaces {
    let directory = tempfile::tempdir().expect("temporary directories can be made");
    let place = |name: &str| directory.path().join(name);
    let half = RgbImage::from_fn(16, 16, |x, _| Rgb([if x < 8 { 255 } else { 0 }; 3]));
    half.save(place("half.png")).expect("pictures can be written");
    RgbImage::from_pixel(2, 2, Rgb([128; 3])).save(place("grey.png")).expect("they can");
    std::fs::write(place("a.mtl"), format!("newmtl floor\nKd 0 0 0\nnewmtl panel\n{material}\n"))
        .expect("files can be written");
    let obj = format!(
        "mtllib a.mtl\nv -3 0 3\nv 3 0 3\nv 3 0 -3\nv -3 0 -3\nv -1 0.5 1\nv -1 0.5 -1\nv 1 0.5 -1\nv 1 0.5 1\n\
         vt 0 0\nvt 0 1\nvt 1 1\nvt 1 0\nusemtl floor\nf 1 2 3 4\nusemtl panel\n{faces}\n"
    );
    std::fs::write(place("a.obj"), obj).expect("files can be written");
    surfaces_of(&load(Path::new(&place("a.obj")), &Default::default()).expect("it is right"))
}

const QUAD: &str = "f 5/1 6/2 7/3 8/4";
const TRIANGLES: &str = "f 5/1 6/2 7/3\nf 5/1 7/3 8/4";
const GLOW: &str = "Kd 0 0 0\nKe 10 10 10\nmap_Ke half.png";

#[test]
fn an_emission_picture_counts_with_a_colour_picture_and_without() {
    let left = [[-1.0, -1.0], [0.0, -1.0], [0.0, 1.0], [-1.0, 1.0]];
    let left = left.map(|[x, z]| DVec3::new(x, 0.5, z));
    let coloured = GLOW.replace("Kd 0 0 0", "Kd 0.5 0.5 0.5\nmap_Kd grey.png");
    for (material, faces, blur) in
        [(GLOW, QUAD, 0.01), (GLOW, TRIANGLES, 0.02), (&coloured, QUAD, 0.01)]
    {
        let surfaces = panel(material, faces);
        let mesh = Mesh::new(&surfaces, &Settings::draft());
        let exitance = Optics::new(&surfaces, &mesh).exitance;
        let power: f64 = mesh.patches.iter().zip(exitance).map(|(p, e)| e.x * p.area).sum();
        assert!((power - 20.0 * PI).abs() < 1e-3 * power, "{power} W with {material}, {faces}");
        let (lamps, occluders) = (Emitters::new(&surfaces, &mesh), Occluders::new(&surfaces));
        for x in [-0.8, -0.3, 0.3, 0.8] {
            let place = DVec3::new(x, 0.0, 0.2);
            let found = lamps.shine(&occluders, place, DVec3::Y).irradiance.x;
            let expected = 10.0 * PI * point_to_polygon(place, DVec3::Y, &left);
            assert!(
                (found / expected - 1.0).abs() < blur,
                "{found} for {expected} at {x}: {faces}"
            );
        }
    }
}
