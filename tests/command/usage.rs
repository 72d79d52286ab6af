//! What is refused, and how.

use crate::{Place, scene};

#[test]
fn help_of_every_subcommand_shows_an_example() {
    let place = Place::new();
    for arguments in [
        &["--help"][..],
        &["solve", "-h"],
        &["compare", "--help"],
        &["render", "--help"],
        &["info", "--help"],
    ] {
        let help = place.run(arguments).done();
        assert!(help.stdout.contains("  radiosity "), "{}", help.stdout);
    }
}

#[test]
fn wrong_usage_ends_with_two() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let solve = |more: &[&str]| place.run(&[&["solve", scene.as_str()], more].concat());
    place.run(&[]).refused(2, &["Usage"]);
    solve(&["--no-such-option"]).refused(2, &["--no-such-option"]);
    solve(&["--size", "0x5"]).refused(2, &["WIDTHxHEIGHT"]);
    solve(&["--tolerance", "2"]).refused(2, &["tolerance", "0.001 to 1"]);
    solve(&["--solver", "lu"]).refused(2, &["gauss-seidel"]);
    solve(&["--omega", "2"]).refused(2, &["omega", "less than 2"]);
    solve(&["--uniform", "1e-7"]).refused(2, &["uniform", "pieces"]);
    solve(&["--eye", "-1,2,3"]).refused(2, &["--target"]);
    let same = ["--eye", "-1,2,3", "--target", "-1,2,3", "--image", "a.png"];
    solve(&same).refused(2, &["same point"]);
    solve(&["--camera", "balcony", "--image", "a.png"]).refused(2, &["balcony", "--eye"]);
    solve(&["--threads", "0"]).refused(2, &["threads"]);
}

/// What a user asks for is done, or refused with a word; never dropped.
#[test]
fn options_that_would_do_nothing_are_refused() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let obj = scene.as_str();
    place.write("reference.csv", "");
    for (arguments, words) in [
        (&["solve", obj, "--relightable", "-o", "a.obj"][..], &["relightable", "-o FILE.glb"][..]),
        (&["solve", obj, "--relightable", "--image", "a.png"], &["relightable", "GLB"]),
        (&["solve", obj, "-o", "a.glb", "--size", "20x20"], &["size", "no picture"]),
        (&["solve", obj, "-o", "a.glb", "--view", "error"], &["view", "no picture"]),
        (&["solve", obj, "--html", "a.html", "--view", "error"], &["view", "no picture"]),
        (&["solve", obj, "-o", "a.glb", "--final-gather"], &["final-gather", "no picture"]),
        (&["solve", obj, "--history", "a.csv", "--fov", "40"], &["camera", "picture"]),
        (&["solve", obj, "--history", "a.csv", "--exposure", "4"], &["camera", "picture"]),
        (&["solve", obj, "--image", "a.exr", "--exposure", "4"], &["exposure", ".exr"]),
        (
            &["solve", obj, "--image", "a.png", "--view", "level", "--final-gather"],
            &["final-gather", "direct light"],
        ),
        (&["solve", obj, "--uniform", "0.1", "--max-level", "3"], &["--uniform", "--max-level"]),
        (&["solve", obj, "--uniform", "0.1", "--no-discontinuity-lines"], &["--uniform"]),
        (&["solve", obj, "-o", "a.glb", "--format", "glb"], &["format", "pipes"]),
        (&["solve", obj, "--resume"], &["--checkpoint"]),
        (&["solve", obj, "--emit", "white=1e300"], &["more than"]),
        (&["solve", obj, "--emit", "white=1e300lm"], &["more than"]),
        (&["solve", obj, "--area-light", "0,0,0=1x1=1e200"], &["more than"]),
        (
            &["form-factors", obj, "--method", "hemicube", "--rays", "99"],
            &["rays", "--method rays"],
        ),
        (
            &["form-factors", obj, "--hemicube-resolution", "64"],
            &["hemicube-resolution", "--method hemicube"],
        ),
        (&["form-factors", obj, "--at", "0,0,0,0,1,0"], &["--output"]),
        (&["form-factors", obj, "--at", "0,0,0,0,1,0", "-o", "a.npy"], &["at", ".npy"]),
        (
            &["compare", obj, "--reference", "reference.csv", "--budget", "9s"],
            &["reference", "--budget"],
        ),
        (&["compare", obj, "--reference", "reference.csv", "--places", "900"], &["--places"]),
    ] {
        place.run(arguments).refused(2, words);
    }
    place.solve(&["--relightable", "-o", "lights.glb"]).done();
    let relight = |more: &[&str]| place.run(&[&["relight", "lights.glb"], more].concat());
    relight(&["-o", "b.glb", "--size", "20x20"]).refused(2, &["size", "no picture"]);
    relight(&["--light", "light=1e300", "-o", "b.glb"]).refused(2, &["brighter than anything"]);
}

#[test]
fn snapshots_that_are_never_reached_are_told() {
    let place = Place::new();
    let outcome = place.solve(&["--html", "a.html", "--snapshots", "1,2,99999999"]).done();
    assert!(outcome.stderr.contains("1 of the snapshots"), "{}", outcome.stderr);
}

/// A lamp that shines up, over a floor that it does not reach.
#[test]
fn a_grid_in_darkness_has_no_uniformity() {
    let place = Place::new();
    place.write(
        "dark.obj",
        "mtllib dark.mtl\nusemtl floor\nv 0 0 0\nv 2 0 0\nv 2 0 2\nv 0 0 2\nf 4 3 2 1\n\
         usemtl lamp\nv 4 2 0\nv 5 2 0\nv 5 2 1\nv 4 2 1\nf 8 7 6 5\n\
         usemtl floor\nv 4 3 0\nv 5 3 0\nv 5 3 1\nv 4 3 1\nf 9 10 11 12\n",
    );
    place.write("dark.mtl", "newmtl floor\nKd 0 0 0\nnewmtl lamp\nKd 0 0 0\nKe 5 5 5\n");
    let solve = ["solve", "dark.obj", "--two-sided", "off", "--grid", "0.5,0.5"];
    let told = place.run(&solve).done();
    assert!(told.stdout.contains("in darkness, without a U0"), "{}", told.stdout);
    let json = place.run(&[&solve[..], &["--json"]].concat()).done().json();
    assert_eq!(json["grid"]["mean"], 0.0);
    assert!(json["grid"]["uniformity"].is_null(), "{json}");
}

#[test]
fn a_number_below_zero_is_judged_by_its_option() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let solve = |more: &[&str]| place.run(&[&["solve", scene.as_str()], more].concat());
    solve(&["--patch-size", "-1"]).refused(2, &["patch-size", "-1 is no length", "above 0"]);
    solve(&["--uniform", "-0.5"]).refused(2, &["uniform", "-0.5 is no length"]);
    solve(&["--tolerance", "-1"]).refused(2, &["tolerance", "0.001 to 1"]);
    solve(&["--fov", "-30", "--image", "a.png"]).refused(2, &["1 to 170"]);
    place.run(&["form-factors", &scene, "--patch-size", "-1"]).refused(2, &["above 0"]);
}

#[test]
fn shells_and_man_learn_of_every_option() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = place.run(&["generate", "completions", shell]).done().stdout;
        for word in ["relight", "patch-size", "checkpoint"] {
            assert!(script.contains(word), "{shell} does not know {word}");
        }
    }
    place.run(&["generate", "man", "deep"]).done();
    let read = |name: &str| std::fs::read_to_string(place.path(name)).expect("it was written");
    assert!(
        read("deep/radiosity.1").contains("radiosity")
            && read("deep/radiosity-solve.1").contains("checkpoint")
    );
    // It is for those who package the command, not for its users.
    assert!(!place.run(&["--help"]).done().stdout.contains("generate"));
    place.run(&["generate", "man", "nowhere"]).refused(1, &["nowhere"]);
}

/// Every command has its result on standard output as one value, and says what it has written.
#[test]
fn json_is_the_same_everywhere() {
    let place = Place::new();
    let furnace = scene("furnace.obj");
    let box_ = scene("cornell-box.obj");
    let solved = place.solve(&["-o", "a.glb", "--relightable", "--json"]);
    let render = place.run(&["render", "a.glb", "-o", "a.png", "--size", "20x20", "--json"]);
    let relight = place.run(&["relight", "a.glb", "-o", "b.glb", "--json"]);
    let factors = ["form-factors", &furnace, "--patch-size", "9", "-o", "F.csv", "--json"];
    let factors = place.run(&factors);
    for (outcome, written) in
        [(solved, "a.glb"), (render, "a.png"), (relight, "b.glb"), (factors, "F.csv")]
    {
        let json = outcome.done().json();
        assert_eq!(json["finished"], true, "{json}");
        assert_eq!(json["written"], serde_json::json!([written]), "{json}");
        assert!(json["seconds"][0]["phase"].is_string(), "{json}");
    }
    assert!(place.run(&["info", &box_, "--json"]).done().json()["materials"].is_array());
    let quick = [
        "--adaptive",
        "50%",
        "--uniform",
        "0.2",
        "--places",
        "200",
        "--noise",
        "50%",
        "--stop",
        "5%",
    ];
    let compare = [&["compare", box_.as_str()][..], &quick, &["--csv", "a.csv", "--json"]].concat();
    let json = place.run(&compare).done().json();
    assert_eq!(json["runs"].as_array().map(Vec::len), Some(2));
    assert_eq!(json["written"], serde_json::json!(["a.csv"]));
    assert_eq!(json["finished"], true);
}

/// Whoever gives lamps in lumens is told of lumens.
#[test]
fn powers_are_told_in_the_units_of_the_lamps() {
    let place = Place::new();
    let room = scene("bare-room.obj");
    let solve = |lamp: &str| {
        let light = ["--area-light", lamp, "--quality", "draft", "--uniform", "0.5"];
        place.run(&[&["solve", room.as_str()][..], &light].concat()).done().stdout
    };
    let photometric = solve("2,2.3,2=0.5x0.5=1000lm");
    let line = photometric.lines().find(|line| line.starts_with("emitted")).expect("a line");
    assert!(photometric.contains("flux, lm") && !photometric.contains("power, W"), "{photometric}");
    let lumens: f64 = line["emitted".len()..].trim().parse().expect("a number");
    assert!((lumens - 1000.0).abs() < 0.1, "{line}");
    assert!(solve("2,2.3,2=0.5x0.5=5").contains("power, W"));
}

#[test]
fn unknown_endings_are_refused_before_the_scene_is_read() {
    let place = Place::new();
    place.run(&["solve", "missing.obj", "-o", "a.stl"]).refused(2, &["a.stl", ".glb"]);
    place.run(&["solve", "missing.obj", "--image", "a.gif"]).refused(2, &["a.gif", ".png"]);
    place.run(&["solve", "missing.obj", "--history", "a.txt"]).refused(2, &["a.txt", ".csv"]);
    place.run(&["solve", "scene.blend"]).refused(2, &["scene.blend", ".obj"]);
}

#[test]
fn what_cannot_be_written_is_refused_before_the_scene_is_read() {
    let place = Place::new();
    place.write("file", "");
    place.run(&["solve", "missing.obj", "-o", "file/a.glb"]).refused(1, &["file/a.glb"]);
    place.run(&["solve", "missing.obj", "--image", "file/a.png"]).refused(1, &["file/a.png"]);
    place.run(&["solve", "missing.obj", "--history", "file/a.csv"]).refused(1, &["file/a.csv"]);
}

#[test]
fn missing_files_are_named() {
    let place = Place::new();
    place.run(&["solve", "nowhere.obj"]).refused(1, &["nowhere.obj"]);
    place.run(&["info", "nowhere.glb"]).refused(1, &["nowhere.glb"]);
    place.run(&["render", "nowhere.glb", "-o", "a.png"]).refused(1, &["nowhere.glb"]);
}

#[test]
fn a_scene_is_not_overwritten_by_its_solution() {
    let place = Place::new();
    let glb = std::fs::read(scene("cornell-box.glb")).expect("the scene can be read");
    std::fs::write(place.path("box.glb"), &glb).expect("temporary files can be written");
    place.run(&["solve", "box.glb", "-o", "./box.glb"]).refused(1, &["box.glb"]);
    assert_eq!(std::fs::read(place.path("box.glb")).ok(), Some(glb));
}

#[test]
fn a_scene_without_light_cannot_be_solved() {
    let place = Place::new();
    place.write("dark.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    place.run(&["solve", "dark.obj", "-o", "dark.glb"]).refused(1, &["emits light"]);
    assert!(!place.path("dark.glb").exists());
    let info = place.run(&["info", "dark.obj"]).done();
    assert!(info.stdout.contains("nothing emits light"), "{}", info.stdout);
}
