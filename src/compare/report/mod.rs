//! A comparison as one page: the verdict first, then what it rests on.

mod account;
mod charts;
mod errors;
mod notes;
mod pictures;
mod tables;

use super::comparison::Comparison;
use super::record::figures;
use super::run::Lit;
use crate::page::{self, Markup, Model, Step, Viewer, html};

pub use account::Account;
use errors::Truth;
use pictures::{Gallery, Shown};

/// A page that sets uniform and adaptive meshes side by side: verdict, pictures, the profile across a
/// shadow's edge, errors, convergence, all runs, statistics of the meshes, both of them in 3D, and
/// what there is to doubt.
///
/// The runs to be shown must have kept their solutions; without both, there are figures only.
pub fn report(comparison: &Comparison, account: &Account<'_>) -> Markup {
    let shown = comparison.shown.and_then(|runs| Shown::new(comparison, runs));
    let body = html! {
        h1 { (account.title) ": uniform or adaptive?" }
        @for sentence in comparison.verdict.sentences() { p.verdict { (sentence) } }
        (page::facts(account.identity))
        @if let Some(shown) = &shown { (seen(comparison, shown, account)) }
        @else { p { "Pictures need a run of each kind." } }
        (charts::convergence(comparison))
        (tables::runs(comparison))
        (tables::statistics(comparison))
        @if let Some(shown) = &shown { (turned(comparison, shown, account)) }
        (notes::notes(comparison, account.notes))
        (page::data("comparison", &figures(comparison, account.about)))
    };
    page::document(account.title, &body)
}

/// What eyes can judge: pictures, close-ups, the profile, maps of errors.
fn seen(comparison: &Comparison, shown: &Shown<'_>, account: &Account<'_>) -> Markup {
    let gallery = Gallery::new(comparison, shown, account);
    html! {
        (gallery.pictures())
        (gallery.close_ups(comparison, shown, account))
        (charts::profile(comparison))
        (gallery.error_maps())
    }
}

/// Both meshes to turn, their cameras linked.
fn turned(comparison: &Comparison, shown: &Shown<'_>, account: &Account<'_>) -> Markup {
    let truth = Truth::new(comparison, shown.lit[1]);
    let side = |which: usize| {
        let Lit { solution, mesh } = shown.lit[which];
        let model = Model::of_solution(mesh, &solution.mesh)
            .with_errors(&truth.errors_at_vertices(shown.lit[which]));
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
        h2 { "Both meshes" }
        p {
            "They turn together. Errors are those of interpolation: in the middle of the triangles around each "
            "vertex, against direct light evaluated there, as shares of the mean radiosity."
        }
        (page::columns(&[side(0), side(1)]))
    }
}
