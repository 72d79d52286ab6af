//! Scenes made in code: checked before anything relies on them, and cleaned as those of files are.

use glam::DVec3;

use super::limits::{MAX_COORDINATE, MAX_RADIANCE};
use super::repair::{MIN_AREA, clean};
use super::{Face, Light, MAX_REFLECTANCE, Material, Scene, Texture};
use crate::colour::Rgb;
use crate::error::{Error, Result};
use crate::geometry::{area_vector, bulge, longest_edge};

/// Corners further from a face's plane than this share of its longest edge are a mistake; less is rounding, and the face
/// is split into triangles.
const BENT: f64 = 1e-4;

impl Scene {
    /// The scene, when all that it says can be lit; cleaned as that of a file is: equal positions are welded, T-junctions
    /// closed, faces listed twice dropped, each with a note.
    ///
    /// # Errors
    /// When there is no face; a face has less than three corners, no area, or is bent; an index leads nowhere; a list is
    /// not as long as a face's corners; or a number is none, or out of its range. The message names the place.
    pub fn build(mut self) -> Result<Self> {
        let flaw = self.flaw().or_else(|| self.excess()).or_else(|| self.flaw_of_shapes());
        if let Some(flaw) = flaw {
            return Err(Error::Scene(flaw));
        }
        clean(&mut self);
        Ok(self)
    }

    /// What keeps the scene from being looked at at all, if anything does.
    pub(crate) fn flaw(&self) -> Option<String> {
        if self.faces.is_empty() {
            return Some("the scene has no faces".to_owned());
        }
        let far = |p: &DVec3| !p.to_array().iter().all(|x| x.abs() <= MAX_COORDINATE);
        if let Some(number) = self.positions.iter().position(far) {
            let DVec3 { x, y, z } = self.positions[number];
            return Some(format!("position {number}, ({x}, {y}, {z}) m, is no place"));
        }
        let faces = self.faces.iter().enumerate();
        let of_face = |(number, face): (usize, &Face)| {
            Some(format!("face {number} {}", self.flaw_of_face(face)?))
        };
        let of_faces = faces.filter_map(of_face).next();
        of_faces.or_else(|| self.flaw_of_pictures()).or_else(|| self.flaw_of_colours())
    }

    fn flaw_of_face(&self, face: &Face) -> Option<String> {
        let count = face.vertices.len();
        if count < 3 {
            return Some(format!("has {count} corners; it takes three"));
        }
        let positions = self.positions.len();
        if let Some(vertex) = face.vertices.iter().find(|&&vertex| vertex as usize >= positions) {
            return Some(format!("has a corner at position {vertex}, of {positions}"));
        }
        if face.material.index() >= self.materials.len() {
            let materials = self.materials.len();
            return Some(format!("is of material {}, of {materials}", face.material.0));
        }
        if area_vector(&face.corners(&self.positions)).try_normalize().is_none() {
            return Some("has no area".to_owned());
        }
        let fits = |length: usize| length == 0 || length == count;
        if ![face.normals.len(), face.uvs.len(), face.tints.len()].into_iter().all(fits) {
            return Some(
                "has not as many normals, texture coordinates or tints as corners".to_owned(),
            );
        }
        let is_sound = face.normals.iter().all(|normal| normal.is_finite())
            && face.uvs.iter().all(|uv| uv.is_finite())
            && face.tints.iter().all(|tint| is_colour(tint.as_dvec3(), 1.0 / f64::EPSILON));
        (!is_sound).then(|| "has a normal, texture coordinate or tint that is no number".to_owned())
    }

    fn flaw_of_pictures(&self) -> Option<String> {
        let is_whole = |picture: &Texture| {
            picture.texels.len() as u64 == u64::from(picture.width) * u64::from(picture.height)
        };
        if let Some(number) = self.textures.iter().position(|picture| !is_whole(picture)) {
            return Some(format!("texture {number} has not width × height texels"));
        }
        let lost = |material: &&Material| {
            let mut used = material.texture.iter().chain(&material.emission_texture);
            used.any(|&texture| texture as usize >= self.textures.len())
        };
        let Material { name, .. } = self.materials.iter().find(lost)?;
        let textures = self.textures.len();
        Some(format!("material \"{name}\" has a texture beyond the {textures} that there are"))
    }

    fn flaw_of_colours(&self) -> Option<String> {
        for Material { name, reflectance, emission, .. } in &self.materials {
            let of_one = |what, colour: &Rgb| {
                let is_none = !is_colour(*colour, f64::MAX);
                is_none.then(|| format!("material \"{name}\" {what} {colour}, which is no colour"))
            };
            let flaw = of_one("reflects", reflectance).or_else(|| of_one("emits", emission));
            if flaw.is_some() {
                return flaw;
            }
        }
        let wrong = self.lights.iter().find(|light| !is_light(&light.light))?;
        Some(format!(
            "light \"{}\" has a number out of range, or a direction without length",
            wrong.name
        ))
    }

    /// More than may be reflected or emitted, if any is.
    fn excess(&self) -> Option<String> {
        let of_one = |Material { name, reflectance, emission, .. }: &Material| {
            if !is_colour(*reflectance, MAX_REFLECTANCE) {
                return Some(format!(
                    "material \"{name}\" reflects {reflectance}; each channel has 0 to {MAX_REFLECTANCE}"
                ));
            }
            (!is_colour(*emission, MAX_RADIANCE)).then(|| {
                format!(
                    "material \"{name}\" emits {emission} W/(m² sr); {MAX_RADIANCE:e} is the most"
                )
            })
        };
        self.materials.iter().find_map(of_one)
    }

    fn flaw_of_shapes(&self) -> Option<String> {
        let flaw = |(number, face): (usize, &Face)| {
            let corners = face.corners(&self.positions);
            let (area, longest) = (area_vector(&corners), longest_edge(&corners));
            if area.length() <= MIN_AREA * longest.powi(2) {
                return Some(format!("face {number} has no area"));
            }
            let bulge = bulge(&corners, area.normalize_or_zero());
            let is_bent = corners.len() > 3 && bulge > BENT * longest;
            is_bent.then(|| format!("face {number} is bent by {bulge:.2e} m; make it of triangles"))
        };
        self.faces.iter().enumerate().find_map(flaw)
    }
}

/// Whether each channel is in 0..=`most`.
fn is_colour(colour: Rgb, most: f64) -> bool {
    colour.to_array().iter().all(|channel| (0.0..=most).contains(channel))
}

fn is_light(light: &Light) -> bool {
    let is_bright = |colour: &Rgb| is_colour(*colour, MAX_RADIANCE);
    let is_way = |direction: &DVec3| direction.is_finite() && direction.length() > 0.5;
    match light {
        Light::Point { position, intensity, .. } => position.is_finite() && is_bright(intensity),
        Light::Spot { position, direction, intensity, inner_angle, outer_angle, .. } => {
            position.is_finite()
                && is_way(direction)
                && is_bright(intensity)
                && (0.0..=*outer_angle).contains(inner_angle)
        }
        Light::Directional { direction, irradiance } | Light::Sun { direction, irradiance } => {
            is_way(direction) && is_bright(irradiance)
        }
        Light::Luminaire { position, turn, .. } => position.is_finite() && turn.is_finite(),
        Light::Sky { irradiance, .. } => is_bright(irradiance),
    }
}
