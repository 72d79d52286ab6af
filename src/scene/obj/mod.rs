//! Wavefront OBJ: polygons through `tobj`, smoothing groups and materials by ourselves.

mod holes;
mod library;
mod lists;
mod mtl;
mod scan;
mod smoothing;

use std::io::Read;
use std::path::Path;

use glam::{DVec3, Vec3};
use smallvec::SmallVec;

use self::library::{Library, Use};
use self::lists::MeshLists;
use self::scan::Scan;
use super::notes::note_count;
use super::{MAX_REFLECTANCE, MaterialId, Scene, text};
use crate::colour::Rgb;
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
    let lists = MeshLists::new(&mesh);
    let mut start = 0;
    for (index, line) in scan.faces.iter().enumerate() {
        let used =
            line.material.and_then(|material| uses.get(material as usize)).or(fallback.as_ref());
        let end = start + mesh.face_arities.get(index).map_or(3, |&arity| arity as usize);
        let face = used.and_then(|used| lists.face(start..end, line, used));
        scene.faces.push(face.ok_or_else(|| unreadable(path, "faces and corners do not match"))?);
        start = end;
    }
    tint(&mut scene, &scan.colours, fallback.map(|used| used.material));
    smoothing::smooth(&mut scene, &scan.faces);
    Ok(scene)
}

/// Lets the colours of vertices tint the faces that have no picture; they are all that is known of those without a
/// material, which is `nameless`.
fn tint(scene: &mut Scene, colours: &[Vec3], nameless: Option<MaterialId>) {
    let colour = |&vertex: &u32| colours.get(vertex as usize).copied().unwrap_or(Vec3::ONE);
    let [mut tinted, mut pictured] = [0; 2];
    for face in &mut scene.faces {
        let tints: SmallVec<[Vec3; 4]> = face.vertices.iter().map(colour).collect();
        if tints.iter().all(|tint| *tint == Vec3::ONE) {
            continue;
        }
        let material = &mut scene.materials[face.material.index()];
        if material.texture.is_some() {
            pictured += 1;
            continue;
        }
        if Some(face.material) == nameless {
            material.reflectance = Rgb::splat(MAX_REFLECTANCE);
        }
        face.tints = tints;
        tinted += 1;
    }
    let notes = &mut scene.notes;
    note_count(notes, tinted, "face", "tinted by the colours of its vertices, taken as sRGB");
    note_count(notes, pictured, "face", "with a picture: the colours of its vertices are ignored");
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
}
