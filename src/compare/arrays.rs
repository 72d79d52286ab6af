//! References as numpy writes them: arrays in a zip archive.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use glam::DVec3;
use npyz::{Deserialize, NpyFile, Order};
use zip::ZipArchive;
use zip::result::ZipError;

use super::reference::{Point, Set};
use crate::error::{Error, Result};

/// Reads the points of a reference.
pub(super) fn load(path: &Path) -> Result<Vec<Point>> {
    let file = File::open(path).map_err(Error::io(path))?;
    let zip = ZipArchive::new(BufReader::new(file));
    let mut zip = zip.map_err(|error| Error::format(path, format!("is no npz: {error}")))?;
    let mut arrays = Arrays { path, zip: &mut zip };
    let places = arrays.triples("pos", None)?;
    let count = places.len();
    let normals = arrays.triples("nrm", Some(count))?;
    let radiosity = arrays.triples("B", Some(count))?;
    let errors = arrays.optional("se", 3, count)?;
    let sets = arrays.optional("set", 1, count)?;
    let weights = arrays.optional("weight", 1, count)?;
    let emitters = arrays.optional("is_emitter", 1, count)?;
    let buried = arrays.optional("buried", 1, count)?;
    let reflectances = arrays.optional("rho", 3, count)?;
    let is_set = |flags: &Option<Vec<f64>>, k: usize| flags.as_ref().is_some_and(|f| f[k] != 0.0);
    let is_black = |k: usize| reflectances.as_ref().is_some_and(|r| triple(r, k) == DVec3::ZERO);
    let is_scored = |&k: &usize| !is_set(&emitters, k) && !is_set(&buried, k) && !is_black(k);
    let point = |k: usize| Point {
        place: places[k],
        normal: normals[k],
        radiosity: radiosity[k],
        error: errors.as_ref().map_or(DVec3::ZERO, |errors| triple(errors, k)),
        set: if is_set(&sets, k) { Set::Shadow } else { Set::Area },
        weight: weights.as_ref().map_or(1.0, |weights| weights[k]),
    };
    let checked = |k: usize| {
        let wrong = |message| Error::format(path, format!("point {k}: {message}"));
        point(k).checked().map_err(wrong)
    };
    (0..count).filter(is_scored).map(checked).collect()
}

/// Reads an array of one type.
type Reader = fn(&[u8]) -> Option<Vec<f64>>;

/// The arrays of a file.
struct Arrays<'a> {
    path: &'a Path,
    zip: &'a mut ZipArchive<BufReader<File>>,
}

impl Arrays<'_> {
    fn triples(&mut self, name: &str, count: Option<usize>) -> Result<Vec<DVec3>> {
        let missing = Error::format(self.path, format!("there is no array \"{name}\""));
        let numbers = self.read(name)?.ok_or(missing)?;
        let count = count.unwrap_or(numbers.len() / 3);
        self.check(name, numbers.len(), 3 * count)?;
        Ok((0..count).map(|k| triple(&numbers, k)).collect())
    }

    /// An array of `count` times so many numbers, if there is one.
    fn optional(&mut self, name: &str, each: usize, count: usize) -> Result<Option<Vec<f64>>> {
        let numbers = self.read(name)?;
        if let Some(numbers) = &numbers {
            self.check(name, numbers.len(), each * count)?;
        }
        Ok(numbers)
    }

    fn check(&self, name: &str, found: usize, expected: usize) -> Result<()> {
        if found == expected {
            return Ok(());
        }
        let message =
            format!("array \"{name}\" has {found} numbers, where there should be {expected}");
        Err(Error::format(self.path, message))
    }

    fn read(&mut self, name: &str) -> Result<Option<Vec<f64>>> {
        let wrong =
            |message: String| Error::format(self.path, format!("array \"{name}\": {message}"));
        let mut bytes = Vec::new();
        match self.zip.by_name(&format!("{name}.npy")) {
            Err(ZipError::FileNotFound) => return Ok(None),
            Err(error) => return Err(wrong(error.to_string())),
            Ok(mut file) => file.read_to_end(&mut bytes).map_err(|e| wrong(e.to_string()))?,
        };
        numbers(&bytes).map(Some).map_err(wrong)
    }
}

/// The numbers of an array of whatever type.
fn numbers(bytes: &[u8]) -> std::result::Result<Vec<f64>, String> {
    let array = NpyFile::new(bytes).map_err(|error| error.to_string())?;
    if array.order() != Order::C && array.shape().len() > 1 {
        return Err("is in Fortran's order; use numpy.ascontiguousarray".to_owned());
    }
    // Before memory is set aside for it.
    let count = array.shape().iter().try_fold(1_u64, |count, &side| count.checked_mul(side));
    if count.is_none_or(|count| count > bytes.len() as u64) {
        return Err("is cut off".to_owned());
    }
    let readers: [Reader; 8] = [
        |bytes| of_type::<f64>(bytes, |x| x),
        |bytes| of_type::<f32>(bytes, f64::from),
        |bytes| of_type::<bool>(bytes, |x| f64::from(u8::from(x))),
        |bytes| of_type::<i8>(bytes, f64::from),
        |bytes| of_type::<u8>(bytes, f64::from),
        |bytes| of_type::<i16>(bytes, f64::from),
        |bytes| of_type::<i32>(bytes, f64::from),
        |bytes| of_type::<i64>(bytes, |x| x as f64),
    ];
    let found = readers.iter().find_map(|read| read(bytes));
    found.ok_or_else(|| "is not an array of numbers".to_owned())
}

fn of_type<T: Deserialize>(bytes: &[u8], number: impl Fn(T) -> f64) -> Option<Vec<f64>> {
    let array = NpyFile::new(bytes).ok()?;
    Some(array.into_vec::<T>().ok()?.into_iter().map(number).collect())
}

fn triple(numbers: &[f64], k: usize) -> DVec3 {
    DVec3::from_slice(&numbers[3 * k..])
}
