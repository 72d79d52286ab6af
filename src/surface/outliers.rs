//! The size of a scene as its rooms and things have it, not the plain on which they stand.

use glam::DVec3;

use super::model::Surface;

/// A surface this many times as large as everything smaller is left aside.
const OUT_OF_SCALE: f64 = 12.0;

/// Fewer surfaces than this make no room.
const FEWEST: usize = 6;

/// Diagonal of the bounding box of all surfaces but those out of scale, m; 0 without surfaces.
pub(super) fn usual_extent(surfaces: &[Surface]) -> f64 {
    let mut bounds: Vec<(DVec3, DVec3)> = surfaces.iter().map(Surface::bounds).collect();
    let size = |(low, high): &(DVec3, DVec3)| low.distance(*high);
    bounds.sort_by(|a, b| size(a).total_cmp(&size(b)));
    // Around each and all smaller ones.
    let mut around = Vec::with_capacity(bounds.len());
    let mut all = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (low, high) in &bounds {
        all = (all.0.min(*low), all.1.max(*high));
        around.push(size(&all));
    }
    let mut count = bounds.len();
    while count > FEWEST && size(&bounds[count - 1]) > OUT_OF_SCALE * around[count - 2] {
        count -= 1;
    }
    count.checked_sub(1).map_or(0.0, |last| around[last])
}

#[cfg(test)]
mod tests {
    use crate::scene::{Face, Material, Scene};
    use crate::surface::surfaces_of;
    use glam::DVec3;

    /// Faces of a cube of 4 m, and a square of this size under it.
    fn extent(ground: f64) -> f64 {
        let corner = |k: u32| {
            4.0 * DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2 & 1))
        };
        let mut positions: Vec<DVec3> = (0..8).map(corner).collect();
        positions.extend([(0, 0), (0, 1), (1, 1), (1, 0)].map(|(x, z)| {
            ground * DVec3::new(f64::from(x) - 0.5, 0.0, f64::from(z) - 0.5) - 0.5 * DVec3::Y
        }));
        let faces: [[u32; 4]; 7] = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [8, 9, 10, 11],
        ];
        let face = |v: [u32; 4]| Face { vertices: v.as_slice().into(), ..Face::default() };
        let surfaces = surfaces_of(&Scene {
            positions,
            faces: faces.map(face).into(),
            materials: vec![Material::default()],
            ..Scene::default()
        });
        assert!((surfaces.area() - 96.0 - ground * ground).abs() < 1e-6);
        surfaces.extent
    }

    #[test]
    fn a_plain_does_not_set_the_scale_and_a_floor_does() {
        assert!((extent(300.0) - 4.0 * 3f64.sqrt()).abs() < 1e-9);
        assert!(extent(20.0) > 28.0);
    }
}
