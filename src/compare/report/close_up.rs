//! The place at which the errors of the two meshes differ most, seen from near by.

use std::f64::consts::PI;

use super::account::Account;
use super::errors::{ErrorMap, ErrorScale};
use super::pictures::{PictureSetup, SIZE, Shown};
use crate::colour::luminance;
use crate::compare::comparison::Comparison;
use crate::page::{self, Markup, html};
use crate::render::{Display, Picture, close_up, png};

/// Pixels of close-ups.
const CLOSE_SIZE: [u32; 2] = [400, 300];

/// How much closer a close-up is; it shows the part of a picture that a block of this kind covers.
const ZOOM: u32 = 6;

/// Share of a close-up's pixels that are darker than its white.
const WHITE: f64 = 0.98;

/// Reference, uniform and adaptive where their errors differ most, and below the meshes what they have too much.
pub(super) fn close_up_of(
    errors: &[ErrorMap; 2],
    comparison: &Comparison,
    shown: &Shown<'_>,
    account: &Account<'_>,
) -> Markup {
    let Some(place) = place_of_most_difference(errors) else {
        return html! { p { "Nowhere: both pictures are the reference's." } };
    };
    let camera = close_up(account.camera, SIZE, place, f64::from(ZOOM));
    let pictures = shown.all(comparison, &PictureSetup::new(&camera, CLOSE_SIZE));
    let [uniform, adaptive, reference] = &pictures;
    let maps = [uniform, adaptive].map(|picture| ErrorMap::new(picture, reference, shown.mean()));
    let scale = ErrorScale::of(&maps);
    let display = Display::exposed(exposure(reference).unwrap_or(account.display.scale));
    let light = |picture: &Picture, name: &str| {
        page::picture(&png(picture, &display), &format!("Close-up: {name}"), name)
    };
    let error = |k: usize| {
        let name = shown.name(k);
        let alt = format!("Signed errors of the close-up: {name}");
        page::picture(
            &maps[k].signed_png(&scale),
            &alt,
            &format!("its errors, all within {}", maps[k].largest()),
        )
    };
    html! {
        p {
            "The part of the picture, one in " (ZOOM * ZOOM) ", in which the sums of the squared errors of the two "
            "meshes are farthest apart, exposed by itself."
        }
        (page::pairs(&[
            [light(reference, "reference"), scale.legend()],
            [light(uniform, &shown.name(0)), error(0)],
            [light(adaptive, &shown.name(1)), error(1)],
        ]))
    }
}

/// The factor on radiosity, m²/W, at which nearly all of a picture is darker than white; `None` in the dark.
fn exposure(picture: &Picture) -> Option<f64> {
    let mut light: Vec<f64> =
        picture.values.iter().map(|value| PI * luminance(value.as_dvec3())).collect();
    light.sort_by(f64::total_cmp);
    let white = light.get((WHITE * light.len() as f64) as usize).copied()?;
    (white > 0.0).then(|| 1.0 / white)
}

/// The middle, in pixels, of the block in which the sums of the squares of both maps' errors are farthest apart;
/// `None` if there are no errors.
fn place_of_most_difference(errors: &[ErrorMap; 2]) -> Option<[f64; 2]> {
    let block = [SIZE[0] / ZOOM, SIZE[1] / ZOOM];
    // Blocks overlap by half.
    let starts = |axis: usize| 0..=(SIZE[axis] - block[axis]) / (block[axis] / 2);
    let corner = |k: u32, axis: usize| k * block[axis] / 2;
    let difference = |at: [u32; 2]| {
        let [uniform, adaptive] = errors.each_ref().map(|map| map.sum(at, block));
        (uniform - adaptive).abs()
    };
    let blocks = starts(1)
        .flat_map(|row| starts(0).map(move |column| [corner(column, 0), corner(row, 1)]))
        .map(|at| (difference(at), at));
    // Of equal ones the first.
    let most = blocks.reduce(|most, next| if next.0 > most.0 { next } else { most });
    let middle = |at: [u32; 2]| [0, 1].map(|k| f64::from(at[k]) + f64::from(block[k]) / 2.0);
    most.filter(|(difference, _)| *difference > 0.0).map(|(_, at)| middle(at))
}
