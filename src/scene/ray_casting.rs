//! The first face along a ray: for the few rays that reading a scene needs.

use glam::DVec3;
use rayon::prelude::*;

use super::Scene;
use crate::geometry::boxes::{self, Aabb, Tree};
use crate::geometry::{area_vector, flattened, triangulate};

/// A line from a point onwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProbeRay {
    /// m.
    pub(super) start: DVec3,
    /// A unit vector.
    pub(super) direction: DVec3,
}

/// What a ray meets first.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceHit {
    /// m.
    pub(super) distance: f64,
    /// True on the front, or on a face with two sides.
    pub(super) front: bool,
    /// True if the face emits light.
    pub(super) lamp: bool,
}

/// Where a ray crosses a face.
struct FaceCrossing {
    /// m.
    distance: f64,
    /// True if the ray comes from the front.
    front: bool,
    face: u32,
}

/// All faces as triangles.
pub(super) struct RayCaster<'a> {
    scene: &'a Scene,
    triangles: Vec<(u32, [DVec3; 3])>,
    /// Over the triangles.
    tree: Tree,
    /// Anything nearer than this is where the ray starts, m.
    nearest: f64,
}

/// Distances below this share of the scene's extent count as zero.
const NEAREST: f64 = 1e-7;

impl<'a> RayCaster<'a> {
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
    pub(super) fn all(&self, rays: &[ProbeRay]) -> Vec<Option<FaceHit>> {
        rays.par_iter().map(|ray| self.first(ray)).collect()
    }

    /// What a ray meets first.
    pub(super) fn first(&self, ray: &ProbeRay) -> Option<FaceHit> {
        let crossings = self.crossings(ray).into_iter();
        let nearest = crossings.min_by(|a, b| a.distance.total_cmp(&b.distance))?;
        let face = &self.scene.faces[nearest.face as usize];
        let material = &self.scene[face.material];
        Some(FaceHit {
            distance: nearest.distance,
            front: nearest.front || material.double_sided,
            lamp: material.emission.max_element() > 0.0,
        })
    }

    /// The face that a ray leaves the scene through.
    pub(super) fn last(&self, ray: &ProbeRay) -> Option<u32> {
        let crossings = self.crossings(ray).into_iter();
        let furthest = crossings.max_by(|a, b| a.distance.total_cmp(&b.distance));
        furthest.map(|crossing| crossing.face)
    }

    /// All that a ray meets.
    fn crossings(&self, ray: &ProbeRay) -> Vec<FaceCrossing> {
        let mut met = Vec::new();
        self.tree.find(|bounds| ray.meets(bounds, self.nearest), &mut met);
        let met = met.into_iter().map(|index| &self.triangles[index as usize]);
        let crossing = |&(face, ref corners): &(u32, [DVec3; 3])| {
            let (distance, front) = ray.crossing(corners)?;
            (distance > self.nearest).then_some(FaceCrossing { distance, front, face })
        };
        met.filter_map(crossing).collect()
    }
}

impl ProbeRay {
    /// True if it comes as near as this to a box, m.
    fn meets(&self, bounds: Aabb, near: f64) -> bool {
        let (low, high) = (bounds.low - near - self.start, bounds.high + near - self.start);
        let (mut from, mut to) = (0.0, f64::INFINITY);
        for axis in 0..3 {
            let along = self.direction[axis];
            if along == 0.0 {
                if low[axis] > 0.0 || high[axis] < 0.0 {
                    return false;
                }
                continue;
            }
            let (a, b) = (low[axis] / along, high[axis] / along);
            (from, to) = (a.min(b).max(from), a.max(b).min(to));
        }
        from <= to
    }

    /// Distance to a triangle, and whether its front is met (Möller and Trumbore 1997).
    fn crossing(&self, [a, b, c]: &[DVec3; 3]) -> Option<(f64, bool)> {
        let (u, v) = (b - a, c - a);
        let across = self.direction.cross(v);
        let volume = u.dot(across);
        if volume == 0.0 {
            return None;
        }
        let from = self.start - a;
        let s = from.dot(across) / volume;
        let aside = from.cross(u);
        let t = self.direction.dot(aside) / volume;
        let inside = s >= 0.0 && t >= 0.0 && s + t <= 1.0;
        inside.then(|| (v.dot(aside) / volume, volume > 0.0))
    }
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
        let caster = RayCaster::new(&scene);
        let ray =
            |x: f64, z: f64, direction: DVec3| ProbeRay { start: DVec3::new(x, 0.5, z), direction };
        let seen = caster.all(&[
            ray(0.6, 3.0, DVec3::NEG_Z),
            ray(0.6, 0.5, DVec3::Z),
            ray(0.6, 0.0, DVec3::NEG_Z),
            ray(0.4, 3.0, DVec3::NEG_Z),
        ]);
        let told: Vec<_> =
            seen.iter().map(|hit| hit.map(|hit| (hit.distance, hit.front))).collect();
        assert_eq!(told, [Some((2.0, true)), Some((0.5, false)), None, Some((3.0, true))]);
    }
}
