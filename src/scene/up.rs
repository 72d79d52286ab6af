//! The unit of a file and which axis is up in it, and how the scene is laid in metres so that it is Y.

use std::collections::BTreeSet;

use glam::DVec3;

use super::notes::listed;
use super::{Light, NamedLight, Scene};
use crate::geometry::area_vector;

/// The axis of a file that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// As everywhere in this program.
    #[default]
    Y,
    /// As in most programs for buildings and machines; x, y, z become x, z, -y, so that +Y, north on
    /// most plans, becomes -Z.
    Z,
}

impl Up {
    /// A vector of the file in the scene.
    fn laid(self, vector: DVec3) -> DVec3 {
        match self {
            Self::Y => vector,
            Self::Z => DVec3::new(vector.x, vector.z, -vector.y),
        }
    }
}

/// Brings a scene as it was read into metres, with Y up.
pub(super) fn lay(scene: &mut Scene, metres_per_unit: f64, up: Up) {
    if (metres_per_unit, up) == (1.0, Up::Y) {
        return;
    }
    let place = |place: &mut DVec3| *place = metres_per_unit * up.laid(*place);
    let turn = |vector: &mut DVec3| *vector = up.laid(*vector);
    scene.positions.iter_mut().for_each(place);
    for normal in scene.faces.iter_mut().flat_map(|face| &mut face.normals) {
        *normal = up.laid(normal.as_dvec3()).as_vec3();
    }
    for camera in &mut scene.cameras {
        [&mut camera.eye, &mut camera.target].into_iter().for_each(place);
        turn(&mut camera.up);
    }
    for NamedLight { light, .. } in &mut scene.lights {
        match light {
            Light::Point { position, .. } | Light::Luminaire { position, .. } => place(position),
            Light::Spot { position, direction, .. } => {
                place(position);
                turn(direction);
            }
            Light::Directional { direction, .. } | Light::Sun { direction, .. } => turn(direction),
            Light::Sky { .. } => {}
        }
    }
}

/// What names of materials and objects call horizontal things.
const LEVEL: [&str; 3] = ["floor", "ceiling", "ground"];

/// Share of the area of floors and ceilings that stands upright when the wrong axis is up.
const NEARLY_ALL: f64 = 0.9;

/// Cosine of 2°.
const ALONG: f64 = 0.999;

/// Tells if what is called a floor or a ceiling stands upright, across Z: then the other axis is up.
///
/// Nothing else tells the axes of a file apart: rooms may be as high as they are wide.
pub(super) fn note_standing_floors(scene: &mut Scene, up: Up) {
    let (mut all, mut across) = (0.0, 0.0);
    let mut names = BTreeSet::new();
    for face in &scene.faces {
        let material = &scene[face.material].name;
        let object = scene.objects.get(face.object as usize);
        let is_level = |name: &&String| {
            let name = name.to_lowercase();
            LEVEL.iter().any(|word| name.contains(word))
        };
        let Some(name) = [Some(material), object].into_iter().flatten().find(is_level) else {
            continue;
        };
        let area = area_vector(&face.corners(&scene.positions));
        all += area.length();
        if area.z.abs() > ALONG * area.length() {
            across += area.length();
            names.insert(name.clone());
        }
    }
    if across > 0.0 && across > NEARLY_ALL * all {
        let names = listed(&names.into_iter().collect::<Vec<_>>());
        let (axis, option) = match up {
            Up::Y => ("Z", "--up z"),
            Up::Z => ("Y", "--up y"),
        };
        scene
            .notes
            .push(format!("{names} stand upright: if {axis} is up in the file, use {option}"));
    }
}
