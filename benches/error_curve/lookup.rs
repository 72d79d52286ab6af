//! Which triangle of a mesh holds a place.

use std::collections::HashMap;

use glam::{DVec3, IVec3};
use radiosity::TriMesh;
use radiosity::colour::Rgb;

/// Cells of the grid along the extent of the scene.
const CELLS: f64 = 100.0;

/// Cosine of the largest angle between normals that count as the same.
const SAME_NORMAL: f64 = 0.999;

/// Places this far off a triangle, as a share of the extent, are still on it.
const SLACK: f64 = 1e-5;

/// The triangles of a mesh, by the cells of a grid that their boxes touch.
pub(crate) struct Lookup<'a> {
    mesh: &'a TriMesh,
    cells: HashMap<IVec3, Vec<u32>>,
    cell: f64,
    slack: f64,
}

impl<'a> Lookup<'a> {
    /// A lookup in a mesh of a scene of this extent, m.
    pub(crate) fn new(mesh: &'a TriMesh, extent: f64) -> Self {
        let (cell, slack) = (extent / CELLS, extent * SLACK);
        let mut cells: HashMap<IVec3, Vec<u32>> = HashMap::new();
        for (number, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
            let low = ((a.min(b).min(c) - slack) / cell).floor().as_ivec3();
            let high = ((a.max(b).max(c) + slack) / cell).floor().as_ivec3();
            for x in low.x..=high.x {
                for y in low.y..=high.y {
                    for z in low.z..=high.z {
                        cells.entry(IVec3::new(x, y, z)).or_default().push(number as u32);
                    }
                }
            }
        }
        Self { mesh, cells, cell, slack }
    }

    /// Values at the vertices, interpolated at a place on a surface with this normal.
    pub(crate) fn at(
        &self,
        (place, normal): (DVec3, DVec3),
        value: impl Fn(usize) -> Rgb,
    ) -> Option<Rgb> {
        let near = self.cells.get(&(place / self.cell).floor().as_ivec3())?;
        let holds = |&number: &u32| {
            let triangle = self.mesh.triangles[number as usize];
            self.weights((place, normal), triangle).map(|weights| (triangle, weights))
        };
        let inner = |weights: &[f64; 3]| weights.iter().copied().fold(f64::INFINITY, f64::min);
        let found = near.iter().filter_map(holds);
        let (triangle, weights) = found.max_by(|a, b| inner(&a.1).total_cmp(&inner(&b.1)))?;
        let parts = triangle.iter().zip(weights);
        Some(parts.map(|(&vertex, weight)| value(vertex as usize) * weight).sum())
    }

    /// Barycentric coordinates of a place in a triangle, if it lies there.
    fn weights(&self, (place, normal): (DVec3, DVec3), triangle: [u32; 3]) -> Option<[f64; 3]> {
        let [a, b, c] = triangle.map(|vertex| self.mesh.positions[vertex as usize]);
        let across = (b - a).cross(c - a);
        let double = across.length();
        let facing = across.dot(normal) >= SAME_NORMAL * double && double > 0.0;
        if !facing || (place - a).dot(normal).abs() > self.slack {
            return None;
        }
        let up = across / double;
        let heights = [(b, c), (c, a), (a, b)]
            .map(|(p, q): (DVec3, DVec3)| ((q - p).cross(place - p).dot(up), p.distance(q)));
        let inside = heights.iter().all(|&(height, length)| height >= -self.slack * length);
        inside.then(|| heights.map(|(height, _)| height / double))
    }
}
