//! A comparison as files: a row a run as CSV, and all of it as JSON.

use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use super::comparison::Comparison;
use super::reference::{Origin, Reference, Set};
use super::run::Run;
use super::score::{Band, ErrorStatistics};
use crate::error::{Error, Result};
use crate::file;

/// What can be written.
enum FigureFormat {
    Csv,
    Json,
}

/// All that is written as JSON.
#[derive(Serialize)]
struct Record<'a> {
    about: &'a Value,
    reference: About<'a>,
    sentences: [String; 2],
    #[serde(flatten)]
    comparison: &'a Comparison,
}

/// What there is to know about a reference, but for its points.
#[derive(Serialize)]
struct About<'a> {
    origin: &'a Origin,
    area_points: usize,
    shadow_points: usize,
    area_noise: f64,
    shadow_noise: f64,
}

/// Writes a comparison as `.csv`, a row a run, times and memory last; or as `.json`, with what the caller wants to
/// say `about` it.
///
/// # Errors
/// When the ending is another, or the file cannot be written.
pub fn save(comparison: &Comparison, about: &Value, path: &Path) -> Result<()> {
    let format = format_of(path)?;
    file::replace(path, |out| match format {
        FigureFormat::Csv => write_runs(&comparison.runs, out),
        FigureFormat::Json => {
            serde_json::to_writer_pretty(&mut *out, &Record::new(comparison, about))?;
            writeln!(out)
        }
    })
}

/// All figures of a comparison, as [`save`] writes them.
pub fn figures(comparison: &Comparison, about: &Value) -> Value {
    serde_json::to_value(Record::new(comparison, about)).unwrap_or_default()
}

/// Finds out before long work whether [`save`] could write to `path`; makes missing directories.
///
/// # Errors
/// When the ending is not `.csv` or `.json`, or no file can be made there.
pub fn check_writable(path: &Path) -> Result<()> {
    format_of(path)?;
    file::probe(path)
}

fn format_of(path: &Path) -> Result<FigureFormat> {
    match path
        .extension()
        .and_then(|ending| ending.to_str())
        .map(str::to_ascii_lowercase)
        .as_deref()
    {
        Some("csv") => Ok(FigureFormat::Csv),
        Some("json") => Ok(FigureFormat::Json),
        _ => Err(Error::UnknownFormat { path: path.to_owned(), known: ".csv, .json" }),
    }
}

impl<'a> Record<'a> {
    fn new(comparison: &'a Comparison, about: &'a Value) -> Self {
        let sentences = comparison.verdict.sentences();
        Self { about, reference: About::new(&comparison.reference), sentences, comparison }
    }
}

impl<'a> About<'a> {
    fn new(reference: &'a Reference) -> Self {
        Self {
            origin: &reference.origin,
            area_points: reference.count(Set::Area),
            shadow_points: reference.count(Set::Shadow),
            area_noise: reference.noise(Set::Area),
            shadow_noise: reference.noise(Set::Shadow),
        }
    }
}

/// A cell of the table.
type CsvField = (String, String);

fn write_runs(runs: &[Run], out: &mut impl Write) -> io::Result<()> {
    for (number, run) in runs.iter().enumerate() {
        let cells = row(run);
        let line =
            |part: fn(&CsvField) -> &str| cells.iter().map(part).collect::<Vec<_>>().join(",");
        if number == 0 {
            writeln!(out, "{}", line(|(name, _)| name))?;
        }
        writeln!(out, "{}", line(|(_, value)| value))?;
    }
    Ok(())
}

fn row(run: &Run) -> Vec<CsvField> {
    let mut cells = counts(run);
    for band in Band::ALL {
        cells.extend(errors(band, run.score.of(band)));
    }
    cells.extend(costs(run));
    cells
}

fn cell(name: &str, value: impl ToString) -> CsvField {
    (name.to_owned(), value.to_string())
}

fn counts(run: &Run) -> Vec<CsvField> {
    let divided = run.divided;
    vec![
        cell("family", run.family.name()),
        cell("size_or_tolerance", run.knob),
        cell("elements", run.elements),
        cell("leaves", run.leaves),
        cell("triangles", run.triangles),
        cell("vertices", run.vertices),
        cell("patches", run.patches),
        cell("direct_evaluations", run.work.direct),
        cell("exchange_factors", run.work.exchange),
        cell("gathering_factors", run.work.gathering),
        cell("form_factors", run.work.form_factors()),
        cell("shadow_rays", run.work.rays),
        cell("patch_hemicubes", run.hemicubes[0]),
        cell("vertex_hemicubes", run.hemicubes[1]),
        cell("shots", run.shots),
        cell("converged", run.converged),
        cell("energy_imbalance", run.imbalance),
        cell("divided_uniform", divided.uniform),
        cell("divided_gradient", divided.gradient),
        cell("divided_shadow_edge", divided.shadow_edge),
        cell("divided_contact", divided.contact),
        cell("divided_discontinuity", divided.discontinuity),
        cell("deepest_level", run.levels.len().saturating_sub(1)),
        cell("hanging", run.hanging),
        cell("smallest_angle_degrees", run.angles.smallest),
        cell("share_below_10_degrees", run.angles.below_ten),
        cell("unmatched", run.score.unmatched),
    ]
}

fn errors(band: Band, errors: &ErrorStatistics) -> Vec<CsvField> {
    let name = match band {
        Band::All => "all",
        Band::Shadow => "shadow",
        Band::Rest => "rest",
    };
    let values = [
        ("rmse", errors.rmse),
        ("rmse_error", errors.rmse_error),
        ("raw_rmse", errors.raw_rmse),
        ("mean_absolute", errors.mean_absolute),
        ("bias", errors.bias),
        ("median", errors.median),
        ("p95", errors.p95),
        ("max", errors.max),
        ("noise", errors.noise),
        ("floor", errors.floor),
    ];
    values.map(|(what, value)| cell(&format!("{name}_{what}"), value)).to_vec()
}

/// What no two machines agree on.
fn costs(run: &Run) -> Vec<CsvField> {
    let seconds = run.seconds;
    vec![
        cell("seconds", seconds.total()),
        cell("seconds_surfaces", seconds.surfaces),
        cell("seconds_direct", seconds.direct),
        cell("seconds_reflected", seconds.reflected),
        cell("seconds_gathering", seconds.gathering),
        cell("seconds_triangles", seconds.triangles),
        cell(
            "peak_memory_bytes",
            run.peak_memory.map(|bytes| bytes.to_string()).unwrap_or_default(),
        ),
    ]
}
