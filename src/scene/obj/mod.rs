//! Wavefront OBJ: polygons through `tobj`, smoothing groups and materials by ourselves.

mod holes;
mod library;
mod mtl;
mod scan;
mod smoothing;

use std::io::Read;
use std::ops::Range;
use std::path::Path;

use glam::{DVec2, DVec3, Vec3};
use smallvec::SmallVec;

use self::library::{Library, Use};
use self::scan::{FaceLine, Scan};
use super::notes::note_count;
use super::{Face, Scene, text};
use crate::error::{Error, Result};

/// Reads the OBJ file at `path` and its material libraries.
pub(super) fn read(path: &Path) -> Result<Scene> {
    let text = text::read(path)?;
    let scan = scan::scan(path, &text)?;
    let mesh = parse(path, &scan)?;
    let (objects, files) = (scan.objects.clone(), vec![path.to_owned()]);
    let mut scene = Scene { objects, files, ..Scene::default() };
    note_ignored(&scan, &mut scene.notes);
    let mut library = Library::read(path, &scan.libraries, &mut scene);
    let uses: Vec<Use> = library.resolve(path, &scan.materials, &mut scene);
    let nameless = scan.faces.iter().any(|face| face.material.is_none());
    let fallback = nameless.then(|| library.fallback(&mut scene));
    scene.positions = mesh.positions.chunks_exact(3).map(DVec3::from_slice).collect();
    let corners = Corners::new(&mesh);
    let mut start = 0;
    for (index, line) in scan.faces.iter().enumerate() {
        let used =
            line.material.and_then(|material| uses.get(material as usize)).or(fallback.as_ref());
        let end = start + mesh.face_arities.get(index).map_or(3, |&arity| arity as usize);
        let face = used.and_then(|used| corners.face(start..end, line, used));
        scene.faces.push(face.ok_or_else(|| unreadable(path, "faces and corners do not match"))?);
        start = end;
    }
    smoothing::smooth(&mut scene, &scan.faces);
    Ok(scene)
}

fn unreadable(path: &Path, reason: &str) -> Error {
    Error::format(path, format!("cannot be read as OBJ: {reason}"))
}

/// Lets `tobj` read the checked lines: one mesh of all polygons.
fn parse(path: &Path, scan: &Scan) -> Result<tobj::Mesh> {
    let options = tobj::LoadOptions::default();
    let mut checked = scan.data.as_bytes().chain(scan.polygons.as_bytes());
    let no_materials = |_: &Path| Err(tobj::LoadError::GenericFailure);
    let (models, _) = tobj::load_obj_buf(&mut checked, &options, no_materials)
        .map_err(|error| unreadable(path, &error.to_string()))?;
    Ok(models.into_iter().next().map(|model| model.mesh).unwrap_or_default())
}

fn note_ignored(scan: &Scan, notes: &mut Vec<String>) {
    note_count(notes, scan.loose, "point-or-line element", "ignored");
    note_count(notes, scan.free_form, "free-form element", "ignored");
    note_count(notes, scan.unused(), "position", "that no face uses ignored");
    note_count(notes, scan.coloured, "vertex colour", "ignored");
}

/// The parser's flat lists, read face by face.
struct Corners {
    vertices: Vec<u32>,
    uvs: Vec<DVec2>,
    normals: Vec<Vec3>,
}

impl Corners {
    fn new(mesh: &tobj::Mesh) -> Self {
        let uv = |&index: &u32| mesh.texcoords.get(2 * index as usize..).and_then(|uv| uv.get(..2));
        let normal = |&index: &u32| mesh.normals.get(3 * index as usize..).and_then(|n| n.get(..3));
        Self {
            vertices: mesh.indices.clone(),
            uvs: mesh.texcoord_indices.iter().filter_map(uv).map(DVec2::from_slice).collect(),
            normals: (mesh.normal_indices.iter().filter_map(normal))
                .map(|normal| DVec3::from_slice(normal).normalize_or_zero().as_vec3())
                .collect(),
        }
    }

    /// The face at `range` of the lists; `None` if they are shorter.
    ///
    /// Where a corner lacks a texture coordinate or a normal the parser makes one up, so these
    /// are only taken when the line has all of them.
    fn face(&self, range: Range<usize>, line: &FaceLine, used: &Use) -> Option<Face> {
        let mut face = Face {
            vertices: self.vertices.get(range.clone())?.into(),
            material: used.material,
            object: line.object,
            ..Face::default()
        };
        if line.has_uvs {
            let uvs: &[DVec2] = self.uvs.get(range.clone())?;
            face.uvs = uvs.iter().map(|&uv| used.mapping.apply(uv)).collect::<SmallVec<_>>();
        }
        if line.has_normals {
            face.normals = self.normals.get(range)?.into();
        }
        Some(face)
    }
}
