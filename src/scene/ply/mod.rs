//! PLY, text and binary: polygons with the colours of their corners.
//!
//! Read by ourselves: nothing is reserved for what a header only claims, and lists go by without a map for each vertex.

mod header;
mod import;
mod values;

use std::fs;
use std::path::Path;

use self::import::PlyImport;
use self::values::Values;
use super::Scene;
use crate::error::{Error, Result};

/// Reads the PLY file at `path`.
pub(super) fn read(path: &Path) -> Result<Scene> {
    let bytes = fs::read(path).map_err(Error::io(path))?;
    let wrong = |why: String| Error::format(path, why);
    let (header, body) = header::parse(path, &bytes)?;
    let mut values = Values::new(&bytes[body..], header.encoding);
    let mut import = PlyImport::default();
    for element in &header.elements {
        let read = match element.name.as_str() {
            "vertex" => import.add_vertices(element, &mut values),
            "face" => import.add_faces(element, &mut values),
            _ => import.skip(element, &mut values),
        };
        read.map_err(|why| wrong(format!("element {}: {why}", element.name)))?;
    }
    import.finish(&header).map_err(wrong)
}
