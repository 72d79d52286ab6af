//! What `info` tells about files that something is wrong with: a line for each kind.

use crate::Place;

/// A floor of 4 m × 4 m that faces up.
const FLOOR: &str = "v 0 0 0\nv 0 0 4\nv 4 0 4\nv 4 0 0\nf 1 2 3 4\n";

fn notes(text: &str) -> String {
    let place = Place::new();
    place.write("a.obj", text);
    let json = place.run(&["info", "a.obj", "--json"]).done().json();
    let notes = json["notes"].as_array().expect("a list of notes").iter();
    notes.filter_map(|note| note.as_str()).collect::<Vec<_>>().join("\n")
}

#[test]
fn every_repair_has_its_line() {
    for (added, line) in [
        ("v 4.0000002 0 0\nv 8 0 0\nv 8 0 4\nf 5 3 7\nf 5 7 6\n", "corner moved by rounding"),
        ("v 1 1 0\nv 2 2 0\nv 3 3 0\nf 5 6 7\n", "1 face without area dropped"),
        ("v 0 1 0\nv 4 1 0\nv 4 1.00001 0\nf 5 6 7\n", "1 sliver kept"),
        ("f 2 3 4 1\n", "1 duplicate face dropped"),
        ("v 1 0 1\nv 1 0 2\nv 2 0 2\nusemtl b\nf 5 6 7\n", "1 surface cut out of larger ones"),
        ("v 3 0 1\nv 3 0 2\nv 5 0 2\nusemtl b\nf 5 6 7\n", "1 surface cut where another lies"),
        ("v 2 0 4\nv 0 3 4\nv 4 3 4\nf 5 2 6\nf 3 5 7\n", "1 T-junction closed"),
        ("v 2 0 4.0001\nv 0 3 4\nv 4 3 4\nf 5 2 6\nf 3 5 7\n", "1 corner beside an edge"),
        ("vn 0 -1 0\nf 1//1 2//1 3//1\n", "1 face with vertex normals against"),
        ("v 0 1 0\nv 1 1 0\nv 1 2 0.1\nv 0 2 0\nf 5 6 7 8\n", "1 polygon not planar"),
        ("v 0 1 0\nv 1 2 0\nv 1 1 0\nv 0 3 0\nf 5 6 7 8\n", "1 polygon touching or crossing"),
        ("v 9 9 9\n", "1 position that no face uses"),
        ("mtllib gone.mtl\nusemtl x\nf 1 3 4\n", "material library missing"),
        ("usemtl my paint\nf 1 3 4\n", "unknown material \"my paint\""),
        ("v 900 0 0\nv 0 900 0\nv 0 0 900\nf 5 6 7\n", "is its unit the metre?"),
        ("l 1 2\n", "1 point-or-line element ignored"),
        ("usemtl floor\nv 0 2 0\nv 4 2 0\nv 4 4 0\nf 5 6 7\n", "\"floor\" stand upright"),
    ] {
        let told = notes(&format!("{FLOOR}{added}"));
        assert!(told.contains(line), "{line} is not in:\n{told}");
        assert!(!notes(FLOOR).contains(line), "{line}");
    }
}

#[test]
fn concave_polygons_tabs_and_indices_from_the_end_need_no_line() {
    let text = "v\t0 0 0\nv 2\t0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf\t-6 -5\t-4 -3 -2 -1\n";
    let told = notes(text);
    assert_eq!(told.lines().count(), 1, "{told}");
    assert!(told.starts_with("nothing emits light"), "{told}");
}

#[test]
fn a_plain_round_a_room_is_told_and_sets_no_sizes() {
    let mut text =
        "v -110 -1 -110\nv -110 -1 110\nv 110 -1 110\nv 110 -1 -110\nf 1 2 3 4\n".to_owned();
    for k in 0..6 {
        let x = f64::from(k);
        text += &format!("v {x} 0 0\nv {x} 0 1\nv {x} 3 1\nf -3 -2 -1\n");
    }
    assert!(notes(&text).contains("much larger than the rest"), "{}", notes(&text));
}
