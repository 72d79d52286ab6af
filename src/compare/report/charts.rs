//! Curves: errors against what they cost, and radiosity across the edge of a shadow.

use crate::compare::comparison::Comparison;
use crate::compare::run::{Family, Run};
use crate::compare::sentences::{capital, laws, percent};
use crate::compare::verdict::{BandVerdict, Cost, nearest_law};
use crate::page::{self, Axis, Board, BoardRow, CURVE_COLOURS, Curve, Markup, Plot, Stroke, html};

const GREY: [u8; 3] = CURVE_COLOURS[2];
const BLACK: [u8; 3] = [0; 3];

const MARKS: [Stroke; 2] = [Stroke::Squares, Stroke::Circles];

/// Errors against elements, seconds and form factors: for all surfaces, the shadow band, and elsewhere.
pub(super) fn convergence(comparison: &Comparison) -> Markup {
    let row = |cost: Cost| {
        let charts = comparison.verdict.bands.iter().map(|verdict| {
            html! {
                h4 { (capital(verdict.band.name())) }
                (curves(comparison, verdict, cost))
            }
        });
        page::strip(&charts.collect::<Vec<_>>())
    };
    html! {
        p {
            "Root mean square error, as a share of the mean radiosity, against what it cost; both scales are "
            "logarithmic. Below the floor the reference does not resolve errors."
        }
        h3 { "Against elements" }
        (row(Cost::Elements))
        (slopes(comparison))
        h3 { "Against time" }
        (row(Cost::Seconds))
        (page::folded("Against evaluations of form factors", &row(Cost::FormFactors)))
    }
}

fn curves(comparison: &Comparison, verdict: &BandVerdict, cost: Cost) -> Markup {
    let band = verdict.band;
    let point = |run: &Run| (cost.of(run), 100.0 * run.score.of(band).rmse);
    let of = |family: Family| comparison.runs.iter().filter(move |run| run.family == family);
    let mut curves: Vec<Curve> = Vec::new();
    let costs = || comparison.runs.iter().map(|run| cost.of(run));
    let (low, high) = (costs().fold(f64::INFINITY, f64::min), costs().fold(0.0, f64::max));
    for (k, family) in Family::ALL.into_iter().enumerate() {
        let points = of(family).map(point).collect();
        curves.push(curve(family.name(), CURVE_COLOURS[k], MARKS[k], points));
    }
    if verdict.floor > 0.0 {
        let floor = 100.0 * verdict.floor;
        curves.push(curve("floor", GREY, Stroke::Dashed, vec![(low, floor), (high, floor)]));
    }
    let across = match cost {
        Cost::Elements => "elements",
        Cost::Seconds => "seconds",
        Cost::FormFactors => "evaluations of form factors",
    };
    let plot = Plot {
        size: [360, 280],
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
fn slopes(comparison: &Comparison) -> Markup {
    let fitted = |slope: Option<f64>| {
        slope.map_or("cannot be told".to_owned(), |slope| {
            format!("{slope:.2}, like {}", nearest_law(slope).1)
        })
    };
    let row = |verdict: &BandVerdict| BoardRow {
        name: capital(verdict.band.name()),
        cells: verdict.slopes.fitted.map(fitted).to_vec(),
    };
    page::board(&Board {
        caption: &format!("Slope of error against elements, fitted; in theory {}", laws()),
        header: &["uniform", "adaptive"],
        rows: comparison.verdict.bands.iter().map(row).collect(),
    })
}

/// Radiosity along a line across the edge of a shadow, with the edges of elements that it crosses.
pub(super) fn profile(comparison: &Comparison) -> Markup {
    let Some((profile, traces)) = &comparison.profile else {
        return html! { p { "No shadow has a soft edge on a large surface." } };
    };
    let at = |values: &mut dyn Iterator<Item = Option<f64>>| -> Vec<(f64, f64)> {
        profile.at.iter().zip(values).filter_map(|(&x, y)| Some((x, y?))).collect()
    };
    let truth = at(&mut profile.reference.iter().copied().map(Some));
    let mut curves = vec![curve("reference", BLACK, Stroke::Line, truth)];
    for (k, (family, trace)) in Family::ALL.into_iter().zip(traces).enumerate() {
        let values = at(&mut trace.values.iter().copied());
        curves.push(curve(family.name(), CURVE_COLOURS[k], Stroke::Line, values));
        let ticks = trace.ticks.iter().map(|&tick| (tick, 0.0)).collect();
        curves.push(curve("", CURVE_COLOURS[k], Stroke::Ticks(k as u8), ticks));
    }
    let plot = Plot {
        size: [480, 320],
        across: Axis { name: "place along the line, m", logarithmic: false },
        up: Axis { name: "radiosity, W/m²", logarithmic: false },
        curves,
    };
    let [from, to] = profile.ends.map(|end| end.map(|x| format!("{x:.3}")).join(", "));
    let worst = profile.error.iter().copied().fold(0.0, f64::max);
    let top = profile.reference.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let alt = "Radiosity across the edge of a shadow: reference, uniform and adaptive";
    html! {
        p {
            "Luminance of the radiosity from (" (from) ") to (" (to) ") m, across a penumbra of "
            (format!("{:.3}", profile.penumbra)) " m. The ticks below are where edges of elements cross the line. The "
            "reference's standard error is at most " (percent(worst / top)) " of the brightest place."
        }
        (page::plot(&plot, alt))
    }
}

fn curve(name: &str, colour: [u8; 3], stroke: Stroke, points: Vec<(f64, f64)>) -> Curve {
    Curve { name: name.to_owned(), colour, stroke, points }
}
