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
    solve(&["--eye", "-1,2,3", "--target", "-1,2,3"]).refused(2, &["same point"]);
    solve(&["--camera", "balcony"]).refused(2, &["balcony", "--eye"]);
    solve(&["--threads", "0"]).refused(2, &["threads"]);
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
