//! Luminaires from IES files (ANSI/IESNA LM-63-1986, 1991, 1995 and 2002).
//!
//! Read are type C photometry without tilt. The light is taken to come from a point.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;

use super::photometry::Photometry;
use super::{Light, NamedLight, Scene};
use crate::error::{Error, Result};

/// Angles along one axis, at most.
const MOST_ANGLES: usize = 4096;

/// By so much of what the lamps emit a luminaire may exceed them before something must be wrong.
const SURPLUS: f64 = 0.05;

/// What is wrong, and in which line, counted from 1.
type Wrong = (usize, String);

impl Scene {
    /// Adds the luminaire of an IES file at a position, m, aimed down, turned by so many degrees counter-clockwise
    /// seen from above; its horizontal angle 0 is along +X before.
    ///
    /// # Errors
    /// When the file cannot be read or is not what is supported; the message has the line.
    pub fn add_luminaire(&mut self, path: &Path, position: DVec3, rotation: f64) -> Result<()> {
        let bytes = std::fs::read(path).map_err(Error::io(path))?;
        // Names of makers may be in any encoding; figures are in all of them.
        let text = String::from_utf8_lossy(&bytes);
        let (photometry, note) =
            parse(&text).map_err(|(line, message)| Error::at_line(path, line, message))?;
        self.notes.extend(note.map(|note| format!("{}: {note}", path.display())));
        let (photometry, turn) = (Arc::new(photometry), rotation.to_radians());
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let light = Light::Luminaire { position, photometry, turn };
        self.lights.push(NamedLight { name, light });
        Ok(())
    }
}

/// The numbers of a file, one after the other.
struct Numbers<'a> {
    words: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
    /// Where the last one was.
    line: usize,
}

impl Numbers<'_> {
    fn next(&mut self, what: &str) -> std::result::Result<f64, Wrong> {
        let Some((line, word)) = self.words.next() else {
            return Err((self.line, format!("the file ends before {what}")));
        };
        self.line = line;
        let number = word.parse().ok().filter(|x: &f64| x.is_finite());
        number.ok_or_else(|| (line, format!("{what}: \"{word}\" is not a number")))
    }

    fn count(&mut self, what: &str, most: usize) -> std::result::Result<usize, Wrong> {
        let number = self.next(what)?;
        if number.fract() == 0.0 && number >= 1.0 && number <= most as f64 {
            return Ok(number as usize);
        }
        Err((self.line, format!("{what}: {number} is none of 1 to {most}")))
    }

    /// So many ascending angles within `limit`, degrees.
    fn angles(
        &mut self,
        count: usize,
        what: &str,
        limit: f64,
    ) -> std::result::Result<Vec<f64>, Wrong> {
        let mut angles: Vec<f64> = Vec::new();
        for _ in 0..count {
            let angle = self.next(what)?;
            let ascends = angles.last().is_none_or(|&last| angle > last);
            if !ascends || !(0.0..=limit).contains(&angle) {
                let message =
                    format!("{what}: {angle} does not ascend within 0 to {limit} degrees");
                return Err((self.line, message));
            }
            angles.push(angle);
        }
        Ok(angles)
    }

    /// The rest of the file, all numbers at least zero.
    fn candela(&mut self, count: usize) -> std::result::Result<Vec<f64>, Wrong> {
        let mut candela = Vec::new();
        for _ in 0..count {
            let value = self.next("candela values")?;
            if !(0.0..=1e12).contains(&value) {
                return Err((self.line, format!("candela values: {value} is out of range")));
            }
            candela.push(value);
        }
        match self.words.next() {
            Some((line, word)) => Err((line, format!("\"{word}\" after the last candela value"))),
            None => Ok(candela),
        }
    }
}

/// The table of a file, and what is strange about it.
fn parse(text: &str) -> std::result::Result<(Photometry, Option<String>), Wrong> {
    let (tilt, name) = header(text)?;
    let words = text.lines().enumerate().skip(tilt).flat_map(|(line, text)| {
        let separates = |c: char| c.is_whitespace() || c == ',' || c == '\u{1a}';
        text.split(separates).filter(|word| !word.is_empty()).map(move |word| (line + 1, word))
    });
    let mut numbers = Numbers { words: Box::new(words), line: tilt };
    let lamps = numbers.count("number of lamps", 1_000_000)?;
    let lumens = numbers.next("lumens by lamp")?;
    let multiplier = numbers.next("candela multiplier")?;
    if !(multiplier > 0.0 && multiplier <= 1e9) {
        return Err((numbers.line, format!("candela multiplier: {multiplier} is out of range")));
    }
    let vertical = numbers.count("number of vertical angles", MOST_ANGLES)?;
    let horizontal = numbers.count("number of horizontal angles", MOST_ANGLES)?;
    type_c(&mut numbers)?;
    for what in ["unit of length", "width", "length", "height"] {
        numbers.next(what)?;
    }
    // The factor of ballast and lamp together, of 1986 and 1991, has become one for the future.
    let factors = [numbers.next("ballast factor")?, numbers.next("ballast lamp factor")?];
    let ballast = factors[0] * factors[1];
    if !(0.0..=100.0).contains(&ballast) {
        return Err((numbers.line, format!("ballast factor: {ballast} is out of range")));
    }
    numbers.next("input watts")?;
    let vertical = numbers.angles(vertical, "vertical angles", 180.0)?;
    if vertical.len() < 2 {
        return Err((numbers.line, "one vertical angle is no distribution".to_owned()));
    }
    let horizontal = symmetric(&mut numbers, horizontal)?;
    let mut candela = numbers.candela(vertical.len() * horizontal.len())?;
    candela.iter_mut().for_each(|value| *value *= multiplier);
    let mut photometry = Photometry { name, vertical, horizontal, candela };
    let note = surplus(&photometry, lamps as f64 * lumens);
    photometry.candela.iter_mut().for_each(|value| *value *= ballast);
    Ok((photometry, note))
}

/// How many lines there are up to the one about tilt, and what the luminaire is called.
fn header(text: &str) -> std::result::Result<(usize, String), Wrong> {
    let mut name = String::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if let Some(luminaire) = line.strip_prefix("[LUMINAIRE]") {
            luminaire.trim().clone_into(&mut name);
        }
        match line.strip_prefix("TILT=").map(str::trim) {
            None => {}
            Some("NONE") => return Ok((index + 1, name)),
            Some(tilt) => {
                let message = format!("TILT={tilt} is not supported; only TILT=NONE is");
                return Err((index + 1, message));
            }
        }
    }
    Err((text.lines().count().max(1), "no line with TILT=; is this an IES file?".to_owned()))
}

fn type_c(numbers: &mut Numbers<'_>) -> std::result::Result<(), Wrong> {
    let name = match numbers.count("photometric type", 3)? {
        1 => return Ok(()),
        2 => "B",
        _ => "A",
    };
    Err((numbers.line, format!("type {name} photometry is not supported; only type C is")))
}

/// Horizontal angles that say by which symmetry the others follow.
fn symmetric(numbers: &mut Numbers<'_>, count: usize) -> std::result::Result<Vec<f64>, Wrong> {
    let angles = numbers.angles(count, "horizontal angles", 360.0)?;
    let ends = [angles[0], angles[count - 1]];
    let known = [[0.0, 0.0], [0.0, 90.0], [0.0, 180.0], [0.0, 360.0], [90.0, 270.0]];
    if known.contains(&ends) {
        return Ok(angles);
    }
    let [first, last] = ends;
    let message = format!(
        "horizontal angles: from {first} to {last}; known are 0 alone, 0 to 90, 180 or 360, and 90 to 270"
    );
    Err((numbers.line, message))
}

/// A note, if a luminaire sends out more than its lamps; absolute photometry, -1 lumens, tells nothing of lamps.
fn surplus(photometry: &Photometry, lamps: f64) -> Option<String> {
    let flux = photometry.flux();
    (lamps > 0.0 && flux > (1.0 + SURPLUS) * lamps)
        .then(|| format!("the candela table sends out {flux:.0} lm, its lamps only {lamps:.0} lm"))
}
