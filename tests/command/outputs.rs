//! Where outputs go: never onto what is read, through links, into pipes.

use std::fs;

use crate::{COARSE, Place, scene};

/// A lit room of its own, its materials in `room.mtl`, with a picture.
fn room(place: &Place) {
    let read = |name: &str| fs::read_to_string(scene(name)).expect("the scene can be read");
    place.write("room.obj", &read("cornell-box.obj").replace("cornell-box.mtl", "room.mtl"));
    let picture = image::RgbImage::from_pixel(2, 2, image::Rgb([200, 100, 50]));
    picture.save(place.path("wall.png")).expect("temporary files can be written");
    place.write("room.mtl", &(read("cornell-box.mtl") + "\nmap_Kd wall.png\n"));
}

/// Runs `solve` on it.
fn solve<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["solve", "room.obj"][..], &COARSE, more].concat()
}

#[test]
fn nothing_that_is_read_is_overwritten() {
    let place = Place::new();
    room(&place);
    place.write("room.toml", "tolerance = 0.1\n");
    place.write("walls.csv", "[\"white\"]\nreflectance = 0.5\n");
    let files = ["room.obj", "room.mtl", "wall.png", "room.toml", "walls.csv"];
    let before = files.map(|name| fs::read(place.path(name)).expect("it was written"));
    let read = &["is a file that this run reads", "--force"];
    place.run(&solve(&["--image", "wall.png"])).refused(1, read);
    // The materials beside an OBJ.
    fs::create_dir(place.path("out")).expect("temporary folders can be made");
    place.run(&solve(&["-o", "out/../room.obj"])).refused(1, read);
    place.run(&solve(&["--materials", "walls.csv", "--history", "walls.csv"])).refused(1, read);
    fs::copy(place.path("room.toml"), place.path("settings.csv")).expect("it can be copied");
    place.run(&solve(&["--config", "settings.csv", "--history", "settings.csv"])).refused(1, read);
    place.run(&solve(&["-o", "a.glb", "-o", "./a.glb"])).refused(1, &["twice"]);
    place.run(&solve(&["-o", "a.obj", "--checkpoint", "a.mtl"])).refused(1, &["twice"]);
    let after = files.map(|name| fs::read(place.path(name)).expect("it is still there"));
    assert!(before == after && !place.path("a.glb").exists());

    place.run(&solve(&["--image", "wall.png", "--force"])).done();
    assert!(fs::read(place.path("wall.png")).is_ok_and(|bytes| bytes != before[2]));
}

#[test]
fn materials_of_others_beside_an_obj_are_left_alone() {
    let place = Place::new();
    room(&place);
    place.write("pre.mtl", "newmtl wood\n");
    place.run(&solve(&["-o", "pre.obj"])).refused(1, &["pre.mtl", "there already", "--force"]);
    assert!(!place.path("pre.obj").exists());
    assert_eq!(fs::read_to_string(place.path("pre.mtl")).ok().as_deref(), Some("newmtl wood\n"));
    // Those of the same OBJ, written before, are not those of others.
    for _ in 0..2 {
        place.run(&solve(&["-o", "own.obj"])).done();
    }
    // The picture lies on the lamp, and shines with it.
    assert!(place.path("own-1.png").exists());
    place.run(&solve(&["-o", "pre.obj", "--force"])).done();
    place.write("new-1.png", "a picture of others");
    place.run(&solve(&["-o", "new.obj"])).refused(1, &["new-1.png", "there already", "--force"]);
}

#[test]
fn a_mistyped_folder_is_an_error() {
    let place = Place::new();
    place.solve(&["-o", "renders/a.glb"]).refused(1, &["renders", "there is no folder"]);
    assert!(!place.path("renders").exists());
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_modes_kept() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let place = Place::new();
    place.write("real.csv", "");
    fs::set_permissions(place.path("real.csv"), fs::Permissions::from_mode(0o600)).expect("ours");
    symlink("real.csv", place.path("link.csv")).expect("links can be made");
    symlink("later.csv", place.path("dangling.csv")).expect("links can be made");
    place.solve(&["--history", "link.csv"]).done();
    place.solve(&["--history", "dangling.csv"]).done();
    assert!(place.path("link.csv").is_symlink() && place.path("dangling.csv").is_symlink());
    let real = fs::metadata(place.path("real.csv")).expect("it is there");
    assert!(real.len() > 0 && real.permissions().mode() & 0o777 == 0o600);
    assert!(place.path("later.csv").exists());
    symlink(scene("cornell-box.obj"), place.path("scene.obj")).expect("links can be made");
    place.solve(&["-o", "scene.obj"]).refused(1, &["is a file that this run reads"]);
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_written_to() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let arguments = [&["solve", scene.as_str()][..], &COARSE].concat();
    let piped = |more: &[&str]| {
        let output = place.command(&[&arguments[..], more].concat()).output().expect("it runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    };
    assert!(piped(&["-o", "-", "--format", "glb"]).starts_with(b"glTF"));
    assert!(piped(&["--image", "/dev/stdout", "--format", "png"]).starts_with(b"\x89PNG"));
    assert!(piped(&["-q", "--history", "-", "--format", "csv"]).starts_with(b"shots,"));
    piped(&["-o", "/dev/null", "--format", "ply"]);
    assert!(fs::metadata("/dev/null").is_ok_and(|about| !about.is_file()));
    place.solve(&["-o", "-"]).refused(2, &["--format", "ending"]);
    place.solve(&["-o", "-", "--format", "obj"]).refused(2, &["several files"]);
    place.solve(&["-o", "-", "--format", "glb", "--json"]).refused(1, &["one thing"]);

    let made = std::process::Command::new("mkfifo").arg(place.path("pipe.glb")).status();
    assert!(made.is_ok_and(|status| status.success()));
    let pipe = place.path("pipe.glb");
    let reader = std::thread::spawn(move || fs::read(pipe));
    place.solve(&["-o", "pipe.glb"]).done();
    let bytes = reader.join().expect("it does not panic").expect("the pipe can be read");
    assert!(bytes.starts_with(b"glTF"));
}
