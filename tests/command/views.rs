//! `--view` and `--final-gather`.

use std::collections::BTreeSet;

use crate::{Place, scene};

const VIEWS: [&str; 9] = [
    "light",
    "wireframe",
    "radiosity",
    "direct",
    "indirect",
    "illuminance",
    "level",
    "reason",
    "error",
];

const QUICK: [&str; 8] =
    ["--quality", "draft", "--max-level", "2", "--hemicube-resolution", "32", "--size", "160x120"];

fn picture(place: &Place, name: &str) -> image::RgbImage {
    image::open(place.path(name)).expect("the picture was written").into_rgb8()
}

#[test]
fn one_solution_gives_every_view_a_picture_with_its_legend() {
    let place = Place::new();
    let names: Vec<String> = VIEWS.iter().map(|view| format!("{view}.png")).collect();
    let images: Vec<&str> = names.iter().flat_map(|name| ["--image", name.as_str()]).collect();
    let (scene, views) = (scene("cornell-box.glb"), VIEWS.join(","));
    let solve = ["solve", scene.as_str(), "--view", &views, "--final-gather"];
    place.run(&[&solve[..], &QUICK, &images].concat()).done();
    let mut seen = BTreeSet::new();
    for (view, name) in VIEWS.iter().zip(&names) {
        let image = picture(&place, name);
        let legend = (120..image.height()).flat_map(|y| (0..160).map(move |x| (x, y)));
        let inked = legend.filter(|&(x, y)| image.get_pixel(x, y).0.iter().all(|&c| c > 150));
        let inked = inked.count();
        assert!(*view == "light" || inked > 60, "{view}: {inked} pixels of letters");
        assert_eq!(image.height() == 120, *view == "light", "{view}");
        let above = (0..120).flat_map(|y| (0..160).map(move |x| (x, y)));
        let colours: BTreeSet<_> = above.map(|(x, y)| image.get_pixel(x, y).0).collect();
        assert!(colours.len() > 5, "{view}: {} colours", colours.len());
        assert!(seen.insert(image.into_raw()), "{view} looks like another");
    }
}

#[test]
fn views_and_pictures_go_together() {
    let place = Place::new();
    let images = ["--image", "a.png", "--image", "b.png"];
    let solve = |more: &[&str]| place.solve(&[more, &images[..], &["--size", "40x30"]].concat());
    solve(&["--view", "light,direct,error"]).refused(2, &["3 views for 2 pictures"]);
    solve(&["--view", "heat"]).refused(2, &["heat", "wireframe"]);
    solve(&["--view", "direct"]).done();
    assert_eq!(picture(&place, "a.png"), picture(&place, "b.png"));
}

#[test]
fn a_solved_glb_refuses_what_it_does_not_hold_and_says_who_does() {
    let place = Place::new();
    place.solve(&["-o", "a.glb"]).done();
    let render = |more: &[&str]| place.run(&[&["render", "a.glb", "-o", "a.png"], more].concat());
    render(&["--final-gather"]).refused(2, &["final-gather", "radiosity solve"]);
    for view in &VIEWS[3..] {
        render(&["--view", view]).refused(2, &[view, "radiosity solve"]);
    }
    assert!(!place.path("a.png").exists());
    render(&["-o", "b.png", "--view", "light,wireframe"]).done();
    assert_ne!(picture(&place, "a.png"), picture(&place, "b.png"));
}
