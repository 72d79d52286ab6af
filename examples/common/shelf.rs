//! A shelf that is endless to both sides: top A and bottom C face each other, B is the back, the
//! front is open.

use glam::DVec2;
use radiosity::colour::Rgb;
use radiosity::form_factor::FormFactors;
use radiosity::solver::relaxation::System;

/// Height of the shelf over its depth.
const HEIGHT: f64 = 1.732_050_807_568_877_2;

/// A choice of reflectances and exitances, and the radiosities of A, B and C.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub(crate) reflectance: [f64; 3],
    pub(crate) exitance: [f64; 3],
    /// As the lecture prints them.
    pub(crate) printed: [f64; 3],
}

/// The four rows of the lecture. Two numbers in them are slips: 0.21133 for 0.21132 (0.211325 rounded
/// twice), and 0.02906 for 1.02906.
pub(crate) const ROWS: [Row; 4] = [
    Row {
        reflectance: [0.0, 1.0 / 2.0, 1.0 / 3.0],
        exitance: [1.0, 0.0, 0.0],
        printed: [1.0, 0.11660, 0.10354],
    },
    Row {
        reflectance: [1.0 / 10.0, 1.0 / 2.0, 1.0 / 3.0],
        exitance: [1.0, 0.0, 0.0],
        printed: [1.00709, 0.11743, 0.10428],
    },
    Row {
        reflectance: [1.0 / 2.0, 0.0, 1.0 / 2.0],
        exitance: [0.0, 1.0, 0.0],
        printed: [0.21133, 1.0, 0.21133],
    },
    Row {
        reflectance: [1.0 / 10.0, 1.0 / 10.0, 1.0 / 2.0],
        exitance: [1.0, 1.0, 0.0],
        printed: [1.04647, 0.02906, 0.32853],
    },
];

impl Row {
    /// The shelf with these materials.
    pub(crate) fn system(&self) -> radiosity::Result<System> {
        let grey = |values: [f64; 3]| values.map(Rgb::splat).to_vec();
        System::new(form_factors(), grey(self.reflectance), grey(self.exitance))
    }
}

/// Form factors between A, B and C; areas are those of one metre of the shelf.
pub(crate) fn form_factors() -> FormFactors {
    let at = DVec2::new;
    let strips = [
        [at(1.0, HEIGHT), at(0.0, HEIGHT)],
        [at(0.0, HEIGHT), at(0.0, 0.0)],
        [at(0.0, 0.0), at(1.0, 0.0)],
    ];
    let areas = strips.map(|[start, end]| start.distance(end)).to_vec();
    let row = |from: usize| {
        let others = (0..3).filter(move |&to| to != from);
        others.map(move |to| (to as u32, crossed_strings(strips[from], strips[to])))
    };
    FormFactors::from_rows(areas, (0..3).map(row))
}

/// Form factor between two endless strips, given by their cross-sections, that see all of each other.
///
/// The crossed strings between their ends less the uncrossed ones, over twice the width of the
/// first ([Hottel 1954]); exact.
///
/// [Hottel 1954]: https://en.wikipedia.org/wiki/View_factor#Hottel's_crossed_string_rule
fn crossed_strings([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> f64 {
    let (along, across) = (a.distance(c) + b.distance(d), a.distance(d) + b.distance(c));
    (along - across).abs() / (2.0 * a.distance(b))
}
