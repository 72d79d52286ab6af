//! Which triangle of a mesh a place belongs to.

use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use smallvec::SmallVec;

use crate::colour::Rgb;
use crate::geometry::hierarchy::hierarchy;
use crate::reconstruct::TriMesh;

/// Cosine of the largest angle between normals that count as the same: 25°.
const SAME_NORMAL: f64 = 0.906_307_787_036_65;

/// Farther from all triangles than this share of the extent, a place belongs to none.
const FARTHEST: f64 = 1e-3;

/// Finds triangles by places.
pub struct Locator<'a> {
    mesh: &'a TriMesh,
    tree: Bvh2,
    centre: DVec3,
    farthest: f64,
    textured: Vec<Option<u32>>,
}

impl std::fmt::Debug for Locator<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Locator").field("triangles", &self.mesh.triangles.len()).finish()
    }
}

/// A place on a triangle.
#[derive(Clone, Copy, Debug)]
struct Spot {
    triangle: usize,
    weights: DVec3,
    distance: f64,
}

impl<'a> Locator<'a> {
    /// A locator in the mesh of a scene of this extent, m.
    pub fn new(mesh: &'a TriMesh, extent: f64) -> Self {
        let corner = |v: u32| mesh.positions[v as usize];
        let (low, high) = mesh.bounds();
        let centre = low.midpoint(high);
        // Grown so that rounding to 32 bits loses nothing.
        let margin = Vec3A::splat((1e-6 * extent) as f32);
        let bounds = |triangle: &[u32; 3]| {
            let at = triangle.map(|v| (corner(v) - centre).as_vec3a());
            let tight = Aabb::from_points(&at);
            Aabb::new(tight.min - margin, tight.max + margin)
        };
        let boxes: Vec<Aabb> = mesh.triangles.iter().map(bounds).collect();
        let mut textured = vec![None; mesh.triangles.len()];
        for part in &mesh.parts {
            textured[part.triangles.clone()].fill(part.texture);
        }
        Self { mesh, tree: hierarchy(&boxes), centre, farthest: FARTHEST * extent, textured }
    }

    /// Radiosity, W/m², of the nearest triangle that faces within 25° of `normal`, at its place nearest to
    /// `place`; `None` if there is none within a thousandth of the scene's extent.
    ///
    /// On textured parts the light is that of the texel.
    pub fn radiosity(&self, place: DVec3, normal: DVec3) -> Option<Rgb> {
        let Spot { triangle, weights, .. } = self.nearest(place, normal)?;
        let corners = self.mesh.triangles[triangle].map(|v| v as usize);
        let blend = |values: &[Rgb]| -> Rgb {
            corners.iter().zip(weights.to_array()).map(|(&v, weight)| values[v] * weight).sum()
        };
        let radiosity = blend(&self.mesh.radiosity);
        let Some(texture) = self.textured[triangle] else { return Some(radiosity) };
        let uv = |k: usize| self.mesh.uvs[corners[k]].as_dvec2() * weights[k];
        let texel = self.mesh.textures[texture as usize].sample(uv(0) + uv(1) + uv(2));
        Some(radiosity * texel / blend(&self.mesh.texture_mean).max(Rgb::splat(f64::MIN_POSITIVE)))
    }

    /// Irradiance by reflected light, W/m², at the same place; `None` also in a mesh read from a file.
    pub fn indirect(&self, place: DVec3, normal: DVec3) -> Option<Rgb> {
        let Spot { triangle, weights, .. } = self.nearest(place, normal)?;
        let corners = self.mesh.triangles[triangle].into_iter().zip(weights.to_array());
        corners.map(|(v, w)| Some(self.mesh.irradiance.get(v as usize)?.indirect * w)).sum()
    }

    fn nearest(&self, place: DVec3, normal: DVec3) -> Option<Spot> {
        let from = (place - self.centre).as_vec3a();
        let mut best: Option<Spot> = None;
        let mut farthest = self.farthest;
        let mut stack: SmallVec<[u32; 64]> = SmallVec::new();
        if !self.mesh.triangles.is_empty() {
            stack.push(0);
        }
        while let Some(index) = stack.pop() {
            let node = &self.tree.nodes[index as usize];
            let bounds = node.aabb();
            let gap = (bounds.min - from).max(from - bounds.max).max(Vec3A::ZERO).length();
            if f64::from(gap) > farthest {
                continue;
            }
            if !node.is_leaf() {
                stack.extend([node.first_index + 1, node.first_index]);
                continue;
            }
            let slots = node.first_index..node.first_index + node.prim_count;
            for triangle in slots.map(|slot| self.tree.primitive_indices[slot as usize] as usize) {
                let Some(spot) = self.spot(triangle, place, normal) else { continue };
                // Of equally near ones the first, whatever the tree's order.
                let nearer = best
                    .is_none_or(|best| (spot.distance, triangle) < (best.distance, best.triangle));
                if spot.distance <= farthest && nearer {
                    (farthest, best) = (spot.distance, Some(spot));
                }
            }
        }
        best
    }

    /// The place on a triangle that is nearest to another, if it faces the same way.
    fn spot(&self, triangle: usize, place: DVec3, normal: DVec3) -> Option<Spot> {
        let corners = self.mesh.triangles[triangle].map(|v| self.mesh.positions[v as usize]);
        let [a, b, c] = corners;
        let up = (b - a).cross(c - a).try_normalize()?;
        if up.dot(normal) < SAME_NORMAL {
            return None;
        }
        let weights = nearest_weights(corners, place, up);
        let at = a * weights.x + b * weights.y + c * weights.z;
        Some(Spot { triangle, weights, distance: at.distance(place) })
    }
}

/// Barycentric coordinates of the place on a triangle with unit normal `up` that is nearest to another.
fn nearest_weights([a, b, c]: [DVec3; 3], place: DVec3, up: DVec3) -> DVec3 {
    let side = |from: DVec3, to: DVec3| (to - from).cross(place - from).dot(up);
    let weights = DVec3::new(side(b, c), side(c, a), side(a, b));
    if weights.min_element() >= 0.0 {
        return weights / weights.element_sum();
    }
    // Outside, it is on an edge.
    let along = |from: DVec3, to: DVec3| {
        let edge = to - from;
        let share = ((place - from).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
        (share, (from + edge * share).distance(place))
    };
    let edges = [(a, b), (b, c), (c, a)].map(|(from, to)| along(from, to));
    let nearest = (0..3).min_by(|&i, &j| edges[i].1.total_cmp(&edges[j].1)).unwrap_or_default();
    let mut weights = DVec3::ZERO;
    weights[nearest] = 1.0 - edges[nearest].0;
    weights[(nearest + 1) % 3] = edges[nearest].0;
    weights
}
