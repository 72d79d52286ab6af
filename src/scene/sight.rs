//! The first face along a ray: for the few rays that reading a scene needs.

use glam::DVec3;
use rayon::prelude::*;

use super::Scene;
use super::boxes::{self, Bounds, Tree};
use super::polygon::{area_vector, flattened, triangulate};

/// What a ray meets first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    /// m.
    pub(super) distance: f64,
    /// True on the front, or on a face with two sides.
    pub(super) front: bool,
    /// True if the face emits light.
    pub(super) lamp: bool,
}

/// All faces as triangles.
pub(super) struct Sight<'a> {
    scene: &'a Scene,
    triangles: Vec<(u32, [DVec3; 3])>,
    /// Over the triangles.
    tree: Tree,
    /// Anything nearer than this is where the ray starts, m.
    nearest: f64,
}

/// Distances below this share of the scene's extent count as zero.
const NEAREST: f64 = 1e-7;

impl<'a> Sight<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let mut triangles = Vec::with_capacity(scene.faces.len());
        for (index, face) in scene.faces.iter().enumerate() {
            let corners = face.corners(&scene.positions);
            let pieces = match corners.len() {
                3 => vec![[0, 1, 2]],
                _ => {
                    let normal = area_vector(&corners).normalize_or_zero();
                    triangulate(&flattened(&corners, normal))
                }
            };
            let placed = pieces.into_iter().map(|piece| piece.map(|corner| corners[corner]));
            triangles.extend(placed.map(|piece| (index as u32, piece)));
        }
        let around = |(_, corners): &(u32, [DVec3; 3])| boxes::around(*corners);
        let tree = Tree::new(triangles.iter().map(around).collect());
        Self { scene, triangles, tree, nearest: NEAREST * scene.extent() }
    }

    /// Each with the index of its face.
    pub(super) fn triangles(&self) -> impl Iterator<Item = (u32, [DVec3; 3])> + '_ {
        self.triangles.iter().copied()
    }

    /// What each ray meets.
    pub(super) fn all(&self, rays: &[(DVec3, DVec3)]) -> Vec<Option<Hit>> {
        rays.par_iter().map(|&(start, direction)| self.first(start, direction)).collect()
    }

    /// What a ray from `start` along a unit `direction` meets.
    pub(super) fn first(&self, start: DVec3, direction: DVec3) -> Option<Hit> {
        let hits = self.hits(start, direction).into_iter();
        let (distance, front, face) = hits.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let material = &self.scene.materials[self.scene.faces[face as usize].material as usize];
        let lamp = material.emission.max_element() > 0.0;
        Some(Hit { distance, front: front || material.double_sided, lamp })
    }

    /// The face that a ray leaves the scene through.
    pub(super) fn last(&self, start: DVec3, direction: DVec3) -> Option<u32> {
        let hits = self.hits(start, direction).into_iter();
        hits.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(.., face)| face)
    }

    /// All that a ray meets: how far away, m, whether on its front, and which face.
    fn hits(&self, start: DVec3, direction: DVec3) -> Vec<(f64, bool, u32)> {
        let mut met = Vec::new();
        self.tree.find(|bounds| meets(start, direction, bounds, self.nearest), &mut met);
        let met = met.into_iter().map(|index| &self.triangles[index as usize]);
        let hit = |(face, corners): &(u32, [DVec3; 3])| {
            let (distance, front) = crossing(start, direction, corners)?;
            (distance > self.nearest).then_some((distance, front, *face))
        };
        met.filter_map(hit).collect()
    }
}

/// True if a ray comes as near as this to a box, m.
fn meets(start: DVec3, direction: DVec3, (low, high): Bounds, near: f64) -> bool {
    let (low, high) = (low - near - start, high + near - start);
    let (mut from, mut to) = (0.0, f64::INFINITY);
    for axis in 0..3 {
        if direction[axis] == 0.0 {
            if low[axis] > 0.0 || high[axis] < 0.0 {
                return false;
            }
            continue;
        }
        let (a, b) = (low[axis] / direction[axis], high[axis] / direction[axis]);
        (from, to) = (a.min(b).max(from), a.max(b).min(to));
    }
    from <= to
}

/// Distance to a triangle, and whether its front is met (Möller and Trumbore 1997).
fn crossing(start: DVec3, direction: DVec3, [a, b, c]: &[DVec3; 3]) -> Option<(f64, bool)> {
    let (u, v) = (b - a, c - a);
    let across = direction.cross(v);
    let volume = u.dot(across);
    if volume == 0.0 {
        return None;
    }
    let from = start - a;
    let s = from.dot(across) / volume;
    let aside = from.cross(u);
    let t = direction.dot(aside) / volume;
    let inside = s >= 0.0 && t >= 0.0 && s + t <= 1.0;
    inside.then(|| (v.dot(aside) / volume, volume > 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Face, Material};
    use smallvec::smallvec;

    #[test]
    fn the_nearest_face_is_met_from_its_side() {
        let face = |vertices| Face { vertices, ..Face::default() };
        let scene = Scene {
            positions: vec![
                DVec3::ZERO,
                DVec3::X,
                DVec3::new(1.0, 1.0, 0.0),
                DVec3::Y,
                DVec3::Z,
                DVec3::new(1.0, 0.0, 1.0),
                DVec3::ONE,
            ],
            faces: vec![face(smallvec![0, 1, 2, 3]), face(smallvec![4, 5, 6])],
            materials: vec![Material::default()],
            ..Scene::default()
        };
        let sight = Sight::new(&scene);
        let from = |z: f64| DVec3::new(0.6, 0.5, z);
        let seen = sight.all(&[
            (from(3.0), DVec3::NEG_Z),
            (from(0.5), DVec3::Z),
            (from(0.0), DVec3::NEG_Z),
            (DVec3::new(0.4, 0.5, 3.0), DVec3::NEG_Z),
        ]);
        let told: Vec<_> =
            seen.iter().map(|hit| hit.map(|hit| (hit.distance, hit.front))).collect();
        assert_eq!(told, [Some((2.0, true)), Some((0.5, false)), None, Some((3.0, true))]);
    }
}
