//! Positions that differ by rounding only.

use std::collections::HashMap;

use glam::DVec3;
use smallvec::SmallVec;

use super::Scene;
use super::notes::note_count;

/// Places of 32-bit coordinates are known to this share of the coordinate.
const ROUNDING: f64 = 2.4e-7;

/// Nothing moves by more than this share of the shortest edge that ends there: a file of 64-bit coordinates far
/// from the origin may mean what it says.
const SHORTEST_EDGE: f64 = 1e-4;

/// Gives positions that differ by the rounding of 32-bit coordinates the index of the first of them.
pub(super) fn weld_rounded(scene: &mut Scene) {
    let reach = reaches(scene);
    let largest = reach.iter().copied().fold(0.0, f64::max);
    if largest == 0.0 {
        return;
    }
    let mut cells: HashMap<[i64; 3], SmallVec<[u32; 2]>> = HashMap::new();
    // Cells many reaches wide, so that nearly always only one is looked at.
    let cell = |p: DVec3| (p / (8.0 * largest)).floor().to_array().map(|x| x as i64);
    let mut index_of: Vec<u32> = (0..scene.positions.len() as u32).collect();
    let mut welded = 0;
    for (index, &position) in scene.positions.iter().enumerate() {
        let reach_here = reach[index];
        if reach_here == 0.0 {
            continue;
        }
        let is_same = |&&other: &&u32| {
            let apart = scene.positions[other as usize].distance(position);
            apart <= reach_here.min(reach[other as usize])
        };
        let (low, high) = (cell(position - reach_here), cell(position + reach_here));
        let around = (low[0]..=high[0]).flat_map(|x| {
            (low[1]..=high[1]).flat_map(move |y| (low[2]..=high[2]).map(move |z| [x, y, z]))
        });
        let found = around.filter_map(|place| cells.get(&place)).flatten().find(is_same).copied();
        match found {
            Some(first) => {
                index_of[index] = first;
                welded += 1;
            }
            None => cells.entry(cell(position)).or_default().push(index as u32),
        }
    }
    for vertex in scene.faces.iter_mut().flat_map(|face| &mut face.vertices) {
        *vertex = index_of[*vertex as usize];
    }
    note_count(&mut scene.notes, welded, "corner", "moved by rounding onto another");
}

/// How far each position may be from one that means the same, m; 0 for those no face uses.
fn reaches(scene: &Scene) -> Vec<f64> {
    let mut shortest = vec![f64::INFINITY; scene.positions.len()];
    for face in &scene.faces {
        let next = face.vertices.iter().cycle().skip(1);
        for (&a, &b) in face.vertices.iter().zip(next).filter(|(a, b)| a != b) {
            let length = scene.positions[a as usize].distance(scene.positions[b as usize]);
            for end in [a, b] {
                shortest[end as usize] = length.min(shortest[end as usize]);
            }
        }
    }
    let reach = |(position, shortest): (&DVec3, f64)| match shortest.is_finite() {
        true => (ROUNDING * position.abs().max_element()).min(SHORTEST_EDGE * shortest),
        false => 0.0,
    };
    scene.positions.iter().zip(shortest).map(reach).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Face;
    use smallvec::smallvec;

    /// Two triangles that nearly share an edge, moved and scaled.
    fn welded(apart: f64, offset: f64, size: f64) -> usize {
        let corners = [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [1.0, apart / size],
            [1.0, 1.0],
            [apart / size, 1.0],
        ];
        let place = |[x, y]: [f64; 2]| DVec3::new(offset + size * x, size * y, offset);
        let face = |vertices| Face { vertices, ..Face::default() };
        let mut scene = Scene {
            positions: corners.map(place).into(),
            faces: vec![face(smallvec![0, 1, 2]), face(smallvec![3, 4, 5])],
            ..Scene::default()
        };
        weld_rounded(&mut scene);
        scene.faces[1].vertices.iter().filter(|&&vertex| vertex < 3).count()
    }

    #[test]
    fn corners_apart_by_rounding_become_one() {
        assert_eq!(welded(1e-7, 1.0, 1.0), 2);
        assert_eq!(welded(1e-4, 550.0, 550.0), 2);
    }

    #[test]
    fn small_things_far_from_the_origin_keep_their_corners() {
        assert_eq!(welded(1e-3, 5e5, 0.1), 0);
        assert_eq!(welded(1e-5, 1.0, 1.0), 0);
    }
}
