//! The matrix of form factors as the command writes it.

use serde_json::Value;

use crate::{Place, scene};

/// Two unit squares face to face at distance 1, and a concave polygon below them.
const SQUARES: &str = "
v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1
v 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1
v 0 -3 0\nv 2 -3 0\nv 2 -3 2\nv 1 -3 2\nv 1 -3 1\nv 0 -3 1
o floor\nf 4 3 2 1\no \"lid\"\nf 5 6 7 8\no corner\nf 14 13 12 11 10 9\n";

/// Howell's C-11 for two unit squares at distance 1.
const FACTOR: f64 = 0.199_824_895_698_387_4;

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn json_has_the_polygons_by_name_and_their_factors() {
    let place = Place::new();
    place.write("squares.obj", SQUARES);
    for method in ["contour", "hemicube", "rays"] {
        let at = ["--at", "0.5,0,0.5,0,2,0", "--patch-size", "99"];
        let command = ["form-factors", "squares.obj", "--method", method, "-o", "F.json"];
        let outcome = place.run(&[&command[..], &at].concat()).done();
        assert!(outcome.stdout.contains("is not closed"), "{}", outcome.stdout);
        let text = std::fs::read_to_string(place.path("F.json")).unwrap();
        let json: Value = serde_json::from_str(&text).unwrap();
        let patches = json["patches"].as_array().unwrap();
        let names: Vec<&str> = patches.iter().map(|p| p["object"].as_str().unwrap()).collect();
        assert_eq!(names, ["floor", "\"lid\"", "corner"], "concave polygons stay whole");
        assert!((number(&patches[2]["area"]) - 3.0).abs() < 1e-9, "{}", patches[2]);
        assert!((number(&patches[2]["centre"][0]) - 7.0 / 6.0).abs() < 1e-9, "{}", patches[2]);
        assert!((number(&json["F"][0][1]) - FACTOR).abs() < 1e-6, "{method}: {}", json["F"]);
        assert!((number(&json["F"][1][0]) - FACTOR).abs() < 1e-6, "{method}: {}", json["F"]);
        assert!((number(&json["at"][1]) - 0.239_456_470_460_773_5).abs() < 1e-6, "{}", json["at"]);
    }
}

#[test]
fn csv_and_npy_hold_the_same_matrix() {
    let place = Place::new();
    place.write("squares.obj", SQUARES);
    let outputs = ["-o", "F.csv", "-o", "F.npy", "--patch-size", "0.6"];
    place.run(&[&["form-factors", "squares.obj", "-q"], &outputs[..]].concat()).done();
    let npy = std::fs::read(place.path("F.npy")).unwrap();
    assert!(npy.starts_with(b"\x93NUMPY"));
    let array = npyz::NpyFile::new(&npy[..]).unwrap();
    let rows = array.shape()[0];
    assert_eq!((array.shape(), array.order()), (&[rows; 2][..], npyz::Order::C));
    let read: Vec<f64> = array.into_vec().unwrap();
    let start = 10 + usize::from(u16::from_le_bytes([npy[8], npy[9]]));
    let values: Vec<f64> =
        npy[start..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
    assert_eq!(read, values);
    let n = values.len().isqrt();
    assert!(n * n == values.len() && n > 8, "{} values", values.len());
    let csv = std::fs::read_to_string(place.path("F.csv")).unwrap();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("from,from_object,to,to_object,factor"));
    let mut count = 0;
    for line in lines {
        let fields: Vec<&str> = line.split(',').collect();
        let [from, to] = [0, 2].map(|k| fields[k].parse::<usize>().unwrap());
        assert_eq!(fields[4].parse::<f64>().unwrap(), values[from * n + to], "{line}");
        count += 1;
    }
    assert_eq!(count, values.iter().filter(|value| **value > 0.0).count());
    assert!(csv.contains(",\"\"\"lid\"\"\","), "quotes are doubled");
}

#[test]
fn a_closed_room_is_called_closed_and_its_laws_can_be_enforced() {
    let place = Place::new();
    let scene = scene("two-rooms.obj");
    let command = ["form-factors", &scene, "--patch-size", "2", "--json", "--method", "hemicube"];
    let raw = place.run(&command).done().json();
    assert!(number(&raw["escaping"]).abs() < 0.01, "{raw}");
    assert!(number(&raw["closure"]) > 1e-9, "nothing to enforce in {raw}");
    let enforced = place.run(&[&command[..], &["--enforce"]].concat()).done().json();
    assert!(number(&enforced["closure"]) < 1e-9, "{enforced}");
    assert!(number(&enforced["reciprocity"]) < 1e-9, "{enforced}");
}

#[test]
fn one_thread_and_three_write_the_same_bytes() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    for method in ["contour", "hemicube", "rays"] {
        let written = ["1", "3"].map(|threads| {
            let cells: &[&str] = if method == "rays" { &["--rays", "1024"] } else { &[] };
            let arguments = [&["--method", method, "--threads", threads][..], cells].concat();
            let fixed = ["form-factors", &scene, "--patch-size", "0.3", "-q", "-o", "F.csv"];
            place.run(&[&fixed[..], &arguments].concat()).done();
            std::fs::read(place.path("F.csv")).unwrap()
        });
        assert!(written[0].len() > 10_000 && written[0] == written[1], "{method}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    for (arguments, message) in [
        (&["-o", "F.txt"][..], ".json, .csv, .npy"),
        (&["--at", "1,2,3"], "six numbers"),
        (&["--at", "1,2,3,0,0,0"], "no direction"),
        (&["--method", "rays", "--rays", "3"], "rays"),
        (&["--method", "hemicube", "--hemicube-resolution", "33"], "even"),
        (&["--patch-size", "0.0001"], "patch-size"),
    ] {
        let outcome = place.run(&[&["form-factors", &scene], arguments].concat());
        assert_ne!(outcome.code, Some(0), "{arguments:?}");
        assert!(outcome.stderr.contains(message), "{arguments:?}: {}", outcome.stderr);
    }
}
