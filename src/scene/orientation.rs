//! Which sides of faces reflect and emit: what the file says, what the user says, or what light finds.

use glam::DVec3;

use super::daylight::{FEWEST_ENTERED, entering};
use super::ray_casting::{ProbeRay, RayCaster};
use super::sequence::{on_sphere, on_triangle, spread};
use super::{Face, Light, NamedLight, Scene};
use crate::colour::luminance;

/// Which sides of faces reflect and emit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sides {
    /// What the file says, unless lamps would shine on backs only: see [`settle_sides`].
    #[default]
    Auto,
    /// What the file says.
    AsWritten,
    /// Both sides of all faces.
    Both,
    /// What the file says, with every face turned over.
    Flipped,
}

/// Turns faces over or opens their backs, as `sides` says, with a note where the file is overruled.
///
/// [`Sides::Auto`] follows light from lamps to the first face. If it meets hardly any front, but what
/// leaves the lamps' backs meets backs, everything was modelled inside out and is turned over. If it
/// meets more backs than fronts, all faces but the lamps get two sides. So they do if there are no lamps and
/// light from outside, where it enters a room, meets more backs than fronts. Else the file is right.
pub fn settle_sides(scene: &mut Scene, sides: Sides) {
    match sides {
        Sides::AsWritten => {}
        Sides::Both => scene.materials.iter_mut().for_each(|material| material.double_sided = true),
        Sides::Flipped => scene.faces.iter_mut().for_each(turn_over),
        Sides::Auto => follow_light(scene),
    }
}

fn follow_light(scene: &mut Scene) {
    let survey = LampSurvey::in_scene(scene);
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    if survey.is_inside_out() {
        scene.faces.iter_mut().for_each(turn_over);
        scene.notes.push(format!(
            "all faces turned over: they showed lamps their backs ({} of the light behind lamps fell on backs, {} of \
             that before them on fronts); --two-sided off keeps them",
            percent(survey.behind),
            percent(survey.fronts)
        ));
    } else if survey.backs > survey.fronts || survey.enters_behind() {
        let lamps = |emission: DVec3| emission.max_element() > 0.0;
        for material in scene.materials.iter_mut().filter(|material| !lamps(material.emission)) {
            material.double_sided = true;
        }
        let light = match survey.enters_behind() {
            true => "light that enters rooms from outside".to_owned(),
            false => format!("{} of the light from lamps", percent(survey.backs)),
        };
        scene.notes.push(format!(
            "both sides of faces reflect: {light} fell on backs; --two-sided off leaves those black"
        ));
    } else if survey.backs > WORTH_TELLING {
        scene.notes.push(format!(
            "{} of the light from lamps falls on backs, which are black; --two-sided on lights them",
            percent(survey.backs)
        ));
    }
}

/// The same polygon seen from its other side.
fn turn_over(face: &mut Face) {
    face.vertices.reverse();
    face.normals.reverse();
    face.normals.iter_mut().for_each(|normal| *normal = -*normal);
    face.uvs.reverse();
}

/// Share of light on backs that a user should hear of.
const WORTH_TELLING: f64 = 0.2;

/// Share of light on fronts below which a room is as good as black.
const HARDLY_ANY: f64 = 0.1;

/// Rays from lamps.
const RAYS: usize = 512;

/// Where the light of lamps goes, as shares of it.
#[derive(Debug, Default)]
struct LampSurvey {
    /// On fronts, or on faces with two sides.
    fronts: f64,
    /// On backs.
    backs: f64,
    /// Of what would leave the lamps' backs: on the backs of others.
    behind: f64,
    /// Mean way to what is met before lamps and behind them, m.
    ways: [f64; 2],
    /// Without lamps: places in rooms that light from outside reaches on fronts and on backs.
    entering: [usize; 2],
}

impl LampSurvey {
    fn in_scene(scene: &Scene) -> Self {
        let one_sided = scene.materials.iter().any(|material| !material.double_sided);
        if !one_sided || !scene.is_lit() {
            return Self::default();
        }
        let caster = RayCaster::new(scene);
        let (before, behind) = rays_of_faces(scene, &caster, RAYS);
        let mut survey = Self::default();
        let points = rays_of_lights(scene, RAYS);
        if before.is_empty() && points.is_empty() {
            return Self { entering: entering(scene, &caster), ..Self::default() };
        }
        let seen = caster.all(&[before, points].concat());
        let total = seen.len().max(1) as f64;
        for hit in seen.iter().flatten() {
            *(if hit.front { &mut survey.fronts } else { &mut survey.backs }) += 1.0 / total;
            survey.ways[0] += hit.distance;
        }
        survey.ways[0] /= (total * (survey.fronts + survey.backs)).max(1.0);
        let seen = caster.all(&behind);
        let backs = seen.iter().flatten().filter(|hit| !hit.front && !hit.lamp);
        let (count, way) = backs.fold((0.0, 0.0), |(n, sum), hit| (n + 1.0, sum + hit.distance));
        survey.behind = count / seen.len().max(1) as f64;
        survey.ways[1] = way / f64::max(count, 1.0);
        survey
    }

    fn enters_behind(&self) -> bool {
        let [fronts, backs] = self.entering;
        backs >= FEWEST_ENTERED && backs > fronts
    }

    fn is_inside_out(&self) -> bool {
        let enclosed_before = self.fronts + self.backs > 0.5;
        self.fronts < HARDLY_ANY
            && self.behind > 0.5
            && (!enclosed_before || self.ways[1] > self.ways[0])
    }
}

/// Rays from both sides of the scene's lamps, as many from each as its share of the power.
fn rays_of_faces(
    scene: &Scene,
    caster: &RayCaster<'_>,
    count: usize,
) -> (Vec<ProbeRay>, Vec<ProbeRay>) {
    let power = |&face: &u32| {
        let material = &scene[scene.faces[face as usize].material];
        luminance(material.emission)
    };
    let lamps: Vec<(f64, [DVec3; 3])> = caster
        .triangles()
        .map(|(face, corners)| {
            let [a, b, c] = corners;
            (power(&face) * (b - a).cross(c - a).length(), corners)
        })
        .filter(|(power, _)| *power > 0.0)
        .collect();
    let total: f64 = lamps.iter().map(|(power, _)| power).sum();
    let (mut before, mut behind) = (Vec::new(), Vec::new());
    let (mut passed, mut index) = (0.0, 0);
    for (power, [a, b, c]) in lamps {
        passed += power;
        while (index as f64 + 0.5) / (count as f64) < passed / total && index < count {
            let [s, t, u, v] = spread(index);
            let start = on_triangle([a, b, c], s, t);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            // A point on the unit sphere around the normal's tip lies in a cosine-weighted direction.
            let direction = (normal + on_sphere(u, v)).normalize_or(normal);
            before.push(ProbeRay { start, direction });
            behind.push(ProbeRay { start, direction: -direction });
            index += 1;
        }
    }
    (before, behind)
}

/// Rays from lights that stand somewhere, all around or in their cones.
fn rays_of_lights(scene: &Scene, count: usize) -> Vec<ProbeRay> {
    let mut rays = Vec::new();
    let each = count / scene.lights.len().max(1);
    for NamedLight { light, .. } in &scene.lights {
        let (start, axis, angle) = match *light {
            Light::Point { position, .. } => (position, DVec3::Y, std::f64::consts::PI),
            Light::Spot { position, direction, outer_angle, .. } => {
                (position, direction, outer_angle)
            }
            _ => continue,
        };
        for index in 0..each.max(1) {
            let [u, v, ..] = spread(index);
            // The cap of the sphere around the axis, in a frame of its own.
            let tip = on_sphere(1.0 - u * (1.0 - angle.cos()) / 2.0, v);
            let (x, z) = axis.any_orthonormal_pair();
            let direction = (tip.x * x + tip.y * axis + tip.z * z).normalize_or(axis);
            rays.push(ProbeRay { start, direction });
        }
    }
    rays
}
