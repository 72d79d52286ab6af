//! Light for files that have none, and illuminance on a work plane.

use crate::{Place, scene};

/// Options that make a solution of the room a matter of a moment.
const COARSE: [&str; 8] =
    ["--uniform", "1", "--patch-size", "1", "--hemicube-resolution", "32", "--stop", "5%"];

/// A closed room of 4 m × 3 m × 5 m without any light, its ceiling of a material of its own.
const ROOM: &str = "mtllib room.mtl\n\
    v 0 0 0\nv 4 0 0\nv 4 0 5\nv 0 0 5\nv 0 3 0\nv 4 3 0\nv 4 3 5\nv 0 3 5\n\
    usemtl wall\nf 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n\
    usemtl panel\nf 5 6 7 8\n";

const IES: &str =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 60\n0 45 90\n0\n800 400 0\n";

fn room() -> Place {
    let place = Place::new();
    place.write("room.obj", ROOM);
    place.write("room.mtl", "newmtl wall\nKd 0.5\nnewmtl panel\nKd 0.5\n");
    place.write("spot.ies", IES);
    place
}

fn solve<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["solve", "room.obj", "--json", "-o", "a.glb"], &COARSE[..], more].concat()
}

#[test]
fn a_dark_file_says_how_to_light_it_and_each_way_does() {
    let place = room();
    place.run(&solve(&[])).refused(1, &["emits light", "--emit", "--sky"]);
    place.write("m.toml", "[panel]\nemission = 5\n");
    for more in [
        &["--emit", "pan*=5"][..],
        &["--materials", "m.toml"],
        &["--area-light", "2,2.9,2.5=1.2x0.3=3000lm"],
        &["--area-light", "0.1,1,2.5=1x1=5,4,3=1,0,0"],
        &["--point-light", "2,2,2=800lm"],
        &["--ies", "spot.ies@2,2.9,2.5,90"],
    ] {
        let json = place.run(&solve(more)).done().json();
        let energy = &json["energy"];
        assert!(energy["absorbed"][0].as_f64() > Some(0.1), "{more:?} {json}");
        assert!(energy["imbalance"].as_f64().is_some_and(|x| x.abs() < 0.02), "{more:?} {json}");
    }
    // It is a closed room.
    for more in [["--sun", "135,40"], ["--sky", "cie-overcast"]] {
        place.run(&solve(&more)).refused(1, &["all is black", "--two-sided"]);
    }
}

#[test]
fn lumens_asked_for_are_emitted() {
    let place = room();
    let json = place.run(&solve(&["--emit", "panel=6830lm"])).done().json();
    assert!(
        json["energy"]["emitted"][0].as_f64().is_some_and(|x| (x - 10.0).abs() < 1e-6),
        "{json}"
    );
    let info = ["info", "room.obj", "--area-light", "2,2.9,2.5=1x1=683lm", "--sky", "uniform,6830"];
    let stdout = place.run(&info).done().stdout;
    assert!(stdout.contains("area light 1: (1, 1, 1) W, 683.0000 lm"), "{stdout}");
    assert!(stdout.contains("sky light: (10, 10, 10) W/m²"), "{stdout}");
}

#[test]
fn options_for_light_may_be_in_a_configuration() {
    let place = room();
    place.write(
        "r.toml",
        "emit = [\"panel=100lm\"]\ngrid = [0.75, 1]\ngrid-csv = \"g.csv\"\nsky = \"uniform,5000\"\n",
    );
    let json = place.run(&solve(&["--config", "r.toml"])).done().json();
    assert_eq!(json["grid"]["places"], 20);
    let csv = std::fs::read_to_string(place.path("g.csv")).expect("the grid is written");
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("x,y,z,nx,ny,nz,E_lux,direct_lux,indirect_lux"));
    let rows: Vec<Vec<f64>> =
        lines.map(|row| row.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    assert_eq!(rows.len(), 20);
    assert!(rows.iter().all(|row| (row[6] - row[7] - row[8]).abs() < 1e-5), "{csv}");
    let mean = rows.iter().map(|row| row[6]).sum::<f64>() / 20.0;
    let told = json["grid"]["mean"].as_f64().expect("a number");
    assert!((mean / told - 1.0).abs() < 1e-4 && mean > 1.0, "{mean} {told}");
}

#[test]
fn wrong_lights_are_refused_before_any_work() {
    let place = room();
    for (more, words) in [
        (["--emit", "pane=5"], ["emit: no material \"pane\"", "there are \"panel\", \"wall\""]),
        (["--emit", "panel"], ["--emit", "MATERIAL=AMOUNT"]),
        (["--area-light", "1,2,3"], ["--area-light", "X,Y,Z=WIDTHxDEPTH=AMOUNT"]),
        (["--sun", "0,-10"], ["--sun", "AZIMUTH,ELEVATION"]),
        (["--sky", "clear"], ["--sky", "cie-overcast"]),
        (["--grid", "0.75"], ["--grid", "HEIGHT,SPACING"]),
        (["--grid-csv", "a.csv"], ["--grid <HEIGHT,SPACING>", ""]),
    ] {
        place.run(&solve(&more)).refused(2, &words);
    }
    let lit = ["--emit", "panel=5", "--grid"];
    place.run(&solve(&[&lit[..], &["9,1"]].concat())).refused(2, &["grid: 9 m is not between"]);
    place.run(&solve(&["--ies", "room.mtl@0,0,0"])).refused(1, &["room.mtl:4", "TILT="]);
    let dark = scene("cornell-box.obj");
    place.run(&["info", &dark, "--materials", "none.toml"]).refused(1, &["none.toml"]);
}

#[test]
fn a_room_modelled_inside_out_is_turned_over_by_the_light_added_to_it() {
    let place = room();
    let turn = |line: &str| match line.strip_prefix("f ") {
        Some(corners) => format!("f {}", corners.split(' ').rev().collect::<Vec<_>>().join(" ")),
        None => line.to_owned(),
    };
    let turned: Vec<String> = ROOM.lines().map(turn).collect();
    place.write("turned.obj", &turned.join("\n"));
    let light = ["--point-light", "2,2,2=800lm"];
    let absorbed = |file: &str| -> f64 {
        let solve = ["solve", file, "--json", "-o", "a.glb"];
        let json = place.run(&[&solve[..], &COARSE, &light].concat()).done().json();
        let channels = json["energy"]["absorbed"].as_array().expect("three channels");
        channels.iter().filter_map(serde_json::Value::as_f64).sum()
    };
    let [right, turned] = [absorbed("room.obj"), absorbed("turned.obj")];
    assert!(right > 0.0 && (turned / right - 1.0).abs() < 0.01, "{turned} W and {right} W");
}

#[test]
fn a_solved_file_is_relit_as_a_fresh_solution_would_be() {
    use radiosity::export::load_solved;

    let place = room();
    let lit = |output: &'static str, panel: &'static str, point: &'static str| {
        let lights = ["--emit", panel, "--point-light", point, "--relightable", "-o", output];
        [&["solve", "room.obj", "--json"], &COARSE[..], &lights].concat()
    };
    place.run(&lit("old.glb", "panel=5", "1,1,1=800lm")).done();
    place.run(&lit("fresh.glb", "panel=1,2,9", "1,1,1=200lm")).done();
    let relight = ["relight", "old.glb", "--light", "panel=1,2,9", "--light", "po*=25%"];
    let more = ["-o", "new.glb", "--image", "new.png", "--size", "80x60", "--json"];
    let json = place.run(&[&relight[..], &more].concat()).done().json();
    assert_eq!(json["lights"][1]["name"], "point");
    assert!(place.path("new.png").exists());
    let [(new, stamp), (fresh, _)] =
        ["new.glb", "fresh.glb"].map(|name| load_solved(&place.path(name)).expect("it is whole"));
    assert!(stamp.finished && new.lights.len() == 2 && new.lights[0].group.strength.z == 9.0);
    let largest = fresh.radiosity.iter().map(|b| b.max_element()).fold(0.0, f64::max);
    for (new, fresh) in new.radiosity.iter().zip(&fresh.radiosity) {
        assert!((*new - *fresh).abs().max_element() < 1e-6 * largest, "{new} {fresh}");
    }

    let listed = place.run(&["relight", "old.glb"]).done();
    assert!(listed.stdout.contains("light \"panel\": 5,5,5 W/(m² sr)"), "{}", listed.stdout);
    place
        .run(&["relight", "old.glb", "--light", "pan=0"])
        .refused(2, &["pan", "\"panel\", \"point\""]);
    place.run(&["relight", "old.glb", "--light", "panel=5lx"]).refused(2, &["another unit"]);
    place.run(&["relight", "old.glb", "--light", "panel"]).refused(2, &["NAME=AMOUNT"]);
    place.run(&solve(&["--emit", "panel=5"])).done();
    place.run(&["relight", "a.glb", "--light", "panel=off"]).refused(2, &["--relightable"]);
}

#[test]
fn the_sky_is_seen_behind_the_scene_now_and_from_the_file() {
    let place = Place::new();
    place.write("floor.obj", "v 0 0 0\nv 0 0 4\nv 4 0 4\nv 4 0 0\nf 1 2 3 4\n");
    let view = ["--size", "40x30", "--eye", "2,1,3.9", "--target", "2,1,0"];
    let solve = ["solve", "floor.obj", "--sky", "uniform", "-o", "a.glb", "--image", "a.png"];
    place.run(&[&solve[..], &COARSE, &view].concat()).done();
    place.run(&[&["render", "a.glb", "-o", "b.png"], &view[..]].concat()).done();
    let [now, later] = ["a.png", "b.png"]
        .map(|name| image::open(place.path(name)).expect("a picture").into_rgb8());
    let (above, below) = (now.get_pixel(20, 2).0, now.get_pixel(20, 16).0);
    assert!(above.iter().all(|&c| c > 150), "{above:?}");
    assert_eq!(below, [0; 3], "between the floor's edge and the horizon");
    assert_eq!(now, later);
}

#[test]
fn open_windows_and_turned_files_light_a_room() {
    let place = room();
    // The panel is a roof light; the file has Z up.
    let turned = ROOM.lines().map(|line| match line.strip_prefix("v ") {
        Some(place) => {
            let [x, y, z] = place.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
            format!("v {x} -{z} {y}\n")
        }
        None => format!("{line}\n"),
    });
    place.write("turned.obj", &turned.collect::<String>());
    place.write("open.toml", "[panel]\nremoved = true\n");
    let lit = |more: &[&str]| {
        let solve = ["--json", "--materials", "open.toml", "--sky", "uniform", "-o", "a.glb"];
        let json = place.run(&[more, &solve[..], &COARSE].concat()).done().json();
        assert!(json["notes"].to_string().contains("removed: open"), "{json}");
        json["energy"]["absorbed"][0].as_f64().expect("a number")
    };
    let [plain, turned] = [lit(&["solve", "room.obj"]), lit(&["solve", "turned.obj", "--up", "z"])];
    assert!(plain > 1.0 && (turned / plain - 1.0).abs() < 1e-6, "{plain} W and {turned} W");
}

#[test]
fn emission_in_nits_is_divided_by_683() {
    let place = room();
    place.write("room.mtl", "newmtl wall\nKd 0.5\nnewmtl panel\nKd 0.5\nKe 683 683 683\n");
    let power = |more: &[&str]| {
        let json = place.run(&solve(more)).done().json();
        json["energy"]["emitted"][0].as_f64().expect("a number")
    };
    let (radiance, nits) = (power(&[]), power(&["--emission", "nits"]));
    assert!((radiance / nits - 683.0).abs() < 1e-6, "{radiance} {nits}");
    place.write("c.toml", "emission = \"nits\"\n");
    assert_eq!(power(&["--config", "c.toml"]), nits);
}

#[test]
fn what_was_missing_is_told_before_what_fails_for_it() {
    let place = room();
    std::fs::remove_file(place.path("room.mtl")).expect("it was written");
    for more in [&[][..], &["--emit", "glow=5"], &["--camera", "7", "--sun", "0,60"]] {
        let outcome = place.run(&solve(more));
        let words = outcome.stderr.clone();
        let [missing, failed] = ["material library missing", "radiosity: "].map(|w| words.find(w));
        assert!(missing.is_some() && missing < failed, "{more:?} {outcome:?}");
    }
    let outcome = place.run(&["info", "room.obj", "--emit", "glow=5"]);
    assert!(outcome.code == Some(2) && outcome.stderr.contains("library missing"), "{outcome:?}");
}

#[test]
fn a_dome_round_a_scene_is_told_where_sun_or_sky_are_asked_for() {
    let place = Place::new();
    // A pyramid without a floor over a square of 4 m with a plain round it, and a part of another one.
    let ground = "v -2 0 -2\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nusemtl ground\nf 1 2 3 4\n";
    let dome = "v -9 -1 -9\nv -9 -1 9\nv 9 -1 9\nv 9 -1 -9\nv 0 9 0\nusemtl backdrop\n\
                f 5 6 9\nf 6 7 9\nf 7 8 9\n";
    place.write("open.obj", &format!("{ground}{dome}"));
    place.write("dome.obj", &format!("{ground}{dome}f 8 5 9\n"));
    place.write("m.toml", "[backdrop]\nremoved = true\n");
    let told = |arguments: &[&str]| {
        let json = place.run(&[&["info", "--json"], arguments].concat()).done().json();
        json["notes"].to_string().contains("\\\"backdrop\\\" goes round all the rest")
    };
    for light in [["--sun", "0,60"], ["--sky", "uniform"]] {
        assert!(told(&[&["dome.obj"], &light[..]].concat()), "{light:?}");
        assert!(!told(&[&["dome.obj", "--materials", "m.toml"], &light[..]].concat()), "{light:?}");
    }
    assert!(!told(&["dome.obj", "--point-light", "0,1,0=800lm"]));
    assert!(!told(&["open.obj", "--sky", "uniform"]));
    assert!(told(&["open.obj", "--sun", "180,60"]) != told(&["open.obj", "--sun", "0,60"]));
}

#[test]
fn lamps_in_lumens_are_told_of_in_lumens_however_they_are_given() {
    let place = room();
    place.write("lumens.toml", "[panel]\nemission = \"500lm\"\n");
    place.write("radiance.toml", "[panel]\nemission = 5\n");
    let told = |lamp: [&str; 2]| {
        let page = ["solve", "room.obj", "--html", "a.html", "--size", "40x30"];
        let stdout = place.run(&[&page, &COARSE[..], &lamp].concat()).done().stdout;
        let page = std::fs::read_to_string(place.path("a.html")).unwrap();
        let is_in_lumens = stdout.contains("\nflux, lm\nemitted          500.0\n");
        assert_ne!(is_in_lumens, stdout.contains("\npower, W"), "{stdout}");
        assert_eq!(is_in_lumens, page.contains(">Flux<") && page.contains(">500.0<"), "{lamp:?}");
        is_in_lumens
    };
    for lamp in [["--emit", "panel=500lm"], ["--materials", "lumens.toml"]] {
        assert!(told(lamp), "{lamp:?}");
    }
    assert!(!told(["--materials", "radiance.toml"]));
}
