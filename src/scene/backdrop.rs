//! Domes and backdrops round a scene, which keep the light of sun and sky out.

use glam::DVec3;

use super::ray_casting::{ProbeRay, RayCaster};
use super::sequence::{on_sphere, on_triangle, spread};
use super::{Face, Light, MaterialId, Scene};

/// Places that look for the sun, and for the sky, these in so many directions each.
const SUN_PLACES: usize = 2048;
const SKY_PLACES: usize = 256;
const SKY_DIRECTIONS: usize = 64;

/// One of a scene's materials or objects.
#[derive(Clone, Copy)]
enum Surround {
    Material(MaterialId),
    Object(u32),
}

impl Surround {
    fn has(self, face: &Face) -> bool {
        match self {
            Self::Material(material) => face.material == material,
            Self::Object(object) => face.object == object,
        }
    }
}

impl Scene {
    /// Tells if one material or object goes all round the rest and lets no light of sun and sky in.
    ///
    /// Where the scene has neither, there is nothing to tell.
    pub fn note_backdrop(&mut self) {
        let Some(group) = self.backdrop() else { return };
        let around = match group {
            Surround::Material(_) => "material",
            Surround::Object(_) => "object",
        };
        let (name, mut materials) = match group {
            Surround::Material(id) => (self[id].name.clone(), vec![id]),
            Surround::Object(index) => {
                let faces = self.faces.iter().filter(|face| face.object == index);
                (self.objects[index as usize].clone(), faces.map(|face| face.material).collect())
            }
        };
        materials.sort_unstable();
        materials.dedup();
        let tables = materials.iter().map(|&id| &self[id].name);
        let tables: Vec<String> = tables.map(|name| format!("[\"{name}\"]")).collect();
        self.notes.push(format!(
            "{around} \"{name}\" goes round all the rest and keeps sun and sky out; if it is a backdrop, leave it out: \
             --materials with `removed = true` under {}",
            tables.join(", ")
        ));
    }

    /// What hides sun and sky from all that is not part of it.
    fn backdrop(&self) -> Option<Surround> {
        let lights: Vec<&Light> = self.lights.iter().map(|named| &named.light).collect();
        let lights: Vec<&Light> =
            lights.into_iter().filter(|light| light.position().is_none()).collect();
        let first = self.faces.first().filter(|_| !lights.is_empty())?;
        let caster = RayCaster::new(self);
        let (low, high) = self.bounds()?;
        let upward = ProbeRay { start: low.midpoint(high), direction: DVec3::Y };
        let above = caster.last(&upward).map(|face| &self.faces[face as usize]);
        let face = above.unwrap_or(first);
        [Surround::Material(face.material), Surround::Object(face.object)]
            .into_iter()
            .find(|&group| lights.iter().all(|light| self.hides(&caster, group, light)))
    }

    /// Whether a light from far away reaches nothing but a group.
    fn hides(&self, caster: &RayCaster<'_>, group: Surround, light: &Light) -> bool {
        let others: Vec<[DVec3; 3]> = caster
            .triangles()
            .filter(|(face, _)| !group.has(&self.faces[*face as usize]))
            .map(|(_, corners)| corners)
            .collect();
        let is_hidden = |start: DVec3, direction: DVec3| {
            let last = caster.last(&ProbeRay { start, direction });
            last.is_some_and(|face| group.has(&self.faces[face as usize]))
        };
        let towards = match *light {
            Light::Sun { direction, .. } | Light::Directional { direction, .. } => Some(-direction),
            _ => None,
        };
        let places = if towards.is_some() { SUN_PLACES } else { SKY_PLACES };
        let hides_from = |place: DVec3| match towards {
            Some(direction) => is_hidden(place, direction),
            None => (0..SKY_DIRECTIONS).all(|index| {
                let [u, v, ..] = spread(index);
                is_hidden(place, on_sphere(0.5 + 0.5 * u, v))
            }),
        };
        !others.is_empty() && spread_over(&others, places).all(hides_from)
    }
}

/// So many places on triangles, as many on each as its share of their area.
fn spread_over(triangles: &[[DVec3; 3]], count: usize) -> impl Iterator<Item = DVec3> + '_ {
    let mut area = 0.0;
    let upto = |[a, b, c]: &[DVec3; 3]| {
        area += (b - a).cross(c - a).length();
        area
    };
    let areas: Vec<f64> = triangles.iter().map(upto).collect();
    (0..count).map(move |index| {
        let passed = (index as f64 + 0.5) / count as f64 * area;
        let number = areas.partition_point(|&upto| upto <= passed).min(triangles.len() - 1);
        let [s, t, ..] = spread(index);
        on_triangle(triangles[number], s, t)
    })
}
