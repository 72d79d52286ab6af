//! STL, binary and text: triangles without a word on how they look.
//!
//! Read by ourselves: what the header claims is held against the file before any memory is taken, and text may have
//! polygons, lines that end anyhow and several solids, whose names are worth keeping.

use std::fs;
use std::path::Path;

use glam::{DVec3, Vec3};
use smallvec::SmallVec;

use super::text::{decoded, keyword, lines, numbers};
use super::{Face, Material, MaterialId, Scene};
use crate::error::{Error, Result};

/// Bytes before the triangles of a binary file, and of each of them.
const HEADER: usize = 84;
const RECORD: usize = 50;

/// Reads the STL file at `path`; each solid is an object of a material of its name.
pub(super) fn read(path: &Path) -> Result<Scene> {
    let bytes = fs::read(path).map_err(Error::io(path))?;
    let claimed =
        bytes.get(HEADER - 4..HEADER).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let size = claimed.and_then(|count| HEADER.checked_add(RECORD.checked_mul(count as usize)?));
    // Binary files may begin with "solid", too.
    if size == Some(bytes.len()) || !looks_like_text(&bytes) {
        let room = bytes.len().saturating_sub(HEADER) / RECORD;
        return match claimed {
            Some(count) if count as usize <= room => Ok(binary(&bytes, count as usize)),
            Some(count) => Err(Error::format(
                path,
                format!(
                    "neither text nor whole: {count} triangles are told of, and there is room for {room}"
                ),
            )),
            None => Err(Error::format(path, "too short for STL")),
        };
    }
    text(path, &decoded(&bytes))
}

fn looks_like_text(bytes: &[u8]) -> bool {
    let start = decoded(&bytes[..bytes.len().min(HEADER)]);
    start.trim_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case("solid"))
}

fn binary(bytes: &[u8], count: usize) -> Scene {
    let mut solids = Solids::default();
    for record in bytes[HEADER..].chunks_exact(RECORD).take(count) {
        // A normal comes first, which the order of the corners tells as well.
        let number = |at: usize| f32::from_le_bytes([0, 1, 2, 3].map(|k| record[at + k]));
        let corner = |k: usize| Vec3::from_array([0, 4, 8].map(|at| number(12 + 12 * k + at)));
        solids.add([0, 1, 2].map(|k| corner(k).as_dvec3()).as_slice());
    }
    solids.scene
}

fn text(path: &Path, text: &str) -> Result<Scene> {
    let mut solids = Solids::default();
    let mut corners: Vec<DVec3> = Vec::new();
    for (number, line) in lines(text) {
        let (word, rest) = keyword(&line);
        let wrong = |why: String| Error::at_line(path, number, why);
        match word.to_ascii_lowercase().as_str() {
            "solid" => solids.begin(rest),
            "outer" | "facet" => corners.clear(),
            "vertex" => {
                let values = numbers(rest)
                    .map_err(|word| wrong(format!("\"{word}\" is not a finite number")))?;
                let [x, y, z] = values[..] else {
                    return Err(wrong(format!("a vertex has 3 coordinates, not {}", values.len())));
                };
                corners.push(DVec3::new(x, y, z));
            }
            "endloop" | "endfacet" if corners.len() > 2 => {
                solids.add(&corners);
                corners.clear();
            }
            "endloop" => return Err(wrong(format!("a facet of {} corners", corners.len()))),
            "endfacet" | "endsolid" | "color" => {}
            _ => return Err(wrong(format!("\"{word}\" is no word of STL"))),
        }
    }
    if !corners.is_empty() {
        return Err(Error::format(path, "ends within a facet"));
    }
    Ok(solids.scene)
}

/// A scene while it is read, solid by solid.
#[derive(Default)]
struct Solids {
    scene: Scene,
    /// Name of what follows.
    name: String,
    /// Whether that has an object.
    begun: bool,
}

impl Solids {
    fn begin(&mut self, name: &str) {
        (self.name, self.begun) = (name.to_owned(), false);
    }

    fn add(&mut self, corners: &[DVec3]) {
        if !std::mem::replace(&mut self.begun, true) {
            let name = if self.name.is_empty() { "default" } else { &self.name }.to_owned();
            self.scene.materials.push(Material { name: name.clone(), ..Material::default() });
            self.scene.objects.push(name);
        }
        let [first, index] =
            [self.scene.positions.len(), self.scene.objects.len() - 1].map(|n| n as u32);
        self.scene.positions.extend_from_slice(corners);
        let vertices: SmallVec<[u32; 4]> = (first..first + corners.len() as u32).collect();
        self.scene.faces.push(Face {
            vertices,
            material: MaterialId(index),
            object: index,
            ..Face::default()
        });
    }
}
