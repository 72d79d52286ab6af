//! What corners carry besides their place: normals and texture coordinates, kept only where they
//! say something.

use glam::DVec3;
use smallvec::SmallVec;

use super::Scene;
use super::notes::note_count;
use crate::geometry::area_vector;

/// Cosine of 0.1°: normals within that angle of the face's own say nothing.
const SAME_DIRECTION: f64 = 0.999_998_476_9;

/// Texture coordinates beyond this have no digits left for a place in the picture.
const MAX_UV: f64 = 1e6;

/// Keeps texture coordinates only where a picture needs them and they are usable.
pub(crate) fn settle_uvs(scene: &mut Scene) {
    let mut unusable = 0;
    for face in &mut scene.faces {
        let material = &scene.materials[face.material.index()];
        if material.texture.is_none() && material.emission_texture.is_none() {
            face.uvs.clear();
        }
        // Written so that undefined coordinates fail too.
        if !face.uvs.iter().all(|uv| uv.abs().max_element() <= MAX_UV) {
            face.uvs.clear();
            unusable += 1;
        }
    }
    note_count(
        &mut scene.notes,
        unusable,
        "face",
        "with unusable texture coordinates left untextured",
    );
}

/// Keeps unit normals only where they differ from the face's own and do not contradict it.
pub(crate) fn settle_normals(scene: &mut Scene) {
    let mut contradicting = 0;
    for face in &mut scene.faces {
        if face.normals.is_empty() {
            continue;
        }
        let own = area_vector(&face.corners(&scene.positions)).normalize_or_zero();
        let unit: SmallVec<[DVec3; 4]> =
            face.normals.iter().map(|normal| normal.as_dvec3().normalize_or_zero()).collect();
        let degenerate = unit.contains(&DVec3::ZERO);
        let backward = unit.iter().any(|normal| normal.dot(own) <= 0.0);
        let flat = unit.iter().all(|normal| normal.dot(own) > SAME_DIRECTION);
        contradicting += usize::from(backward && !degenerate);
        face.normals.clear();
        if !(degenerate || backward || flat) {
            face.normals.extend(unit.iter().map(|normal| normal.as_vec3().normalize()));
        }
    }
    note_count(
        &mut scene.notes,
        contradicting,
        "face",
        "with vertex normals against the order of its corners, taken as flat",
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Face, Material};
    use glam::Vec3;
    use smallvec::smallvec;

    #[test]
    fn normals_stay_only_where_they_say_something() {
        let tilted = Vec3::new(0.1, 0.0, 1.0);
        let normals_of = |normals: [Vec3; 3]| {
            let mut scene = Scene {
                positions: vec![DVec3::ZERO, DVec3::X, DVec3::ONE.with_z(0.0)],
                faces: vec![Face {
                    vertices: smallvec![0, 1, 2],
                    normals: normals.as_slice().into(),
                    ..Face::default()
                }],
                materials: vec![Material::default()],
                ..Scene::default()
            };
            settle_normals(&mut scene);
            scene.faces[0].normals.clone()
        };
        assert!(normals_of([Vec3::Z, 2.0 * Vec3::Z, Vec3::Z]).is_empty());
        assert!(normals_of([tilted, Vec3::ZERO, Vec3::Z]).is_empty());
        assert!(normals_of([tilted, -tilted, Vec3::Z]).is_empty());
        let kept = normals_of([tilted, Vec3::Z, 3.0 * tilted]);
        assert!(kept.len() == 3 && kept.iter().all(|n| n.is_normalized()), "{kept:?}");
    }
}
