//! `--html` and `--snapshots`.

use serde_json::Value;

use crate::Place;

fn text(place: &Place, name: &str) -> String {
    std::fs::read_to_string(place.path(name)).expect("the page was written")
}

fn labels(page: &str) -> Vec<String> {
    let (_, rest) = page.split_once("<script type=\"application/json\">").expect("a viewer");
    let json = rest.split_once("</script>").expect("its data end").0;
    let record: Value = serde_json::from_str(json).expect("they are JSON");
    let steps = record["steps"].as_array().expect("a list of steps");
    steps.iter().filter_map(|step| step["label"].as_str()).map(str::to_owned).collect()
}

#[test]
fn a_page_tells_of_the_solution() {
    let place = Place::new();
    let outcome = place.solve(&["--html", "deep/a.html", "--size", "40x30", "--json"]).done();
    let page = text(&place, "deep/a.html");
    let json = outcome.json();
    assert_eq!(json["written"][0], "deep/a.html");
    let triangles = json["triangles"].to_string();
    for part in ["<h1>cornell-box</h1>", &triangles, "direct light", "absorbed", "data:image/png"] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(labels(&page), ["end: converged"]);
    assert!(page.len() < 500_000, "{}", page.len());
}

#[test]
fn snapshots_come_before_the_end_and_none_after_it() {
    let place = Place::new();
    let options = ["--html", "a.html", "--size", "40x30", "--snapshots", "3,1,3,1000000"];
    place.solve(&options).done();
    assert_eq!(labels(&text(&place, "a.html")), ["1 shot", "3 shots", "end: converged"]);
}

#[test]
fn pages_that_cannot_be_are_refused_before_the_work() {
    let place = Place::new();
    place.solve(&["--html", "a.pdf"]).refused(2, &["a.pdf", ".html"]);
    place.solve(&["--snapshots", "1"]).refused(2, &["--html"]);
    place.solve(&["--html", "a.html", "--snapshots", "0"]).refused(2, &["0"]);
    assert!(!place.path("a.html").exists());
}
