//! Options from a file.

use crate::{Place, scene};

#[test]
fn a_file_gives_options_and_the_command_line_wins() {
    let place = Place::new();
    place.write(
        "radiosity.toml",
        "# coarse\nuniform = 0.3\nstop = \"5%\"\nhemicube-resolution = 32\njson = true\n\
         output = [\"a.glb\", \"b.ply\"]\nimage = \"a.png\"\nsize = \"40x30\"\n\
         eye = [0.3, 0.3, -1]\ntarget = [0.3, 0.3, 0]\nview = [\"radiosity\"]\nfinal-gather = true\n",
    );
    let scene = scene("cornell-box.glb");
    let solve = ["solve", scene.as_str(), "--config", "radiosity.toml"];
    let json =
        place.run(&[&solve[..], &["--uniform", "0.25", "--camera", "0"]].concat()).done().json();
    assert_eq!(json["settings"]["uniform"], 0.25);
    assert_eq!(json["settings"]["hemicube_resolution"], 32);
    for name in ["a.glb", "b.ply", "a.png"] {
        assert!(place.path(name).exists(), "{name}");
    }
}

#[test]
fn wrong_lines_are_named() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    for (text, words) in [
        ("stop = 0.1\n\ntolerence = 0.1\n", ["radiosity.toml:3", "tolerence"]),
        ("stop = 0.1\nsize = \"wide\"\n", ["radiosity.toml:2", "WIDTHxHEIGHT"]),
        ("final-gather = 1\n", ["radiosity.toml:1", "true or false"]),
        ("view = \"nothing\"\n", ["radiosity.toml:1", "nothing"]),
        ("quality = \"best\"\n", ["radiosity.toml:1", "best"]),
        ("stop = 0.1\nstop = \n", ["radiosity.toml:2", ""]),
        ("config = \"other.toml\"\n", ["radiosity.toml:1", "unknown key"]),
    ] {
        place.write("radiosity.toml", text);
        place.run(&["solve", &scene, "--config", "radiosity.toml"]).refused(2, &words);
    }
    place.run(&["solve", &scene, "--config", "none.toml"]).refused(1, &["none.toml"]);
}
