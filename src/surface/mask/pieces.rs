//! The pieces that a region is cut into, with the normals of the curved surface that it approximates.

use glam::{DVec2, DVec3};

use crate::geometry::polygon::Ring;
use crate::scene::{Face, Scene};
use crate::surface::merge::PlanarRegion;
use crate::surface::tint::Widest;

/// The pieces of a region, each a region of its own.
pub(super) fn split(
    scene: &Scene,
    region: &PlanarRegion,
    pieces: Vec<Vec<Ring>>,
) -> Vec<PlanarRegion> {
    let face = &scene.faces[region.faces[0]];
    let slopes = (!region.normals.is_empty()).then(|| Normals::of(scene, region, face)).flatten();
    let piece = |rings: Vec<Ring>| {
        let outer = rings.first().into_iter().flatten();
        let normals = slopes.as_ref().map(|slopes| outer.map(|&p| slopes.at(p)).collect());
        let &PlanarRegion { plane, attributes, .. } = region;
        let (faces, normals) = (region.faces.clone(), normals.unwrap_or_default());
        PlanarRegion { plane, faces, rings, attributes, normals }
    };
    pieces.into_iter().map(piece).collect()
}

/// How the normals at a face's corners go on between them.
struct Normals {
    place: DVec2,
    normal: DVec3,
    slopes: [DVec3; 2],
}

impl Normals {
    fn of(scene: &Scene, region: &PlanarRegion, face: &Face) -> Option<Self> {
        let places: Vec<DVec2> =
            face.corners(&scene.positions).into_iter().map(|p| region.plane.flatten(p)).collect();
        let widest = Widest::of(&places)?;
        let normal = *region.normals.get(widest.corner)?;
        let [next, last] =
            widest.neighbours(region.normals.len()).map(|k| region.normals[k] - normal);
        let slopes = [0, 1].map(|axis| {
            let share = widest.inverse.col(axis);
            next * share.x + last * share.y
        });
        Some(Self { place: places[widest.corner], normal, slopes })
    }

    fn at(&self, place: DVec2) -> DVec3 {
        let DVec2 { x, y } = place - self.place;
        (self.normal + self.slopes[0] * x + self.slopes[1] * y).normalize_or(self.normal)
    }
}
