//! A first pass over an OBJ file: finds errors with their lines, and what the parser leaves out.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::fmt::Write;
use std::iter::repeat;
use std::path::Path;

use glam::Vec3;

use crate::colour::linear_from_srgb;
use crate::error::{Error, Result};
use crate::scene::text::{keyword, lines, name, numbers, words};

/// What a pass over the file found.
#[derive(Debug, Default)]
pub(super) struct Scan {
    /// Polygons in the order of the file.
    pub(super) faces: Vec<FaceLine>,
    /// Names of the objects and groups that have polygons.
    pub(super) objects: Vec<String>,
    /// Materials in the order of their first use.
    pub(super) materials: Vec<UseMtl>,
    /// Names of material libraries.
    pub(super) libraries: Vec<String>,
    /// Checked `v`, `vt`, `vn` lines.
    pub(super) data: String,
    /// Checked `f` lines with absolute indices, for the parser to read after `data`.
    pub(super) polygons: String,
    /// Points, lines and polygons of fewer than three corners.
    pub(super) loose: usize,
    /// Free-form curves and surfaces.
    pub(super) free_form: usize,
    /// Indices of the positions that polygons use.
    used: HashSet<usize>,
    /// Reflectances that the colours of vertices mean, 1 where there is none; empty unless one is below 1.
    pub(super) colours: Vec<Vec3>,
    /// Where in `materials` a name is.
    numbers: HashMap<String, u32>,
    /// Numbers of positions, texture coordinates and normals.
    counts: [usize; 3],
}

/// A material's name, and the first line that uses it.
#[derive(Debug)]
pub(super) struct UseMtl {
    pub(super) line: usize,
    pub(super) name: String,
}

/// What the file says about a polygon besides its corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceLine {
    line: usize,
    /// Index into [`Scan::objects`].
    pub(super) object: u32,
    /// Index into [`Scan::materials`].
    pub(super) material: Option<u32>,
    /// Smoothing group, 0 for none.
    pub(super) smoothing: u32,
    /// True if all corners have texture coordinates.
    pub(super) has_uvs: bool,
    /// True if all corners have normals.
    pub(super) has_normals: bool,
    /// Largest index of a position, a texture coordinate, a normal.
    highest: [usize; 3],
}

/// What lines further up say about the polygons that follow.
struct PolygonState {
    name: String,
    object: Option<u32>,
    material: Option<u32>,
    smoothing: u32,
}

/// A value of one line, or what is wrong with the line.
type LineResult<T> = std::result::Result<T, String>;

const INDEX_NAMES: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// Reads through `text`, the content of `path`.
pub(super) fn scan(path: &Path, text: &str) -> Result<Scan> {
    let mut scan = Scan::default();
    let mut state =
        PolygonState { name: "default".to_owned(), object: None, material: None, smoothing: 0 };
    for (number, line) in lines(text) {
        scan.line(&mut state, number, &line)
            .map_err(|message| Error::at_line(path, number, message))?;
    }
    scan.check_indices(path)?;
    Ok(scan)
}

impl Scan {
    /// Number of positions that no polygon uses.
    pub(super) fn unused(&self) -> usize {
        self.counts[0] - self.used.len()
    }

    fn line(&mut self, state: &mut PolygonState, number: usize, line: &str) -> LineResult<()> {
        let (word, rest) = keyword(line);
        match &*lowered(word) {
            "v" => self.vertex(rest)?,
            "vt" => self.datum(1, "vt", rest)?,
            "vn" => self.datum(2, "vn", rest)?,
            "f" | "fo" => self.face(state, number, rest)?,
            "p" | "l" => self.loose += 1,
            "curv" | "curv2" | "surf" => self.free_form += 1,
            "o" | "g" => {
                state.name = if rest.is_empty() { "default" } else { rest }.to_owned();
                state.object = None;
            }
            "s" => state.smoothing = smoothing_group(rest),
            "usemtl" => state.material = self.material(number, name(rest)),
            "mtllib" => self.libraries.push(rest.to_owned()),
            _ => {}
        }
        Ok(())
    }

    fn vertex(&mut self, rest: &str) -> LineResult<()> {
        let values = finite(rest)?;
        let weight = match values.len() {
            3 => 1.0,
            4 => values[3],
            6.. => {
                self.colour([values[3], values[4], values[5]]);
                1.0
            }
            count => return Err(format!("a vertex needs 3 coordinates, here are {count}")),
        };
        if !values[..3].iter().all(|x| (x / weight).is_finite()) {
            return Err(format!("a vertex of weight {weight} is infinitely far"));
        }
        let kept = if values.len() == 4 { 4 } else { 3 };
        self.emit(0, "v", rest, kept);
        Ok(())
    }

    /// The colour of the next vertex. As Blender, three.js and `MeshLab` do, it is taken as shown on a screen, in sRGB.
    fn colour(&mut self, coded: [f64; 3]) {
        let colour = coded.map(|code| linear_from_srgb(code.clamp(0.0, 1.0)) as f32);
        if colour != [1.0; 3] {
            self.colours.resize(self.counts[0], Vec3::ONE);
            self.colours.push(colour.into());
        }
    }

    /// A texture coordinate or a normal.
    fn datum(&mut self, kind: usize, word: &str, rest: &str) -> LineResult<()> {
        let values = finite(rest)?;
        let (least, kept) = if kind == 1 { (1, 2) } else { (3, 3) };
        if values.len() < least {
            return Err(format!(
                "a {} needs more numbers than {}",
                INDEX_NAMES[kind],
                values.len()
            ));
        }
        self.emit(kind, word, rest, kept);
        Ok(())
    }

    /// Writes the first `kept` numbers of `rest`, missing ones as 0.
    fn emit(&mut self, kind: usize, word: &str, rest: &str, kept: usize) {
        self.data.push_str(word);
        for number in words(rest).chain(repeat("0")).take(kept) {
            self.data.push(' ');
            self.data.push_str(number);
        }
        self.data.push('\n');
        self.counts[kind] += 1;
    }

    fn face(&mut self, state: &mut PolygonState, number: usize, rest: &str) -> LineResult<()> {
        let corners: Vec<[usize; 3]> =
            words(rest).map(|word| self.corner(word)).collect::<LineResult<_>>()?;
        if corners.len() < 3 {
            self.loose += 1;
            return Ok(());
        }
        let object = *state.object.get_or_insert_with(|| {
            self.objects.push(state.name.clone());
            self.objects.len() as u32 - 1
        });
        let all = |kind: usize| corners.iter().all(|corner| corner[kind] > 0);
        let highest =
            |kind: usize| corners.iter().map(|corner| corner[kind]).max().unwrap_or_default();
        self.faces.push(FaceLine {
            line: number,
            object,
            material: state.material,
            smoothing: state.smoothing,
            has_uvs: all(1),
            has_normals: all(2),
            highest: [highest(0), highest(1), highest(2)],
        });
        self.polygons.push('f');
        for [position, uv, normal] in corners {
            self.used.insert(position);
            let blank = |index: usize| if index == 0 { String::new() } else { index.to_string() };
            // Writing to a string cannot fail.
            let _ = write!(self.polygons, " {position}/{}/{}", blank(uv), blank(normal));
        }
        self.polygons.push('\n');
        Ok(())
    }

    /// Absolute indices of one `v/vt/vn`, counted from 1, 0 where there is none.
    fn corner(&self, word: &str) -> LineResult<[usize; 3]> {
        let mut indices = [0; 3];
        for (kind, part) in word.split('/').enumerate() {
            let index =
                indices.get_mut(kind).ok_or_else(|| format!("\"{word}\" has too many parts"))?;
            if !part.is_empty() || kind == 0 {
                *index = self.absolute(kind, part).map_err(|why| format!("\"{word}\": {why}"))?;
            }
        }
        Ok(indices)
    }

    fn absolute(&self, kind: usize, part: &str) -> LineResult<usize> {
        let index: i64 = part.parse().map_err(|_| "not a vertex of a face".to_owned())?;
        let count = self.counts[kind];
        let name = INDEX_NAMES[kind];
        let back = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
        match index {
            0 => Err(format!("a {name} index of 0; they count from 1")),
            1.. => Ok(back),
            _ if back <= count => Ok(count + 1 - back),
            _ => Err(format!("{name} {index} when there are only {count} so far")),
        }
    }

    /// Checked at the end, as faces may stand before their vertices.
    fn check_indices(&self, path: &Path) -> Result<()> {
        for face in &self.faces {
            for (kind, name) in INDEX_NAMES.into_iter().enumerate() {
                let (index, count) = (face.highest[kind], self.counts[kind]);
                if index > count {
                    let message = format!("{name} {index} is used, but there are only {count}");
                    return Err(Error::at_line(path, face.line, message));
                }
            }
        }
        Ok(())
    }

    fn material(&mut self, number: usize, name: &str) -> Option<u32> {
        if name.is_empty() {
            return None;
        }
        if let Some(&known) = self.numbers.get(name) {
            return Some(known);
        }
        let new = self.materials.len() as u32;
        self.materials.push(UseMtl { line: number, name: name.to_owned() });
        self.numbers.insert(name.to_owned(), new);
        Some(new)
    }
}

/// A keyword in the case in which it is known.
fn lowered(word: &str) -> Cow<'_, str> {
    match word.bytes().any(|byte| byte.is_ascii_uppercase()) {
        true => Cow::Owned(word.to_ascii_lowercase()),
        false => Cow::Borrowed(word),
    }
}

fn finite(rest: &str) -> LineResult<Vec<f64>> {
    numbers(rest).map_err(|word| format!("\"{word}\" is not a finite number"))
}

fn smoothing_group(rest: &str) -> u32 {
    match words(rest).next() {
        Some(word) if word.eq_ignore_ascii_case("on") => 1,
        Some(group) => group.parse().unwrap_or(0),
        None => 0,
    }
}
