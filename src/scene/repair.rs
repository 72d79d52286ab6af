//! Cleaning of a scene as read, so that what follows may rely on every face.
//!
//! Afterwards equal positions have one index, neighbours have the corners of their common edges, faces have
//! area, are planar, simple and listed once,
//! and their normals and texture coordinates are there only where they say something.

use std::collections::{HashMap, HashSet};

use glam::{DVec2, DVec3, Vec2, Vec3};
use smallvec::SmallVec;

use super::corners::{settle_normals, settle_uvs};
use super::notes::note_count;
use super::weld::weld_rounded;
use super::{Face, Scene, junctions};
use crate::geometry::{
    area_vector, bulge, flattened, is_affine, is_simple, longest_edge, triangulate,
};

/// Faces of less area, as a share of their longest edge squared, are dropped.
pub(super) const MIN_AREA: f64 = 1e-12;

/// Faces of less are told.
const SLIVER: f64 = 5e-5;

/// Corners further from the face's plane, as a share of its longest edge, make it non-planar.
const MAX_BULGE: f64 = 1e-6;

/// Repairs `scene` and notes what was done.
pub(crate) fn clean(scene: &mut Scene) {
    weld(scene);
    weld_rounded(scene);
    drop_degenerate(scene);
    junctions::join(scene);
    settle_uvs(scene);
    split_difficult(scene);
    drop_duplicates(scene);
    settle_normals(scene);
    forget_unused_positions(scene);
}

/// Gives bitwise equal positions (0 and -0 count as equal) the index of the first of them.
fn weld(scene: &mut Scene) {
    let mut first = HashMap::new();
    let mut kept: Vec<DVec3> = Vec::new();
    let index_of: Vec<u32> = (scene.positions.iter())
        .map(|&position| {
            let position = position + DVec3::ZERO;
            *first.entry(position.to_array().map(f64::to_bits)).or_insert_with(|| {
                kept.push(position);
                kept.len() as u32 - 1
            })
        })
        .collect();
    let mut used = vec![false; kept.len()];
    for vertex in scene.faces.iter_mut().flat_map(|face| &mut face.vertices) {
        *vertex = index_of[*vertex as usize];
        used[*vertex as usize] = true;
    }
    scene.positions = kept;
    let unused = used.iter().filter(|used| !**used).count();
    note_count(&mut scene.notes, unused, "position", "that no face uses ignored");
}

/// Drops corners that repeat their predecessor, then faces without area.
fn drop_degenerate(scene: &mut Scene) {
    let (mut shortened, mut slivers, before) = (0, 0, scene.faces.len());
    let positions = &scene.positions;
    scene.faces.retain_mut(|face| {
        let repeats = drop_repeated_corners(face);
        let corners = face.corners(positions);
        let area = area_vector(&corners).length();
        // Written so that an undefined area fails too.
        let square = longest_edge(&corners).powi(2);
        let keep = face.vertices.len() >= 3 && area > MIN_AREA * square;
        slivers += usize::from(keep && area < SLIVER * square);
        shortened += usize::from(repeats && keep);
        keep
    });
    let dropped = before - scene.faces.len();
    note_count(&mut scene.notes, dropped, "face", "without area dropped");
    note_count(&mut scene.notes, shortened, "face", "rid of repeated corners");
    note_count(&mut scene.notes, slivers, "sliver", "kept: light on what is so thin is rough");
}

fn drop_repeated_corners(face: &mut Face) -> bool {
    let count = face.vertices.len();
    let kept: SmallVec<[usize; 4]> = (0..count)
        .filter(|&corner| face.vertices[corner] != face.vertices[(corner + count - 1) % count])
        .collect();
    let repeats = kept.len() < count;
    if repeats {
        *face = part(face, &kept);
    }
    repeats
}

/// The face's `corners` as a face of their own.
fn part(face: &Face, corners: &[usize]) -> Face {
    Face {
        vertices: corners.iter().map(|&corner| face.vertices[corner]).collect(),
        normals: corners.iter().filter_map(|&corner| face.normals.get(corner).copied()).collect(),
        uvs: corners.iter().filter_map(|&corner| face.uvs.get(corner).copied()).collect(),
        tints: corners.iter().filter_map(|&corner| face.tints.get(corner).copied()).collect(),
        ..*face
    }
}

#[derive(PartialEq)]
enum Difficulty {
    Bulging,
    Crossing,
    Warped,
}

/// Cuts polygons that are not planar, not simple or not affinely textured and tinted into triangles.
fn split_difficult(scene: &mut Scene) {
    let (mut bulging, mut crossing) = (0, 0);
    let mut faces = Vec::with_capacity(scene.faces.len());
    for face in scene.faces.drain(..) {
        let corners = face.corners(&scene.positions);
        let normal = area_vector(&corners).normalize_or_zero();
        let flat = flattened(&corners, normal);
        let Some(difficulty) = difficulty(&face, &corners, &flat, normal) else {
            faces.push(face);
            continue;
        };
        bulging += usize::from(difficulty == Difficulty::Bulging);
        crossing += usize::from(difficulty == Difficulty::Crossing);
        let pieces = triangulate(&flat).into_iter().map(|triangle| part(&face, &triangle));
        faces.extend(pieces.filter(|piece| has_area(&scene.positions, piece)));
    }
    scene.faces = faces;
    note_count(&mut scene.notes, bulging, "polygon", "not planar, split into triangles");
    note_count(
        &mut scene.notes,
        crossing,
        "polygon",
        "touching or crossing itself, split into triangles",
    );
}

fn difficulty(face: &Face, corners: &[DVec3], flat: &[DVec2], normal: DVec3) -> Option<Difficulty> {
    if corners.len() == 3 {
        None
    } else if bulge(corners, normal) > MAX_BULGE * longest_edge(corners) {
        Some(Difficulty::Bulging)
    } else if !is_simple(flat) {
        Some(Difficulty::Crossing)
    } else if is_warped(face, flat) {
        Some(Difficulty::Warped)
    } else {
        None
    }
}

/// Whether no affine map gives all corners what they carry.
fn is_warped(face: &Face, flat: &[DVec2]) -> bool {
    let tints = |part: fn(&Vec3) -> Vec2| -> Vec<DVec2> {
        face.tints.iter().map(|tint| part(tint).as_dvec2()).collect()
    };
    let affine = |values: &[DVec2]| values.is_empty() || is_affine(flat, values);
    !affine(&face.uvs)
        || !affine(&tints(|tint| tint.truncate()))
        || !affine(&tints(|tint| Vec2::splat(tint.z)))
}

fn has_area(positions: &[DVec3], face: &Face) -> bool {
    let corners = face.corners(positions);
    area_vector(&corners).length() > MIN_AREA * longest_edge(&corners).powi(2)
}

/// Drops faces that list the corners of an earlier one in the same cyclic order.
fn drop_duplicates(scene: &mut Scene) {
    let before = scene.faces.len();
    let mut seen = HashSet::new();
    scene.faces.retain(|face| {
        let mut cycle = face.vertices.clone();
        let smallest = (0..cycle.len()).min_by_key(|&corner| cycle[corner]).unwrap_or(0);
        cycle.rotate_left(smallest);
        seen.insert(cycle)
    });
    let dropped = before - scene.faces.len();
    note_count(&mut scene.notes, dropped, "duplicate face", "dropped");
}

fn forget_unused_positions(scene: &mut Scene) {
    let mut index_of = vec![None; scene.positions.len()];
    let mut kept = Vec::new();
    for vertex in scene.faces.iter_mut().flat_map(|face| &mut face.vertices) {
        let old = *vertex as usize;
        *vertex = *index_of[old].get_or_insert_with(|| {
            kept.push(scene.positions[old]);
            kept.len() as u32 - 1
        });
    }
    scene.positions = kept;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;

    fn cleaned(positions: &[[f64; 3]], faces: &[&[u32]]) -> Scene {
        let face = |vertices: &&[u32]| Face { vertices: (*vertices).into(), ..Face::default() };
        let mut scene = Scene {
            positions: positions.iter().map(|&p| p.into()).collect(),
            faces: faces.iter().map(face).collect(),
            materials: vec![Material::default()],
            ..Scene::default()
        };
        clean(&mut scene);
        scene
    }

    const SQUARE: [[f64; 3]; 4] = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];

    #[test]
    fn equal_positions_get_one_index() {
        let positions = [&SQUARE[..], &[[-0.0, 0., 0.], [1., 1., 0.]]].concat();
        let scene = cleaned(&positions, &[&[0, 1, 2], &[4, 5, 3]]);
        assert_eq!(scene.positions.len(), 4);
        assert_eq!(scene.faces[1].vertices[..], [0, 2, 3]);
    }

    #[test]
    fn faces_without_area_are_dropped_with_a_note() {
        let scene = cleaned(&SQUARE, &[&[0, 1, 1], &[0, 1, 0, 1], &[0, 1, 2, 2, 3]]);
        assert_eq!(scene.faces.len(), 1);
        assert_eq!(scene.faces[0].vertices[..], [0, 1, 2, 3]);
        assert_eq!(scene.notes, ["2 faces without area dropped", "1 face rid of repeated corners"]);
    }

    #[test]
    fn long_thin_faces_are_kept() {
        let scene = cleaned(&[[0., 0., 0.], [1000., 0., 0.], [1000., 1e-6, 0.]], &[&[0, 1, 2]]);
        assert_eq!(scene.faces.len(), 1);
    }

    #[test]
    fn same_face_from_another_corner_is_a_duplicate_but_its_back_is_not() {
        let scene = cleaned(&SQUARE, &[&[0, 1, 2, 3], &[2, 3, 0, 1], &[3, 2, 1, 0]]);
        assert_eq!(scene.faces.len(), 2);
        assert_eq!(scene.notes, ["1 duplicate face dropped"]);
    }

    #[test]
    fn bent_quads_become_triangles_and_flat_ones_do_not() {
        let mut bent = SQUARE;
        bent[2][2] = 1e-3;
        assert_eq!(cleaned(&bent, &[&[0, 1, 2, 3]]).faces.len(), 2);
        assert_eq!(cleaned(&SQUARE, &[&[0, 1, 2, 3]]).faces.len(), 1);
    }
}
