//! Every view shows something of its own, above a legend.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use glam::DVec3;
use radiosity::render::{Display, RenderOptions, Solved, Subject, View, render, render_solved};
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{TriMesh, reconstruct, surfaces_of};

use super::{camera_in_front, shown, small, square};
use crate::common::{Block, coarse, furnished_room, solve};

/// Rows of a legend that hold letters.
fn inked_rows(image: &image::RgbImage, top: u32) -> usize {
    let bright = |pixel: &image::Rgb<u8>| pixel.0.iter().all(|&channel| channel > 150);
    (top..image.height())
        .filter(|&y| (0..image.width()).any(|x| bright(image.get_pixel(x, y))))
        .count()
}

fn colours(image: &image::RgbImage, rows: std::ops::Range<u32>) -> BTreeSet<[u8; 3]> {
    rows.flat_map(|y| (0..image.width()).map(move |x| image.get_pixel(x, y).0)).collect()
}

#[test]
fn every_view_has_colours_of_its_own_and_a_legend() {
    let block = Block { base: DVec3::new(1.3, 0.0, 1.6), size: DVec3::splat(0.8), turn: 0.4 };
    let (surfaces, settings) = (surfaces_of(&furnished_room(&[block])), coarse());
    let solution = solve(&surfaces, &settings);
    let mesh = reconstruct(&surfaces, &solution);
    let solved = Solved { surfaces: &surfaces, settings: &settings, solution: &solution };
    let camera = radiosity::render::automatic_camera(&mesh, 4.0 / 3.0);
    let display = Display::exposed(exposure_scale(&mesh, Exposure::Automatic));
    let mut seen = BTreeSet::new();
    for view in View::ALL {
        let options = RenderOptions { view, ..small(160, 120) };
        let subject = Subject { mesh: &mesh, solved: Some(solved) };
        let picture = render_solved(subject, &camera, &options, |_| ControlFlow::Continue(()));
        let image = shown(&picture, &display);
        assert_eq!(image.width(), 160, "{view:?}");
        assert_eq!(image.height() > 120, view != View::Light, "{view:?}");
        assert!(view == View::Light || inked_rows(&image, 120) >= 8, "{view:?} has no legend");
        let own = colours(&image, 0..120);
        assert!(own.len() >= 4, "{view:?} has {} colours", own.len());
        assert!(seen.insert(image.into_raw()), "{view:?} looks like another view");
        if [View::Level, View::Reason].contains(&view) {
            let key = colours(&shown(&picture, &display), 120..shown(&picture, &display).height());
            assert!(key.intersection(&own).count() >= 2, "{view:?}: the key explains no colour");
        }
    }
}

#[test]
fn views_of_a_mesh_alone_show_nothing_that_it_does_not_carry() {
    let mesh: TriMesh = square(2, 1.0);
    for view in View::ALL {
        let options = RenderOptions { view, ..small(100, 100) };
        let picture = render(&mesh, &camera_in_front(5.0), &options);
        let is_dark = picture.values.iter().all(|value| value.max_element() == 0.0);
        assert_eq!(is_dark, view.needs_solution(), "{view:?}");
        shown(&picture, &Display::exposed(1.0));
    }
}

#[test]
fn narrow_pictures_break_their_legends_and_very_narrow_ones_have_none() {
    let mesh = square(2, 1.0);
    let height = |width| {
        let options = RenderOptions { view: View::Wireframe, ..small(width, 50) };
        let image = shown(&render(&mesh, &camera_in_front(5.0), &options), &Display::exposed(1.0));
        image.height()
    };
    assert!(height(100) > height(400) && height(400) > 50);
    assert_eq!(height(40), 50);
}
