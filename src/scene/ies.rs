//! Luminaires from IES files (ANSI/IES LM-63-1986, 1991, 1995, 2002 and 2019).
//!
//! Read is type C photometry, as the luminaire was measured, whatever its lamps would do if it were tilted. The light is
//! taken to come from a point.

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
type IesError = (usize, String);

impl Scene {
    /// Adds the luminaire of an IES file at a position, m, aimed down, turned by so many degrees counter-clockwise
    /// seen from above; its horizontal angle 0 is along +X before.
    ///
    /// # Errors
    /// When the file cannot be read or is not what is supported; the message has the line.
    pub fn add_luminaire(&mut self, path: &Path, position: DVec3, rotation: f64) -> Result<()> {
        let bytes = std::fs::read(path).map_err(Error::io(path))?;
        self.files.push(path.to_owned());
        // Names of makers may be in any encoding; figures are in all of them.
        let text = String::from_utf8_lossy(&bytes);
        let text = text.trim_start_matches('\u{feff}').replace("\r\n", "\n").replace('\r', "\n");
        let (photometry, notes) =
            parse(&text).map_err(|(line, message)| Error::at_line(path, line, message))?;
        self.notes.extend(notes.into_iter().map(|note| format!("{}: {note}", path.display())));
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
    fn next(&mut self, what: &str) -> std::result::Result<f64, IesError> {
        let Some((line, word)) = self.words.next() else {
            return Err((self.line, format!("the file ends before {what}")));
        };
        self.line = line;
        let number = word.parse().ok().filter(|x: &f64| x.is_finite());
        number.ok_or_else(|| (line, format!("{what}: \"{word}\" is not a number")))
    }

    fn count(&mut self, what: &str, most: usize) -> std::result::Result<usize, IesError> {
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
    ) -> std::result::Result<Vec<f64>, IesError> {
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

    /// Past the table of a lamp's output by its tilt.
    fn skip_tilt(&mut self) -> std::result::Result<(), IesError> {
        self.next("lamp's position in the luminaire")?;
        let count = self.count("number of tilt angles", MOST_ANGLES)?;
        for what in ["tilt angles", "factors by tilt"] {
            for _ in 0..count {
                self.next(what)?;
            }
        }
        Ok(())
    }

    /// So many numbers, all at least zero.
    fn candela(&mut self, count: usize) -> std::result::Result<Vec<f64>, IesError> {
        let mut candela = Vec::new();
        for _ in 0..count {
            let value = self.next("candela values")?;
            if !(0.0..=1e12).contains(&value) {
                return Err((self.line, format!("candela values: {value} is out of range")));
            }
            candela.push(value);
        }
        Ok(candela)
    }
}

/// The table of a file, and what is strange about it.
fn parse(text: &str) -> std::result::Result<(Photometry, Vec<String>), IesError> {
    let IesHeader { tilt, line, rest, name, has_factor } = IesHeader::read(text)?;
    let lines = std::iter::once((line, rest)).chain((line + 1..).zip(text.lines().skip(line)));
    let words = lines.flat_map(|(line, text)| {
        let separates = |c: char| c.is_whitespace() || matches!(c, ',' | ';' | '\u{1a}' | '\0');
        text.split(separates).filter(|word| !word.is_empty()).map(move |word| (line, word))
    });
    let mut numbers = Numbers { words: Box::new(words), line };
    let mut notes = Vec::new();
    if !tilt.eq_ignore_ascii_case("NONE") {
        if tilt.eq_ignore_ascii_case("INCLUDE") {
            numbers.skip_tilt()?;
        }
        notes.push(format!("TILT={tilt} is left out: it hangs as it was measured"));
    }
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
    let ballast = numbers.next("ballast factor")?;
    let second = numbers.next("number after the ballast factor")?;
    let ballast = if has_factor { ballast * second } else { ballast };
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
    notes.extend(surplus(&photometry, lamps as f64 * lumens));
    if let Some((line, word)) = numbers.words.next() {
        notes.push(format!(
            "line {line}: \"{word}\" and all after it is left out: no candela value lacks"
        ));
    }
    photometry.candela.iter_mut().for_each(|value| *value *= ballast);
    Ok((photometry, notes))
}

/// What stands before the figures.
struct IesHeader<'a> {
    /// `NONE`, `INCLUDE` or the name of a file.
    tilt: &'a str,
    /// The line that says so, from 1.
    line: usize,
    /// What follows in that line: ends of lines get lost.
    rest: &'a str,
    /// What the luminaire is called.
    name: String,
    /// Whether the number after the ballast factor is one, too: of ballast and lamp together, in files as of 1986 and
    /// 1991. Since 1995 it is one for the future, and since 2019 a code of who made the file.
    has_factor: bool,
}

impl<'a> IesHeader<'a> {
    fn read(text: &'a str) -> std::result::Result<Self, IesError> {
        const TILT: &str = "TILT=";
        let (mut name, mut has_factor) = (String::new(), true);
        for (index, line) in text.lines().enumerate() {
            let upper = line.to_ascii_uppercase();
            if index == 0 {
                let year =
                    upper.split("LM-63-").nth(1).and_then(|rest| rest.get(..4)?.parse().ok());
                has_factor = year.is_none_or(|year: u32| year < 1995);
            }
            if upper.trim_start().starts_with("[LUMINAIRE]") {
                line.split_once(']').map_or("", |(_, name)| name).trim().clone_into(&mut name);
            }
            if let Some(at) = upper.find(TILT) {
                let after = line[at + TILT.len()..].trim_start();
                let end =
                    after.find(|c: char| c.is_whitespace() || c == ',').unwrap_or(after.len());
                let (tilt, rest) = after.split_at(end);
                return Ok(Self { tilt, line: index + 1, rest, name, has_factor });
            }
        }
        let message = "no line with TILT=; is this an IES file?".to_owned();
        Err((text.lines().count().max(1), message))
    }
}

fn type_c(numbers: &mut Numbers<'_>) -> std::result::Result<(), IesError> {
    let name = match numbers.count("photometric type", 3)? {
        1 => return Ok(()),
        2 => "B",
        _ => "A",
    };
    let message = format!(
        "type {name} photometry, of floodlights and vehicles, is not supported; only type C is: ask the maker for that, \
         or convert it in a program for photometric files"
    );
    Err((numbers.line, message))
}

/// Horizontal angles that say by which symmetry the others follow.
fn symmetric(numbers: &mut Numbers<'_>, count: usize) -> std::result::Result<Vec<f64>, IesError> {
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
