//! A comparison as a table, and what it comes to.

use std::path::{Path, PathBuf};

use radiosity::compare::{
    Band, Comparison, Family, Origin, Run, Set, laws, nearest_law, number, percent,
};

/// The runs, the reference, the slopes and the verdict, for people.
pub(crate) fn table(scene: &Path, comparison: &Comparison, written: &[PathBuf]) -> String {
    let mut lines = vec![format!("{}", scene.display())];
    lines.push(header());
    lines.extend(comparison.runs.iter().map(row));
    lines.push(String::new());
    lines.push(reference(comparison));
    lines.extend(slopes(comparison));
    lines.extend(comparison.stopped());
    lines.push(String::new());
    lines.extend(comparison.verdict.sentences().into_iter().filter(|line| !line.is_empty()));
    let written: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
    if !written.is_empty() {
        lines.push(format!("\nwritten    {}", written.join(", ")));
    }
    lines.join("\n")
}

/// Width of the first column.
const NAME: usize = 18;

fn header() -> String {
    format!(
        "{:<NAME$}{:>9}{:>10}{:>13}{:>8}{:>8}{:>9}{:>9}{:>11}{:>8}{:>8}",
        "",
        "elements",
        "triangles",
        "form factors",
        "s",
        "MB",
        "error %",
        "shadow %",
        "elsewhere %",
        "95 %",
        "bias %"
    )
}

fn row(run: &Run) -> String {
    let name = match run.family {
        Family::Uniform => format!("uniform {:.4} m", run.knob),
        Family::Adaptive => format!("adaptive {}", run.knob),
    };
    let memory = run.peak_memory.map_or("-".to_owned(), |bytes| (bytes / 1_000_000).to_string());
    let score = &run.score;
    let error = |band: Band| score.of(band).in_percent().map_or("-".to_owned(), |(_, words)| words);
    let unmatched = match score.unmatched {
        0 => String::new(),
        count => format!("  {count} places unmatched"),
    };
    format!(
        "{name:<NAME$}{:>9}{:>10}{:>13}{:>8.2}{memory:>8}{:>9}{:>9}{:>11}{:>8.2}{:>8.2}{unmatched}",
        run.elements,
        run.triangles,
        run.work.form_factors(),
        run.seconds.total(),
        error(Band::All),
        error(Band::Shadow),
        error(Band::Rest),
        100.0 * score.all.p95,
        100.0 * score.all.bias,
    )
}

fn reference(comparison: &Comparison) -> String {
    let reference = &comparison.reference;
    let origin = match &reference.origin {
        Origin::Traced { rounds, paths, seconds } => {
            format!("{rounds} rounds, {} paths a place, {seconds:.1} s", number(*paths as f64))
        }
        Origin::File(path) => path.display().to_string(),
    };
    let [all, shadow] = [Set::Area, Set::Shadow].map(|set| percent(reference.noise(set)));
    let floor = |band| comparison.runs.iter().map(move |run: &Run| run.score.of(band).floor);
    let [least_all, least_shadow] =
        [Band::All, Band::Shadow].map(|band| percent(floor(band).fold(0.0, f64::max)));
    format!(
        "reference  {} places and {} in shadow edges; {origin}; noise {all} and {shadow}, taken off; \
         errors below {least_all} and {least_shadow} are not resolved",
        reference.count(Set::Area),
        reference.count(Set::Shadow),
    )
}

/// How errors fall with the number of elements.
fn slopes(comparison: &Comparison) -> Vec<String> {
    let fitted = |slope: Option<f64>| {
        slope.map_or("-".to_owned(), |slope| format!("{slope:.2} (like {})", nearest_law(slope).1))
    };
    let mut lines = vec![format!("error ~ elements^k; in theory {}", laws())];
    lines.extend(comparison.verdict.bands.iter().map(|verdict| {
        let [uniform, adaptive] = verdict.slopes.fitted.map(fitted);
        format!("  {:<14}uniform {uniform}, adaptive {adaptive}", verdict.band.name())
    }));
    lines
}
