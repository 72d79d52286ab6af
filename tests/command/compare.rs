//! Comparisons by the command.

use crate::{Place, scene};

/// A comparison that is a matter of a moment, with a reference good enough after the first few paths.
const QUICK: [&str; 14] = [
    "--adaptive",
    "50%,20%",
    "--uniform",
    "0.2,0.06",
    "--noise",
    "50%",
    "--places",
    "500",
    "--quality",
    "draft",
    "--hemicube-resolution",
    "32",
    "--stop",
    "5%",
];

/// The columns that are the same on all machines.
fn lasting(table: &str) -> Vec<String> {
    let first = table.lines().next().expect("a header");
    let count = first.split(',').position(|name| name == "seconds").expect("seconds come last");
    let cut = |line: &str| line.split(',').take(count).collect::<Vec<_>>().join(",");
    table.lines().map(cut).collect()
}

#[test]
fn a_comparison_says_who_wins_whatever_the_threads() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let run = |threads: &str, csv: &str| {
        let fixed = ["compare", &scene, "--threads", threads, "--csv", csv, "--figures", "a.json"];
        let outcome = place.run(&[&fixed[..], &QUICK].concat()).done();
        (outcome.stdout, std::fs::read_to_string(place.path(csv)).expect("a table is written"))
    };
    let (_, one) = run("1", "one.csv");
    let (told, two) = run("2", "two.csv");
    assert_eq!(lasting(&one), lasting(&two));
    assert_eq!(one.lines().count(), 5, "{one}");
    for words in
        ["uniform 0.2", "adaptive 0.5", "noise", "elements the error is", "in theory", "written"]
    {
        assert!(told.contains(words), "{words} is not in {told}");
    }
    let json = std::fs::read_to_string(place.path("a.json")).expect("all figures are written");
    let json: serde_json::Value = serde_json::from_str(&json).expect("they are JSON");
    assert_eq!(json["runs"].as_array().map(Vec::len), Some(4));
    assert_eq!(json["runs"][0]["family"], "uniform");
    assert!(json["runs"][3]["score"]["all"]["rmse"].as_f64() < Some(0.2), "{json}");
    assert!(json["profile"][0]["reference"].as_array().map(Vec::len) > Some(60));
    let sentence = json["sentences"][0].as_str().expect("a sentence");
    assert!(told.contains(sentence), "{sentence} is not in {told}");
}

#[test]
fn a_reference_is_used_again() {
    let place = Place::new();
    let scene = scene("facing-squares.obj");
    // What an automatic reference may cost is nothing to one from a file.
    let (meshes, effort, accuracy) = (&QUICK[..4], &QUICK[4..8], &QUICK[8..]);
    let run = |reference: &[&str], more: &[&str]| {
        let fixed = ["compare", scene.as_str()];
        place.run(&[&fixed[..], meshes, accuracy, reference, more].concat())
    };
    run(effort, &["--save-reference", "truth.csv", "--csv", "a.csv", "-q"]).done();
    let again = run(&["--reference", "truth.csv"], &["--csv", "b.csv"]).done();
    assert!(again.stdout.contains("truth.csv"), "{}", again.stdout);
    let read = |name| std::fs::read_to_string(place.path(name)).expect("a table is written");
    assert_eq!(lasting(&read("a.csv")), lasting(&read("b.csv")));
}

#[test]
fn what_cannot_be_compared_is_refused_before_the_scene_is_read() {
    let place = Place::new();
    place.write("file", "");
    let run = |more: &[&str]| place.run(&[&["compare", "missing.obj"], more].concat());
    run(&["--csv", "a.txt"]).refused(2, &["a.txt", ".csv"]);
    run(&["--figures", "a.csv"]).refused(2, &["a.csv", ".json"]);
    run(&["--csv", "file/a.csv"]).refused(1, &["file/a.csv"]);
    run(&["--csv", "a.csv", "--save-reference", "a.csv"]).refused(1, &["a.csv", "twice"]);
    run(&["--budget", "0s"]).refused(2, &["2min"]);
    run(&["--adaptive", "2"]).refused(2, &["tolerance"]);
    run(&["--uniform", "0"]).refused(2, &["uniform"]);
    run(&["--reference", "missing.csv"]).refused(1, &["missing.obj"]);
}

#[test]
fn the_page_holds_the_verdict_and_all_it_rests_on() {
    let place = Place::new();
    let scene = scene("blocker.obj");
    let compare = ["compare", &scene, "-o", "deep/report.html"];
    let told = place.run(&[&compare[..], &QUICK].concat()).done().stdout;
    let page = std::fs::read_to_string(place.path("deep/report.html")).expect("a page is written");
    let verdict = told.lines().find(|line| line.contains("elements and")).expect("a verdict");
    assert!(page.contains(verdict), "{verdict}");
    for part in [
        "SHA-256",
        "radiosity compare",
        "Where they differ most",
        "Across a shadow",
        "Signed errors",
        "Convergence",
        "All runs",
        "The meshes",
        "Both meshes",
        "What to doubt",
        "What was compared",
        "id=\"comparison\"",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(page.contains("Signed errors of the close-up"));
    let headings = page.matches("<h2>").count();
    let contents = page.split("</nav>").next().expect("contents").split("href=\"#").skip(1);
    let anchors: Vec<&str> = contents.filter_map(|rest| rest.split('"').next()).collect();
    assert!(anchors.len() == headings && headings >= 8, "{anchors:?} for {headings} sections");
    for anchor in anchors {
        assert_eq!(page.matches(&format!("<section id=\"{anchor}\"><h2>")).count(), 1, "{anchor}");
    }
    assert!(!page.contains("http:") && !page.contains("https:"), "the page asks for nothing");
    assert!(page.len() < 8_000_000, "{} bytes", page.len());
}

/// By default, so good and no better.
#[test]
fn a_reference_resolves_the_errors_that_it_finds() {
    let place = Place::new();
    let scene = scene("cornell-box.obj");
    let asked = ["--adaptive", "50%,20%", "--uniform", "0.2,0.1", "--places", "300"];
    let quick = ["--quality", "draft", "--hemicube-resolution", "32", "--budget", "10min"];
    let compare = ["compare", &scene, "--json"];
    let outcome = place.run(&[&compare[..], &asked, &quick].concat()).done();
    let json = outcome.json();
    let runs = json["runs"].as_array().expect("a list");
    let errors = |run: &serde_json::Value, band: &str| {
        let of = |name: &str| run["score"][band][name].as_f64().expect("a number");
        (of("floor"), of("rmse"))
    };
    let bands = ["all", "shadow", "rest"];
    let pairs: Vec<(f64, f64)> =
        runs.iter().flat_map(|run| bands.map(|band| errors(run, band))).collect();
    assert_eq!(pairs.len(), 12);
    // By chance an error is wrong by floor² / 4 e, which is to be less than 5 %.
    let shares = || pairs.iter().map(|(floor, error)| floor * floor / (4.0 * error * error));
    assert!(shares().all(|share| share <= 0.05 + 1e-9), "{pairs:?}");
    let paths = json["reference"]["origin"]["traced"]["paths"].as_f64().expect("a number");
    let worst = shares().fold(0.0, f64::max);
    assert!(paths <= 512.0 || worst > 0.01, "{paths} paths, and only {worst}");
}

#[test]
fn the_sky_is_seen_in_the_pictures_of_a_page() {
    use base64::Engine as _;
    let place = Place::new();
    let scene = scene("facing-squares.obj");
    let compare = ["compare", &scene, "--sky", "uniform", "-o", "report.html"];
    place.run(&[&compare[..], &QUICK].concat()).done();
    let page = std::fs::read_to_string(place.path("report.html")).expect("a page is written");
    let coded = page.split("data:image/png;base64,").skip(1);
    let pictures = coded.map(|rest| {
        let bytes = base64::prelude::BASE64_STANDARD.decode(rest.split('"').next().unwrap_or(""));
        image::load_from_memory(&bytes.expect("base64")).expect("a picture").into_rgb8()
    });
    // Beside the squares, right above the horizon and below it.
    let is_seen = |picture: &image::RgbImage| {
        picture.dimensions() == (640, 480)
            && picture.get_pixel(20, 230).0[2] > 100
            && picture.get_pixel(20, 250).0[2] == 0
    };
    assert!(pictures.into_iter().filter(is_seen).count() >= 3, "uniform, adaptive, reference");
}
