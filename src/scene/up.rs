//! Which axis of an OBJ file is up, and how the scene is laid so that it is Y.

use std::collections::BTreeSet;

use super::notes::listed;
use super::{Scene, area_vector};

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
    /// Turns triples of coordinates so that Y is up.
    pub(super) fn lay(self, coordinates: &mut [f64]) {
        if self == Self::Y {
            return;
        }
        for point in coordinates.chunks_exact_mut(3) {
            (point[1], point[2]) = (point[2], -point[1]);
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
        let material = &scene.materials[face.material as usize].name;
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
