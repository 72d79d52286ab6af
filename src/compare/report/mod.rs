//! A comparison as one page: the verdict first, then what it rests on.

mod account;
mod charts;
mod close_up;
mod errors;
mod notes;
mod pictures;
mod scoreboard;
mod tables;
mod truth;

use super::comparison::Comparison;
use super::record::figures;
use super::run::Lit;
use crate::page::{self, Markup, Model, Section, Step, Viewer, html};

pub use account::Account;
use pictures::{Gallery, Shown};
use truth::Truth;

/// A page that sets uniform and adaptive meshes side by side: verdict and contents, pictures, the place where they
/// differ most, the profile across a shadow's edge, errors, convergence, all runs, statistics of the meshes, both of
/// them in 3D, what there is to doubt, and what has been compared.
///
/// The runs to be shown must have kept their solutions; without both, there are figures only. Of a comparison that was
/// stopped there are no pictures, which would take long.
pub fn report(comparison: &Comparison, account: &Account<'_>) -> Markup {
    let shown = comparison.shown.and_then(|runs| Shown::new(comparison, runs));
    let mut parts = Vec::new();
    if let Some(shown) = shown.as_ref().filter(|_| !comparison.interrupted) {
        parts.extend(seen(comparison, shown, account));
    }
    parts.push(section("Convergence", charts::convergence(comparison)));
    parts.push(section("All runs", tables::runs(comparison)));
    let meshes = html! {
        @if let Some(shown) = &shown { (turned(comparison, shown, account)) }
        (tables::statistics(comparison))
    };
    parts.push(section(if shown.is_some() { "Both meshes" } else { "The meshes" }, meshes));
    parts.push(section("What to doubt", notes::notes(comparison, account.notes)));
    parts.push(section("What was compared", page::facts(account.identity)));
    let body = html! {
        h1 { (account.title) ": uniform or adaptive?" }
        (scoreboard::verdict(comparison))
        @if shown.is_none() { p { "Pictures need a run of each kind." } }
        @else if comparison.interrupted { p { "Pictures are left out, since they take long." } }
        (page::sections(&parts))
        (page::data("comparison", &figures(comparison, account.about)))
    };
    page::document(account.title, &body)
}

fn section(title: &'static str, body: Markup) -> Section<'static> {
    Section { title, body }
}

/// What eyes can judge: pictures, the place where they differ most, the profile, maps of errors.
fn seen(
    comparison: &Comparison,
    shown: &Shown<'_>,
    account: &Account<'_>,
) -> [Section<'static>; 4] {
    let gallery = Gallery::new(comparison, shown, account);
    let close_up = close_up::close_up_of(&gallery.errors, comparison, shown, account);
    [
        section("Pictures", gallery.pictures()),
        section("Where they differ most", close_up),
        section("Across a shadow's edge", charts::profile(comparison)),
        section("Errors", gallery.error_maps()),
    ]
}

/// Both meshes to turn, their cameras linked.
fn turned(comparison: &Comparison, shown: &Shown<'_>, account: &Account<'_>) -> Markup {
    let truth = (!comparison.interrupted).then(|| Truth::new(comparison, shown.lit[1]));
    let side = |which: usize| {
        let lit @ Lit { solution, mesh } = shown.lit[which];
        let mut model = Model::of_solution(mesh, &solution.mesh);
        if let Some(truth) = &truth {
            model = model.with_errors(&truth.errors_at_vertices(lit));
        }
        let label = shown.name(which);
        let steps = [Step { label: label.clone(), model }];
        page::viewer(&Viewer {
            steps: &steps,
            camera: account.camera,
            exposure: account.display.scale,
            group: "meshes",
            alt: &format!("The {label} mesh, to be turned"),
            caption: &label,
            still: None,
        })
    };
    html! {
        p {
            "They turn together."
            @if truth.is_some() {
                " Errors are those of interpolation: in the middle of the triangles around each vertex, against direct "
                "light evaluated there, as shares of the mean radiosity."
            }
        }
        (page::columns(&[side(0), side(1)]))
    }
}
