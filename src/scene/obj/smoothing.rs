//! Corner normals from smoothing groups.

use std::collections::HashMap;

use glam::DVec3;

use super::scan::FaceLine;
use crate::geometry::area_vector;
use crate::scene::{Face, Scene};

/// An object, a smoothing group in it, and the bits of a position.
type SmoothingKey = (u32, u32, [u64; 3]);

/// Gives faces in a smoothing group, and without normals of their own, the area-weighted mean
/// normal of the group's faces of the same object around each corner.
pub(super) fn smooth(scene: &mut Scene, lines: &[FaceLine]) {
    let places = &scene.positions;
    let mut sums: HashMap<SmoothingKey, DVec3> = HashMap::new();
    for (face, line) in scene.faces.iter().zip(lines).filter(|(_, line)| line.smoothing > 0) {
        let corners: Vec<DVec3> = corners(places, face).collect();
        let normal = area_vector(&corners);
        for position in corners {
            *sums.entry(spot(line, position)).or_default() += normal;
        }
    }
    for (face, line) in scene.faces.iter_mut().zip(lines) {
        if line.smoothing > 0 && face.normals.is_empty() {
            let mean = |position| sums.get(&spot(line, position)).copied().unwrap_or_default();
            face.normals = corners(places, face)
                .map(|position| mean(position).normalize_or_zero().as_vec3())
                .collect();
        }
    }
}

fn corners<'a>(places: &'a [DVec3], face: &'a Face) -> impl Iterator<Item = DVec3> + 'a {
    face.vertices.iter().map(|&vertex| places[vertex as usize])
}

fn spot(line: &FaceLine, position: DVec3) -> SmoothingKey {
    // Adding zero makes -0 and 0 one place.
    (line.object, line.smoothing, (position + DVec3::ZERO).to_array().map(f64::to_bits))
}
