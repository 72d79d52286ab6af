//! From the faces of a scene to its surfaces: joined, cut along their masks and where they overlap, and where they
//! touch.

use glam::{DAffine2, DMat2, DVec2};

use super::merge::PlanarRegion;
use super::model::{EPSILON, Surface, Surfaces};
use super::{contact, mask, merge, outliers, overlap};
use crate::geometry::polygon::Ring;
use crate::scene::Scene;

/// The surfaces of a scene and their contact lines; none, with a [flaw](Surfaces::flaw), of one that was made in code
/// and says what cannot be.
pub fn surfaces_of(scene: &Scene) -> Surfaces {
    if let Some(flaw) = scene.flaw() {
        return Surfaces::none(flaw);
    }
    let regions = merge::regions(scene, EPSILON * scene.extent());
    let mut notes = Vec::new();
    let regions = mask::cut(scene, regions, &mut notes);
    let regions = overlap::without_overlaps(scene, regions, &mut notes);
    with_contacts(of_regions(scene, regions), notes)
}

/// The faces of a scene, each a surface of its own, or several if its material has holes, and their contact lines; or a
/// [flaw](Surfaces::flaw).
pub fn faces_of(scene: &Scene) -> Surfaces {
    if let Some(flaw) = scene.flaw() {
        return Surfaces::none(flaw);
    }
    let mut notes = Vec::new();
    let regions = mask::cut(scene, merge::single_faces(scene), &mut notes);
    with_contacts(of_regions(scene, regions), notes)
}

fn with_contacts(mut surfaces: Surfaces, notes: Vec<String>) -> Surfaces {
    if surfaces.list.is_empty() {
        return Surfaces::none("cut-outs leave nothing of the scene's faces".to_owned());
    }
    contact::find_contacts(&mut surfaces.list, surfaces.extent, surfaces.epsilon);
    Surfaces { notes, ..surfaces }
}

fn of_regions(scene: &Scene, regions: Vec<PlanarRegion>) -> Surfaces {
    let mut list = Vec::new();
    for region in regions {
        if region.rings.is_empty() {
            continue;
        }
        let front = Surface::front(scene, region);
        let back = front.two_sided.then(|| front.back());
        list.push(front);
        list.extend(back);
    }
    let extent = outliers::usual_extent(&list);
    let epsilon = EPSILON * extent;
    Surfaces {
        list,
        objects: scene.objects.clone(),
        nodes: scene.nodes.clone(),
        cameras: scene.cameras.clone(),
        lights: scene.lights.clone(),
        materials: scene.materials.clone(),
        textures: scene.textures.clone(),
        extent,
        epsilon,
        notes: Vec::new(),
        flaw: None,
    }
}

impl Surfaces {
    /// Those of a scene that cannot be looked at.
    fn none(flaw: String) -> Self {
        Self { flaw: Some(flaw), ..of_regions(&Scene::default(), Vec::new()) }
    }
}

impl Surface {
    fn front(scene: &Scene, region: PlanarRegion) -> Self {
        let face = &scene.faces[region.faces[0]];
        let material = &scene[face.material];
        Self {
            plane: region.plane,
            rings: region.rings,
            contacts: Vec::new(),
            reflectance: material.reflectance,
            tint: region.attributes.tint,
            exitance: material.emission * std::f64::consts::PI,
            material: face.material,
            object: face.object,
            uv: region.attributes.uv,
            normals: region.normals,
            two_sided: material.double_sided,
            is_back: false,
        }
    }

    /// The other side of a double-sided polygon: the same places, seen from behind.
    fn back(&self) -> Self {
        let swap = |ring: &Ring| ring.iter().rev().map(|p| DVec2::new(p.y, p.x)).collect();
        Self {
            plane: self.plane.reversed(),
            rings: self.rings.iter().map(swap).collect(),
            uv: self.uv.map(|uv| uv * DAffine2::from_mat2(SWAP)),
            tint: self.tint.reversed(),
            normals: self.normals.iter().rev().map(|&n| -n).collect(),
            is_back: true,
            ..self.clone()
        }
    }
}

/// Exchanges the two coordinates.
const SWAP: DMat2 = DMat2::from_cols(DVec2::Y, DVec2::X);
