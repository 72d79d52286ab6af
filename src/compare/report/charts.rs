//! Curves: errors against what they cost, and radiosity across the edge of a shadow.

use crate::compare::comparison::Comparison;
use crate::compare::run::{Family, Run};
use crate::compare::sentences::{laws, percent};
use crate::compare::verdict::{BandVerdict, Cost, nearest_law};
use crate::page::{self, Axis, Curve, Markup, Plot, Stroke, html};

/// sRGB-coded: uniform, adaptive, and the truth; told apart by the colour-blind, and by their marks.
const COLOURS: [[u8; 3]; 2] = [[213, 94, 0], [0, 114, 178]];
const BLACK: [u8; 3] = [0; 3];
const GREY: [u8; 3] = [120; 3];

const MARKS: [Stroke; 2] = [Stroke::Squares, Stroke::Circles];

/// Errors against elements, seconds and form factors: for all surfaces, the shadow band, and elsewhere.
pub(super) fn convergence(comparison: &Comparison) -> Markup {
    html! {
        h2 { "Convergence" }
        p {
            "Root mean square error, as a share of the mean radiosity, against what it cost; both scales are "
            "logarithmic. Below the grey line the reference does not resolve errors."
        }
        @for verdict in &comparison.verdict.bands {
            h3 { (capital(verdict.band.name())) }
            (page::thirds(&Cost::ALL.map(|cost| curves(comparison, verdict, cost))))
            p { (slopes(verdict)) }
        }
    }
}

fn curves(comparison: &Comparison, verdict: &BandVerdict, cost: Cost) -> Markup {
    let band = verdict.band;
    let point = |run: &Run| (cost.of(run), 100.0 * run.score.of(band).rmse);
    let of = |family: Family| comparison.runs.iter().filter(move |run| run.family == family);
    let mut curves: Vec<Curve> = Vec::new();
    let costs = || comparison.runs.iter().map(|run| cost.of(run));
    let (low, high) = (costs().fold(f64::INFINITY, f64::min), costs().fold(0.0, f64::max));
    if verdict.floor > 0.0 {
        let floor = 100.0 * verdict.floor;
        let points = vec![(low, floor), (high, floor)];
        curves.push(curve("not resolved below", GREY, Stroke::Dashed, points));
    }
    for (k, family) in Family::ALL.into_iter().enumerate() {
        curves.push(curve(family.name(), COLOURS[k], MARKS[k], of(family).map(point).collect()));
    }
    let across = match cost {
        Cost::Elements => "elements",
        Cost::Seconds => "seconds",
        Cost::FormFactors => "evaluations of form factors",
    };
    let plot = Plot {
        size: [420, 320],
        across: Axis { name: across, logarithmic: true },
        up: Axis { name: "error, %", logarithmic: true },
        curves,
    };
    page::plot(
        &plot,
        &format!("Errors against {across}, {}: {}", band.name(), verdict.sentences()[0]),
    )
}

/// How fast errors fall, beside what theory says.
fn slopes(verdict: &BandVerdict) -> String {
    let fitted = |k: usize| {
        verdict.slopes.fitted[k].map_or("cannot be told".to_owned(), |slope| {
            format!("{slope:.2}, nearest to that of {}", nearest_law(slope).1)
        })
    };
    format!(
        "Fitted slope against elements: uniform {}; adaptive {}. In theory: {}.",
        fitted(0),
        fitted(1),
        laws()
    )
}

/// Radiosity along a line across the edge of a shadow, with the edges of elements that it crosses.
pub(super) fn profile(comparison: &Comparison) -> Markup {
    let Some((profile, traces)) = &comparison.profile else {
        return html! { h2 { "Across a shadow's edge" } p { "No shadow has a soft edge on a large surface." } };
    };
    let at = |values: &mut dyn Iterator<Item = Option<f64>>| -> Vec<(f64, f64)> {
        profile.at.iter().zip(values).filter_map(|(&x, y)| Some((x, y?))).collect()
    };
    let truth = at(&mut profile.reference.iter().copied().map(Some));
    let mut curves = vec![curve("reference", BLACK, Stroke::Line, truth)];
    for (k, (family, trace)) in Family::ALL.into_iter().zip(traces).enumerate() {
        let values = at(&mut trace.values.iter().copied());
        curves.push(curve(family.name(), COLOURS[k], Stroke::Line, values));
        let ticks = trace.ticks.iter().map(|&tick| (tick, 0.0)).collect();
        curves.push(curve("", COLOURS[k], Stroke::Ticks(k as u8), ticks));
    }
    let plot = Plot {
        size: [840, 400],
        across: Axis { name: "place along the line, m", logarithmic: false },
        up: Axis { name: "radiosity (luminance), W/m²", logarithmic: false },
        curves,
    };
    let [from, to] = profile.ends.map(|end| end.map(|x| format!("{x:.3}")).join(", "));
    let worst = profile.error.iter().copied().fold(0.0, f64::max);
    let top = profile.reference.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let alt = "Radiosity across the edge of a shadow: reference, uniform and adaptive";
    html! {
        h2 { "Across a shadow's edge" }
        (page::plot(&plot, alt))
        p {
            "From (" (from) ") to (" (to) ") m, across a penumbra of " (format!("{:.3}", profile.penumbra))
            " m. The ticks below are where edges of elements cross the line. The reference's standard error is at "
            "most " (percent(worst / top)) " of the brightest place."
        }
    }
}

fn curve(name: &str, colour: [u8; 3], stroke: Stroke, points: Vec<(f64, f64)>) -> Curve {
    Curve { name: name.to_owned(), colour, stroke, points }
}

fn capital(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
