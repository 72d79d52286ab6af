//! What is written, and what is said about it.

use image::GenericImageView as _;
use radiosity::export::load_solved;

use crate::{Place, scene};

/// The first bytes of every PNG.
const PNG: &[u8] = b"\x89PNG";

fn begins_with(place: &Place, name: &str, bytes: &[u8]) -> bool {
    std::fs::read(place.path(name)).is_ok_and(|found| found.starts_with(bytes))
}

#[test]
fn every_file_asked_for_is_written() {
    let place = Place::new();
    let meshes = ["-o", "a.glb", "-o", "deep/b.obj", "-o", "c.ply"];
    let pictures = ["--image", "a.png", "--image", "b.exr", "--image", "c.hdr", "--size", "40x30"];
    let outcome = place.solve(&[&meshes[..], &pictures].concat()).done();
    for (name, start) in [
        ("a.glb", &b"glTF"[..]),
        ("c.ply", b"ply"),
        ("a.png", PNG),
        ("b.exr", b"\x76\x2f\x31\x01"),
        ("c.hdr", b"#?RADIANCE"),
    ] {
        assert!(begins_with(&place, name, start), "{name}");
        assert!(outcome.stdout.contains(name), "{}", outcome.stdout);
    }
    assert!(place.path("deep/b.obj").exists());
    let (mesh, stamp) = load_solved(&place.path("a.glb")).expect("the GLB can be read again");
    assert!(stamp.finished && !mesh.triangles.is_empty());
}

#[test]
fn json_tells_where_the_power_has_gone() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let solve = ["solve", &scene, "--json", "-o", "a.glb", "--quality", "draft", "--threads", "1"];
    let json = place.run(&solve).done().json();
    let power = |name: &str| -> f64 {
        let channels = json["energy"][name].as_array().expect("three channels");
        channels.iter().filter_map(serde_json::Value::as_f64).sum()
    };
    let gone = power("absorbed") + power("on_backs") + power("escaped") + power("unshot");
    assert!((power("emitted") - gone).abs() < 0.005 * power("emitted"), "{json}");
    assert_eq!(json["finished"], true);
    assert_eq!(json["written"][0], "a.glb");
    assert_eq!(json["settings"]["tolerance"], 0.08);
    assert!(json["leaves"].as_u64() > Some(500), "{json}");
}

#[test]
fn shadows_can_be_found_in_plainer_ways() {
    let place = Place::new();
    let scene = scene("blocker.obj");
    let divided = |more: &[&str]| {
        let solve = ["solve", &scene, "--json", "-o", "a.glb", "--quality", "draft"];
        let json = place.run(&[&solve[..], more].concat()).done().json();
        let counts = ["discontinuity", "shadow_edge"].map(|why| json["divided"][why].as_u64());
        (counts.map(Option::unwrap_or_default), json)
    };
    let ([lines, _], _) = divided(&[]);
    let ([none, edges], json) = divided(&["--no-discontinuity-lines", "--shadow-rays", "16"]);
    assert!(lines > 0 && none == 0 && edges > 0, "{lines}, {none}, {edges}");
    assert_eq!(json["settings"]["discontinuity_lines"], false);
    assert_eq!(json["settings"]["shadow_rays"], 16);
}

#[test]
fn quiet_says_nothing() {
    let place = Place::new();
    let outcome = place.solve(&["--quiet", "-o", "a.glb"]).done();
    assert_eq!((outcome.stdout.as_str(), outcome.stderr.as_str()), ("", ""));
    assert!(place.path("a.glb").exists());
}

#[test]
fn away_from_a_terminal_every_phase_has_a_line() {
    let outcome = Place::new().solve(&["-o", "a.glb"]).done();
    for phase in ["reading", "direct light", "reflected light", "gathering", "triangles", "writing"]
    {
        let has_line = outcome.stderr.lines().any(|line| line.starts_with(phase));
        assert!(has_line, "{phase}: {}", outcome.stderr);
    }
}

#[test]
fn a_shot_limit_leaves_an_unfinished_solution() {
    let place = Place::new();
    let outcome = place.solve(&["--max-shots", "2", "--json", "-o", "a.glb"]).done();
    assert_eq!(outcome.json()["stop"], "shot limit");
    let (_, stamp) = load_solved(&place.path("a.glb")).expect("the GLB can be read again");
    assert!(!stamp.finished);
}

#[test]
fn pictures_of_an_unfinished_solution_say_so() {
    let place = Place::new();
    let images = ["-o", "a.glb", "--image", "a.png", "--size", "160x120", "--json"];
    let corner = |name: &str| {
        let picture = image::open(place.path(name)).expect("the picture was written").into_rgb8();
        picture.view(0, 0, 84, 20).to_image()
    };
    let undone = place.solve(&[&images[..], &["--max-shots", "2"]].concat()).done();
    assert_eq!(undone.json()["finished"], false);
    place.run(&["render", "a.glb", "-o", "b.png", "--size", "160x120"]).done();
    let marked = corner("a.png");
    assert_eq!(marked, corner("b.png"), "a GLB keeps that it is unfinished");
    let done = place.solve(&images).done();
    assert_eq!(done.json()["finished"], true);
    assert_ne!(marked, corner("a.png"));
    assert!(marked.pixels().filter(|pixel| pixel.0 == [20; 3]).count() > 500);
}

#[test]
fn solvers_are_on_record_with_their_history() {
    let place = Place::new();
    for (solver, omega) in
        [("jacobi", "0.9"), ("gauss-seidel", "1.2"), ("southwell", "1"), ("progressive", "1.1")]
    {
        let options = ["--solver", solver, "--omega", omega, "--history", "deep/a.csv", "--json"];
        let json = place.solve(&options).done().json();
        assert_eq!(json["stop"], "converged", "{solver}");
        assert_eq!(json["settings"]["solver"], solver);
        assert_eq!(json["settings"]["omega"].as_f64(), omega.parse().ok());
        assert_eq!(json["written"][0], "deep/a.csv");

        let text = std::fs::read_to_string(place.path("deep/a.csv")).expect("it was written");
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("shots,patch,residual,unshot"));
        assert!(lines.next().is_some_and(|line| line.starts_with("0,,")), "{text}");
        let last: Vec<f64> =
            lines.next_back().unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!(last[0] > 1.0 && last[3] <= 0.05, "{solver}: {last:?}");
    }
}

#[test]
fn a_solved_glb_gives_the_picture_that_came_with_it() {
    let place = Place::new();
    let scene = scene("cornell-box.glb");
    let view = ["--size", "64x48", "--exposure", "6"];
    let solve =
        ["solve", &scene, "--uniform", "0.2", "--stop", "5%", "-o", "a.glb", "--image", "a.png"];
    place.run(&[&solve[..], &view].concat()).done();
    place.run(&["render", "a.glb", "-o", "b.png", "--size", "64x48"]).done();
    let [one, other] = ["a.png", "b.png"].map(|name| std::fs::read(place.path(name)).ok());
    assert!(one.is_some() && one == other, "camera or exposure were lost on the way");
}

#[test]
fn pictures_of_a_solved_glb_may_be_taken_from_anywhere() {
    let place = Place::new();
    place.solve(&["-o", "a.glb"]).done();
    let view =
        ["--eye", "-0.1,0.3,-0.9", "--target", "0.3,0.2,0.3", "--fov", "50", "--size", "64x48"];
    let render = |more: &[&str]| {
        place.run(&[&["render", "a.glb", "-o", "b.png"], &view[..], more].concat()).done();
        std::fs::read(place.path("b.png")).expect("the picture was written")
    };
    let plain = render(&[]);
    assert!(plain.starts_with(PNG));
    for more in [["--view", "wireframe"], ["--view", "radiosity"]] {
        assert_ne!(render(&more), plain, "{more:?}");
    }
}

#[test]
fn a_glb_without_radiosity_is_refused_with_advice() {
    let place = Place::new();
    let scene = scene("cornell-box.glb");
    place.run(&["render", &scene, "-o", "a.png"]).refused(1, &["radiosity solve"]);
}

#[test]
fn info_measures_in_metres_and_watts() {
    let place = Place::new();
    let text = place.run(&["info", &scene("facing-squares.obj")]).done().stdout;
    assert!(text.contains("surfaces   2"), "{text}");
    let json = place.run(&["info", "--json", "--units", "cm", &scene("furnace.obj")]).done().json();
    let high = &json["bounds"][1];
    let low = &json["bounds"][0];
    let width = high[0].as_f64().zip(low[0].as_f64()).map(|(high, low)| high - low);
    assert!(width.is_some_and(|width| (width - 0.01).abs() < 1e-9), "{json}");
    let powers = json["materials"].as_array().expect("a list of materials");
    let power: f64 = powers.iter().filter_map(|material| material["power"][0].as_f64()).sum();
    assert!((power - 6e-4).abs() < 1e-6, "six square centimetres glow with 1 W/m²: {power}");
}

#[test]
fn a_reader_that_leaves_early_is_no_failure() {
    let place = Place::new();
    let mut command = place.command(&["info", &scene("office.obj")]);
    let mut child = command.stdout(std::process::Stdio::piped()).spawn().expect("it can be run");
    drop(child.stdout.take());
    assert!(child.wait().is_ok_and(|status| status.success()));
}

#[test]
fn a_lightmap_is_a_coarse_mesh_and_its_maps() {
    let place = Place::new();
    let outcome = place.solve(&["-o", "deep/room.glb", "--lightmap", "64"]).done();
    for (name, start) in [
        ("deep/room.lightmap.glb", &b"glTF"[..]),
        ("deep/room.lightmap.exr", b"\x76\x2f\x31\x01"),
        ("deep/room.lightmap.png", PNG),
    ] {
        assert!(begins_with(&place, name, start), "{name}");
        assert!(outcome.stdout.contains(name), "{}", outcome.stdout);
    }
    let length = |name| std::fs::metadata(place.path(name)).map_or(0, |file| file.len());
    assert!(length("deep/room.lightmap.glb") < length("deep/room.glb") / 2);
}

#[test]
fn a_lightmap_that_cannot_be_is_refused_before_the_work() {
    let place = Place::new();
    let refused = |arguments: &[&str], code, words: &str| {
        let outcome = place.solve(arguments);
        assert_eq!(outcome.code, Some(code), "{outcome:?}");
        assert!(outcome.stderr.contains(words), "{outcome:?}");
        assert!(!outcome.stderr.contains("shots"), "{outcome:?}");
    };
    let lightmap = ["-o", "a.glb", "--lightmap"];
    refused(&[&lightmap[..], &["8"]].concat(), 2, "16..=8192");
    refused(&[&lightmap[..], &["16"]].concat(), 2, "17 charts");
    refused(&[&lightmap[..], &["64", "-o", "a.lightmap.glb"]].concat(), 1, "written twice");
    refused(&[&lightmap[..], &["64", "--image", "a.lightmap.png"]].concat(), 1, "written twice");
    refused(&["--lightmap", "64"], 2, "--output");
    let written = std::fs::read_dir(place.path(".")).expect("the directory is there").count();
    assert_eq!(written, 1, "files are left behind beside the folder that was there");
}

#[test]
fn pictures_count_once_under_the_limit_of_memory() {
    let place = Place::new();
    let picture = image::RgbImage::from_pixel(2048, 2048, image::Rgb([99; 3]));
    picture.save(place.path("a.png")).expect("temporary files can be written");
    let corners = "v 0 0 0\nv 4 0 0\nv 4 0 -4\nv 0 0 -4\nv 0 2 0\nv 4 2 0\nv 4 2 -4\nv 0 2 -4\nvt 0 0\nvt 1 1\n";
    let faces = "usemtl a\nf 1/1 2/2 3/1 4/2\nusemtl b\nf 5/1 8/2 7/1 6/2\n";
    place.write("a.obj", &format!("mtllib a.mtl\n{corners}{faces}"));
    let maps = "newmtl a\nmap_Kd a.png\nnewmtl b\nKe 1 1 1\nmap_Kd -clamp on a.png\n";
    place.write("a.mtl", maps);
    let solve = |limit: &str| place.run(&solve_in(limit));
    solve("20MB").refused(2, &["max-memory", "23 MB are needed"]);
    // Twice the picture's 12.6 MB would be too much for this.
    solve("30MB").done();
}

fn solve_in(limit: &str) -> Vec<&str> {
    [&["solve", "a.obj", "-o", "a.ply", "--max-memory", limit], &crate::COARSE[..]].concat()
}
