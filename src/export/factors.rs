//! A matrix of form factors to a file.
//!
//! | ending | |
//! |---|---|
//! | `.json` | `patches` (object, material, area, centre, normal), `F` row by row, and `at`, the factors from a point, if asked for |
//! | `.csv` | a line for each factor above zero: `from`, `from_object`, `to`, `to_object`, `factor`; from the point, `from` is `at` |
//! | `.npy` | the matrix alone, 64-bit floats |

use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;
use serde::ser::{SerializeSeq, Serializer};

use crate::error::{Error, Result};
use crate::file;
use crate::form_factor::FormFactors;

/// Form factors with what they are between.
#[derive(Clone, Debug)]
pub struct FactorTable<'a> {
    /// The patches, in the order of rows and columns.
    pub patches: Vec<FactorPatch>,
    /// The matrix.
    pub factors: &'a FormFactors,
    /// Form factors from a point to each patch.
    pub at: Option<Vec<f64>>,
}

/// A patch as the table names it.
#[derive(Clone, Debug, Serialize)]
pub struct FactorPatch {
    /// Name of the object it is part of.
    pub object: String,
    /// Name of its material.
    pub material: String,
    /// Area, m².
    pub area: f64,
    /// Centre of gravity, m.
    pub centre: [f64; 3],
    /// Unit normal.
    pub normal: [f64; 3],
}

/// Writes `table` as `.json`, `.csv` or `.npy`. The file appears whole or not at all.
///
/// # Errors
/// When the ending is none of these, or the file cannot be written.
pub fn save_factors(table: &FactorTable<'_>, path: &Path) -> Result<()> {
    match FactorFormat::of(path)? {
        FactorFormat::Json => {
            file::replace(path, |out| Ok(serde_json::to_writer(out, &Json(table))?))
        }
        FactorFormat::Csv => file::replace(path, |out| write_csv(table, out)),
        FactorFormat::Npy => file::replace(path, |out| write_npy(table.factors, out)),
    }
}

/// Finds out before long work whether [`save_factors`] could write to `path`; makes missing directories.
///
/// # Errors
/// When the ending is unknown or no file can be made there.
pub fn check_writable_factors(path: &Path) -> Result<()> {
    FactorFormat::of(path)?;
    file::probe(path)
}

#[derive(Clone, Copy)]
enum FactorFormat {
    Json,
    Csv,
    Npy,
}

impl FactorFormat {
    fn of(path: &Path) -> Result<Self> {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        match ending.to_ascii_lowercase().as_str() {
            "json" => Ok(Self::Json),
            "csv" => Ok(Self::Csv),
            "npy" => Ok(Self::Npy),
            _ => Err(Error::UnknownFormat { path: path.to_owned(), known: ".json, .csv, .npy" }),
        }
    }
}

/// Bytes of a `.npy`'s header after the first ten; enough for any number of patches.
const NPY_TEXT: u16 = 128 - 10;

/// All entries of a row, zeros included.
fn dense(factors: &FormFactors, i: usize) -> Vec<f64> {
    let mut row = vec![0.0; factors.len()];
    factors.row(i).for_each(|(j, factor)| row[j] = factor);
    row
}

fn write_csv(table: &FactorTable<'_>, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "from,from_object,to,to_object,factor")?;
    let object = |i: usize| format!("\"{}\"", table.patches[i].object.replace('"', "\"\""));
    for i in 0..table.factors.len() {
        for (j, factor) in table.factors.row(i) {
            writeln!(out, "{i},{},{j},{},{factor}", object(i), object(j))?;
        }
    }
    let at = table.at.iter().flatten().enumerate().filter(|(_, factor)| **factor > 0.0);
    for (j, factor) in at {
        writeln!(out, "at,,{j},{},{factor}", object(j))?;
    }
    Ok(())
}

/// Writes numpy's format, version 1: <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>.
/// Reading is left to a crate; this much is less than what that one brings along.
fn write_npy(factors: &FormFactors, out: &mut impl Write) -> io::Result<()> {
    let n = factors.len();
    out.write_all(b"\x93NUMPY\x01\x00")?;
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({n}, {n}, ), }}");
    // The numbers are to begin at a multiple of 64 bytes.
    out.write_all(&NPY_TEXT.to_le_bytes())?;
    writeln!(out, "{header:<0$}", usize::from(NPY_TEXT) - 1)?;
    for i in 0..n {
        for factor in dense(factors, i) {
            out.write_all(&factor.to_le_bytes())?;
        }
    }
    Ok(())
}

struct Json<'a>(&'a FactorTable<'a>);

impl Serialize for Json<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        use serde::ser::SerializeMap;
        let Self(table) = self;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("patches", &table.patches)?;
        map.serialize_entry("F", &Rows(table.factors))?;
        if let Some(at) = &table.at {
            map.serialize_entry("at", at)?;
        }
        map.end()
    }
}

/// Written row by row: a whole dense matrix need never be in memory.
struct Rows<'a>(&'a FormFactors);

impl Serialize for Rows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let Self(factors) = self;
        let mut rows = serializer.serialize_seq(Some(factors.len()))?;
        for i in 0..factors.len() {
            rows.serialize_element(&dense(factors, i))?;
        }
        rows.end()
    }
}
