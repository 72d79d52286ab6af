//! References as CSV.

use std::io::{self, Write};
use std::path::Path;

use glam::DVec3;

use super::reference::{Origin, Point, Reference, Set};
use crate::error::{Error, Result};
use crate::file;

/// Columns that must be there.
const NEEDED: [&str; 9] = ["x", "y", "z", "nx", "ny", "nz", "r", "g", "b"];

/// Columns that may be there.
const OPTIONAL: [&str; 5] = ["se_r", "se_g", "se_b", "set", "weight"];

/// Reads the points of a reference from text.
pub(super) fn parse(text: &str, path: &Path) -> Result<Vec<Point>> {
    let mut lines = text.lines().enumerate().map(|(number, line)| (number + 1, line.trim()));
    let (number, header) = lines.find(|(_, line)| !line.is_empty()).ok_or_else(|| {
        Error::format(path, format!("is empty; its first line must be {}", NEEDED.join(",")))
    })?;
    let header =
        TableHeader::new(header).map_err(|message| Error::at_line(path, number, message))?;
    let rows = lines.filter(|(_, line)| !line.is_empty());
    rows.map(|(number, line)| {
        header.point(line).map_err(|message| Error::at_line(path, number, message))
    })
    .collect()
}

/// Writes the points of a reference; read again, they are the same.
pub(super) fn save(points: &[Point], path: &Path) -> Result<()> {
    file::replace(path, |out| write(points, out))
}

fn write(points: &[Point], out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "{},{}", NEEDED.join(","), OPTIONAL.join(","))?;
    for Point { place, normal, radiosity, error, set, weight } in points {
        for triple in [place, normal, radiosity, error] {
            write!(out, "{},{},{},", triple.x, triple.y, triple.z)?;
        }
        writeln!(out, "{},{weight}", u8::from(*set == Set::Shadow))?;
    }
    Ok(())
}

/// Where the columns are.
struct TableHeader {
    columns: usize,
    needed: [usize; 9],
    optional: [Option<usize>; 5],
}

impl TableHeader {
    fn new(line: &str) -> std::result::Result<Self, String> {
        let names: Vec<&str> = line.split(',').map(str::trim).collect();
        if let Some(name) = names.iter().find(|n| !NEEDED.contains(n) && !OPTIONAL.contains(n)) {
            let known = [NEEDED.join(","), OPTIONAL.join(",")].join(",");
            return Err(format!("unknown column \"{name}\"; use {known}"));
        }
        let at = |name: &str| names.iter().position(|other| *other == name);
        let mut needed = [0; 9];
        for (column, name) in needed.iter_mut().zip(NEEDED) {
            *column = at(name).ok_or_else(|| format!("there is no column \"{name}\""))?;
        }
        Ok(Self { columns: names.len(), needed, optional: OPTIONAL.map(at) })
    }

    fn point(&self, line: &str) -> std::result::Result<Point, String> {
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        if fields.len() != self.columns {
            return Err(format!("{} columns, where the header has {}", fields.len(), self.columns));
        }
        let number = |column: usize| {
            let number = fields[column].parse().ok().filter(|x: &f64| x.is_finite());
            number.ok_or_else(|| format!("\"{}\" is not a number", fields[column]))
        };
        let optional = |k: usize, other: f64| self.optional[k].map_or(Ok(other), number);
        let triple = |k: usize| -> std::result::Result<DVec3, String> {
            let [x, y, z] = [0, 1, 2].map(|axis| number(self.needed[k + axis]));
            Ok(DVec3::new(x?, y?, z?))
        };
        let set = match optional(3, 0.0)? {
            0.0 => Set::Area,
            1.0 => Set::Shadow,
            other => return Err(format!("set {other}: write 0 for area, 1 for shadow")),
        };
        Point {
            place: triple(0)?,
            normal: triple(3)?,
            radiosity: triple(6)?,
            error: DVec3::new(optional(0, 0.0)?, optional(1, 0.0)?, optional(2, 0.0)?),
            set,
            weight: optional(4, 1.0)?,
        }
        .checked()
    }
}

impl Point {
    /// With a normal of length one, or what is wrong with it.
    pub(super) fn checked(self) -> std::result::Result<Self, String> {
        let Self { place, radiosity, error, weight, .. } = self;
        let normal = self.normal.try_normalize().ok_or("the normal has no direction")?;
        if !(place.is_finite() && radiosity.is_finite() && error.is_finite()) {
            return Err("a value is not finite".to_owned());
        }
        if error.min_element() < 0.0 {
            return Err("a standard error is below zero".to_owned());
        }
        if !(weight.is_finite() && weight >= 0.0) {
            return Err(format!("weight {weight} is not zero or more"));
        }
        // Of length one already, it stays as it is to the last bit.
        let normal = if self.normal.is_normalized() { self.normal } else { normal };
        Ok(Self { normal, ..self })
    }
}

impl Reference {
    /// Reads a reference for a scene of this extent, m: `.csv`, or `.npz` as numpy writes it.
    ///
    /// CSV has a header with the columns x, y, z, nx, ny, nz, r, g, b (W/m²) and, if it likes, `se_r`, `se_g`,
    /// `se_b` (standard errors), set (0 area, 1 shadow) and weight. NPZ has the arrays `pos`, `nrm`, `B` and, if
    /// it likes, `se`, `set`, `weight`, and `is_emitter`, `buried` and `rho`, which tell of points to leave out.
    ///
    /// # Errors
    /// When the file cannot be read, or says something that makes no sense, with the line or the array.
    pub fn load(path: &Path, extent: f64) -> Result<Self> {
        let is = |ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
        let points = if is("csv") {
            let text = std::fs::read_to_string(path).map_err(Error::io(path))?;
            parse(&text, path)?
        } else if is("npz") {
            super::arrays::load(path)?
        } else {
            return Err(Error::UnknownFormat { path: path.to_owned(), known: ".csv, .npz" });
        };
        Self::new(points, Origin::File(path.to_owned()), extent)
            .ok_or_else(|| Error::format(path, "no point of the area set is lit"))
    }

    /// Writes it as `.csv`, so that [`Self::load`] finds the same points.
    ///
    /// # Errors
    /// When the ending is another, or the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
            return Err(Error::UnknownFormat { path: path.to_owned(), known: ".csv" });
        }
        save(&self.points, path)
    }
}
