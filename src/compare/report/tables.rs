//! All runs in figures, and what their meshes are made of.

use crate::compare::comparison::Comparison;
use crate::compare::run::{Family, Run};
use crate::compare::score::Band;
use crate::compare::sentences::percent;
use crate::page::{self, Cell, Markup, Table, html};

/// What runs cost and how good they are.
pub(super) fn runs(comparison: &Comparison) -> Markup {
    let header = [
        "mesh",
        "elements",
        "triangles",
        "s",
        "peak MB",
        "error, %",
        "shadow, %",
        "elsewhere, %",
        "95 %, %",
        "bias, %",
    ];
    html! {
        p {
            "Errors are root mean squares unless they say otherwise, as shares of the mean radiosity; the reference's "
            "own variance is taken off. Memory is what the run added to that in use before."
        }
        (page::table(&Table {
            caption: "",
            header: &header,
            rows: comparison.runs.iter().map(short_row).collect(),
            file: "runs.csv",
        }))
        (page::folded("Work, time by phase, and spread of errors", &details(comparison)))
    }
}

fn short_row(run: &Run) -> Vec<Cell> {
    let all = &run.score.all;
    let mut cells = vec![
        Cell::text(name(run)),
        Cell::count(run.elements),
        Cell::count(run.triangles),
        Cell::number(run.seconds.total(), 2),
        memory(run),
    ];
    cells.extend(Band::ALL.map(|band| error(run, band)));
    cells.extend([all.p95, all.bias].map(|share| Cell::number(100.0 * share, 2)));
    cells
}

/// Its family, and what that was told.
fn name(run: &Run) -> String {
    match run.family {
        Family::Uniform => format!("uniform {:.4} m", run.knob),
        Family::Adaptive => format!("adaptive {}", percent(run.knob)),
    }
}

fn memory(run: &Run) -> Cell {
    Cell::number(run.peak_memory.map_or(f64::NAN, |bytes| bytes as f64 / 1e6), 1)
}

/// All that was counted and measured of each run.
fn details(comparison: &Comparison) -> Markup {
    let header = [
        "mesh",
        "size, m, or tolerance",
        "elements",
        "triangles",
        "form factors",
        "hemicubes",
        "shadow rays",
        "shots",
        "s",
        "surfaces, s",
        "direct, s",
        "reflected, s",
        "gathering, s",
        "triangles, s",
        "peak MB",
        "energy missing, %",
        "error, %",
        "shadow, %",
        "elsewhere, %",
        "L1, %",
        "bias, %",
        "median, %",
        "95 %, %",
        "largest, %",
    ];
    page::table(&Table {
        caption: "",
        header: &header,
        rows: comparison.runs.iter().map(row).collect(),
        file: "details.csv",
    })
}

fn row(run: &Run) -> Vec<Cell> {
    let seconds = &run.seconds;
    let all = &run.score.all;
    let mut cells = vec![
        Cell::text(run.family.name()),
        Cell::number(run.knob, 4),
        Cell::count(run.elements),
        Cell::count(run.triangles),
        Cell::count(run.work.form_factors() as usize),
        Cell::count(run.hemicubes.iter().sum()),
        Cell::count(run.work.rays as usize),
        Cell::count(run.shots),
        Cell::number(seconds.total(), 2),
    ];
    let phases =
        [seconds.surfaces, seconds.direct, seconds.reflected, seconds.gathering, seconds.triangles];
    cells.extend(phases.map(|seconds| Cell::number(seconds, 2)));
    cells.extend([memory(run), Cell::number(100.0 * run.imbalance.abs(), 3)]);
    cells.extend(Band::ALL.map(|band| error(run, band)));
    let spread = [all.mean_absolute, all.bias, all.median, all.p95, all.max];
    cells.extend(spread.map(|share| Cell::number(100.0 * share, 2)));
    cells
}

/// A root mean square error; below its floor it only says so.
fn error(run: &Run, band: Band) -> Cell {
    let error = run.score.of(band).in_percent();
    error.map_or(Cell::Empty, |(value, shown)| Cell::Number { value, shown })
}

/// Sizes, levels, reasons, angles and hanging vertices.
pub(super) fn statistics(comparison: &Comparison) -> Markup {
    let runs = &comparison.runs;
    let reasons = page::table(&Table {
        caption: "Elements divided, by reason; triangles; and vertices that would have hung on an edge of a neighbour, \
                  had they not been made part of it",
        header: &[
            "mesh",
            "for uniformity",
            "gradient",
            "shadow edge",
            "discontinuity line",
            "contact",
            "smallest angle, °",
            "below 10°, %",
            "hanging, resolved",
        ],
        rows: runs.iter().map(reasons).collect(),
        file: "meshes.csv",
    });
    html! {
        (page::folded("The meshes: why elements were divided, and how slender triangles are", &reasons))
        (page::folded("The meshes: elements by level and by size", &page::columns(&[levels(runs), sizes(runs)])))
    }
}

fn reasons(run: &Run) -> Vec<Cell> {
    let divided = &run.divided;
    let counts = [
        divided.uniform,
        divided.gradient,
        divided.shadow_edge,
        divided.discontinuity,
        divided.contact,
    ];
    let mut cells = vec![Cell::text(name(run))];
    cells.extend(counts.map(Cell::count));
    cells.push(Cell::number(run.angles.smallest, 2));
    cells.push(Cell::number(100.0 * run.angles.below_ten, 1));
    cells.push(Cell::count(run.hanging));
    cells
}

fn levels(runs: &[Run]) -> Markup {
    let deepest = runs.iter().map(|run| run.levels.len()).max().unwrap_or(0);
    let names: Vec<String> = (0..deepest).map(|level| level.to_string()).collect();
    let count = |run: &Run, level: usize| run.levels.get(level).copied().unwrap_or(0);
    histogram("Elements by level: how often their patch was divided", &names, runs, count)
}

fn sizes(runs: &[Run]) -> Markup {
    let bins = || runs.iter().flat_map(|run| &run.sizes);
    let octave = |from: f64| from.log2().round() as i32;
    let least = bins().map(|bin| octave(bin.from)).min().unwrap_or(0);
    let most = bins().map(|bin| octave(bin.from)).max().unwrap_or(-1);
    let names: Vec<String> =
        (least..=most).map(|k| format!("{:.4}", f64::from(k).exp2())).collect();
    let count = |run: &Run, column: usize| {
        let is = |from: f64| octave(from) == least + column as i32;
        run.sizes.iter().filter(|bin| is(bin.from)).map(|bin| bin.leaves).sum()
    };
    histogram(
        "Elements by size, the root of their area: from so many metres to twice that",
        &names,
        runs,
        count,
    )
}

fn histogram(
    caption: &str,
    names: &[String],
    runs: &[Run],
    count: impl Fn(&Run, usize) -> usize,
) -> Markup {
    let header: Vec<&str> = ["mesh"].into_iter().chain(names.iter().map(String::as_str)).collect();
    let row = |run: &Run| {
        let counts = (0..names.len()).map(|k| Cell::count(count(run, k)));
        [Cell::text(name(run))].into_iter().chain(counts).collect()
    };
    let rows = runs.iter().map(row).collect();
    page::table(&Table { caption, header: &header, rows, file: "histogram.csv" })
}
