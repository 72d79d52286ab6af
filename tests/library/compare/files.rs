//! References as files.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use glam::DVec3;
use npyz::WriterBuilder;
use proptest::prelude::*;
use radiosity::compare::{Origin, Point, Reference, Set};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

fn triples() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1e3..1e3_f64).prop_map(DVec3::from)
}

fn points() -> impl Strategy<Value = Point> {
    let normal = triples().prop_filter_map("a direction", |n| n.try_normalize());
    let rest = (any::<bool>(), 0.0..9.0_f64);
    (triples(), normal, triples(), triples(), rest).prop_map(
        |(place, normal, light, error, rest)| {
            let set = if rest.0 { Set::Shadow } else { Set::Area };
            Point { place, normal, radiosity: light.abs(), error: error.abs(), set, weight: rest.1 }
        },
    )
}

proptest! {
    #[test]
    fn csv_keeps_every_bit(mut points in prop::collection::vec(points(), 1..20)) {
        points[0].set = Set::Area;
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("reference.csv");
        let before = Reference::new(points, Origin::File("made up".into()), 10.0).unwrap();
        before.save(&path).unwrap();
        let after = Reference::load(&path, 10.0).unwrap();
        prop_assert_eq!(before.points, after.points);
        prop_assert_eq!(before.in_band, after.in_band);
    }
}

fn refusal(name: &str, text: &str) -> String {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join(name);
    std::fs::write(&path, text).unwrap();
    Reference::load(&path, 1.0).expect_err("it is wrong").to_string()
}

#[test]
fn what_is_wrong_in_a_csv_is_told_with_its_line() {
    const HEADER: &str = "x,y,z,nx,ny,nz,r,g,b";
    assert!(refusal("a.csv", "").contains("a.csv: is empty"));
    assert!(refusal("a.csv", "x,y,z\n").contains("a.csv:1: there is no column \"nx\""));
    assert!(refusal("a.csv", &format!("{HEADER},q\n")).contains("a.csv:1: unknown column \"q\""));
    let row = |row: &str| refusal("a.csv", &format!("{HEADER}\n0,0,0,0,1,0,1,1,1\n{row}\n"));
    assert!(row("0,0,0,0,1,0,1,1").contains("a.csv:3: 8 columns"));
    assert!(row("0,0,0,0,1,0,1,1,x").contains("a.csv:3: \"x\" is not a number"));
    assert!(row("0,0,0,0,0,0,1,1,1").contains("a.csv:3: the normal"));
    assert!(refusal("a.csv", &format!("{HEADER}\n")).contains("no point"));
    assert!(refusal("a.txt", "").contains(".csv, .npz"));
    assert!(refusal("a.npz", "PK no archive").contains("is no npz"));
}

/// Adds an array to an archive.
fn add(zip: &mut ZipWriter<File>, name: &str, shape: &[u64], numbers: &[f64]) {
    zip.start_file(format!("{name}.npy"), SimpleFileOptions::default()).unwrap();
    let mut bytes = Vec::new();
    let options = npyz::WriteOptions::<f64>::new().default_dtype().shape(shape);
    let mut writer = options.writer(&mut bytes).begin_nd().unwrap();
    writer.extend(numbers.iter().copied()).unwrap();
    writer.finish().unwrap();
    zip.write_all(&bytes).unwrap();
}

fn archive(path: &Path, arrays: &[(&str, &[u64], &[f64])]) {
    let mut zip = ZipWriter::new(File::create(path).unwrap());
    arrays.iter().for_each(|(name, shape, numbers)| add(&mut zip, name, shape, numbers));
    zip.finish().unwrap();
}

#[test]
fn numpy_s_archives_are_read_and_points_out_of_the_score_left_out() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.npz");
    let places: &[f64] = &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0];
    let normals: &[f64] = &[0.0, 2.0, 0.0].repeat(4);
    let light: &[f64] = &[1.0, 2.0, 3.0].repeat(4);
    let (pos, nrm, b) =
        (("pos", &[4, 3][..], places), ("nrm", &[4, 3][..], normals), ("B", &[4, 3][..], light));
    let lamp = ("is_emitter", &[4][..], &[0.0, 1.0, 0.0, 0.0][..]);
    let set = ("set", &[4][..], &[0.0, 0.0, 1.0, 0.0][..]);
    archive(&path, &[pos, nrm, b, lamp, set]);
    let reference = Reference::load(&path, 1.0).unwrap();
    let places: Vec<f64> = reference.points.iter().map(|point| point.place.x).collect();
    assert_eq!(places, [0.0, 3.0, 2.0]);
    assert_eq!(reference.points[2].set, Set::Shadow);
    assert!(reference.points.iter().all(|point| point.normal == DVec3::Y));

    archive(&path, &[pos, b]);
    let told = Reference::load(&path, 1.0).expect_err("no normals").to_string();
    assert!(told.contains("no array \"nrm\""), "{told}");
    archive(&path, &[pos, nrm, ("B", &[3][..], &light[..3])]);
    let told = Reference::load(&path, 1.0).expect_err("too few").to_string();
    assert!(told.contains("array \"B\" has 3 numbers"), "{told}");
}
