//! What there is to doubt.

use crate::compare::comparison::Comparison;
use crate::compare::reference::{Origin, Set};
use crate::compare::run::{Family, Run};
use crate::compare::score::Band;
use crate::compare::sentences::{number, percent};
use crate::compare::verdict::{Cost, Winner};
use crate::page::{Markup, html};

/// What the reference is and how sure, where adaptive lost, and what went wrong.
pub(super) fn notes(comparison: &Comparison, of_scene: &[String]) -> Markup {
    let warnings = warnings(comparison);
    html! {
        p { (reference(comparison)) }
        p { (losses(comparison)) }
        p { (effectivity(comparison)) }
        @if warnings.is_empty() { p { "Every run converged, and no power was lost." } }
        @else { ul { @for warning in &warnings { li { (warning) } } } }
        @if !of_scene.is_empty() {
            p { "When the scene was read:" }
            ul { @for note in of_scene { li { (note) } } }
        }
    }
}

fn reference(comparison: &Comparison) -> String {
    let reference = &comparison.reference;
    let [area, shadow] = [Set::Area, Set::Shadow].map(|set| reference.count(set));
    let origin = match &reference.origin {
        Origin::Traced { rounds, paths, seconds } => format!(
            "direct light by an exact formula, reflected light by {} paths from each place in {rounds} independent \
             rounds ({seconds:.0} s); no mesh had a part in it",
            number(*paths as f64)
        ),
        Origin::File(path) => format!("read from {}", path.display()),
    };
    let [of_area, of_shadow] = [Set::Area, Set::Shadow].map(|set| percent(reference.noise(set)));
    let floor = |band: Band| comparison.verdict.of(band).map_or(0.0, |verdict| verdict.floor);
    let [all, edges] = [Band::All, Band::Shadow].map(|band| percent(floor(band)));
    format!(
        "The reference is the radiosity at {area} places spread by area and {shadow} along the edges of shadows: \
         {origin}. Its standard error is {of_area} and {of_shadow} of the mean; that is taken off the errors, which \
         below {all} and {edges} are not resolved. Pictures and maps of errors have another \
         reference, the finest adaptive solution with exact direct light: they say nothing about errors of reflected \
         light."
    )
}

/// Where uniform meshes did better.
fn losses(comparison: &Comparison) -> String {
    let mut lost = Vec::new();
    for verdict in &comparison.verdict.bands {
        let name = verdict.band.name();
        for at in &verdict.at_equal_error {
            if at.winner() == Winner::One(Family::Uniform) {
                lost.push(format!("in {} at equal error ({name})", cost(at.cost)));
            }
        }
        for at in &verdict.at_equal_cost {
            if at.winner(verdict.floor) == Winner::One(Family::Uniform) {
                lost.push(format!("in error at equal {} ({name})", cost(at.cost)));
            }
        }
    }
    let nearer = nearer(comparison).map_or(String::new(), |share| {
        format!(
            " At {} of the reference's places the uniform mesh that is shown is nearer to it.",
            percent(share)
        )
    });
    match lost.is_empty() {
        true => format!("Adaptive lost nowhere by more than a tenth.{nearer}"),
        false => format!("Adaptive lost {}.{nearer}", lost.join(", ")),
    }
}

fn cost(cost: Cost) -> &'static str {
    match cost {
        Cost::Elements => "elements",
        Cost::Seconds => "time",
        Cost::FormFactors => "form factors",
    }
}

/// Share of the places at which the first of the runs that are shown is nearer to the reference.
fn nearer(comparison: &Comparison) -> Option<f64> {
    let [uniform, adaptive] = comparison.shown?.map(|run| &comparison.runs[run].score.signed);
    let pairs = uniform.iter().zip(adaptive);
    let count = pairs.filter(|(u, a)| u.length_squared() < a.length_squared()).count();
    (!uniform.is_empty()).then(|| count as f64 / uniform.len() as f64)
}

/// The error that came of each tolerance.
fn effectivity(comparison: &Comparison) -> String {
    let adaptive = comparison.runs.iter().filter(|run| run.family == Family::Adaptive);
    let pair = |run: &Run| format!("{} gave {}", percent(run.knob), percent(run.score.all.rmse));
    let pairs: Vec<String> = adaptive.map(pair).collect();
    format!(
        "A tolerance bounds errors of interpolation within elements, each by its size and light, not the error over \
         all: {}.",
        pairs.join(", ")
    )
}

fn warnings(comparison: &Comparison) -> Vec<String> {
    let mut warnings = Vec::new();
    warnings.extend(comparison.stopped());
    for run in &comparison.runs {
        let name = format!("{} {}", run.family.name(), run.knob);
        if !run.converged {
            warnings.push(format!("{name} did not converge."));
        }
        if run.imbalance.abs() > 0.005 {
            warnings
                .push(format!("{name} has lost {} of the power.", percent(run.imbalance.abs())));
        }
        if run.score.unmatched > 0 {
            warnings.push(format!(
                "{name}: {} places of the reference are on no triangle and count as black.",
                run.score.unmatched
            ));
        }
    }
    warnings
}
