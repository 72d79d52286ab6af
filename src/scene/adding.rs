//! Light for scenes whose files have none: materials made to emit, and lamps added.

use std::f64::consts::PI;
use std::str::FromStr;

use glam::DVec3;

use super::limits::{MAX_RADIANCE, tamed};
use super::{Face, Material, MaterialId, Scene};
use crate::colour::{LUMENS_PER_WATT, Rgb};
use crate::error::{Error, Result};
use crate::geometry::area_vector;

/// How much light a surface emits, written `15`, `17,12,4` or `800lm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// Radiance L, W/(m² sr) per channel.
    Radiance(Rgb),
    /// Luminous flux Φ of all of it, lm; white.
    Flux(f64),
}

impl Amount {
    pub(super) fn is_flux(self) -> bool {
        matches!(self, Self::Flux(_))
    }

    /// Radiance, W/(m² sr), of Lambertian surfaces of this area, m²: Φ = π L A.
    ///
    /// # Errors
    /// When it is beyond all that shines, some 10⁵ suns.
    pub fn radiance(self, area: f64) -> std::result::Result<Rgb, String> {
        let radiance = match self {
            Self::Radiance(radiance) => radiance,
            Self::Flux(lumens) => Rgb::splat(lumens / (LUMENS_PER_WATT * PI * area)),
        };
        if tamed(radiance, MAX_RADIANCE) == radiance {
            return Ok(radiance);
        }
        let most = radiance.max_element();
        Err(format!(
            "a radiance of {most:e} W/(m² sr) is more than the {MAX_RADIANCE:e} that may be"
        ))
    }
}

impl FromStr for Amount {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let wrong = || {
            format!(
                "\"{text}\" is no amount of light; write a radiance in W/(m² sr), 15 or 17,12,4, or 800lm"
            )
        };
        let number = |part: &str| {
            part.trim().parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0).ok_or_else(wrong)
        };
        if let Some(lumens) = text.strip_suffix("lm") {
            return number(lumens).map(Self::Flux);
        }
        let channels: Vec<f64> =
            text.split(',').map(number).collect::<std::result::Result<_, _>>()?;
        match *channels {
            [grey] => Ok(Self::Radiance(Rgb::splat(grey))),
            [red, green, blue] => Ok(Self::Radiance(Rgb::new(red, green, blue))),
            _ => Err(wrong()),
        }
    }
}

/// A rectangle that shines to one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLight {
    /// Its middle, m.
    pub centre: DVec3,
    /// Width and depth, m: along X and Z if it shines straight up or down, else its width is horizontal.
    pub size: [f64; 2],
    /// Where it shines, of any length above zero.
    pub direction: DVec3,
    /// What it emits.
    pub amount: Amount,
}

impl Scene {
    /// Makes all materials of a name, or of a pattern with `*` and `?`, emit; what they emitted before,
    /// textures included, is forgotten. A flux is that of all their faces together.
    ///
    /// # Errors
    /// When there is no such material, or a flux is to come from no area.
    pub fn emit(&mut self, pattern: &str, amount: Amount) -> Result<()> {
        let wrong = |message| Error::Setting { name: "emit", message };
        let named = self.materials_named(pattern).map_err(wrong)?;
        self.emit_from(&named, amount).map_err(wrong)
    }

    /// The same for materials by their numbers.
    pub(super) fn emit_from(
        &mut self,
        materials: &[usize],
        amount: Amount,
    ) -> std::result::Result<(), String> {
        let area = materials.iter().map(|&material| self.area_of(material)).sum::<f64>();
        self.photometric |= amount.is_flux();
        if amount.is_flux() && area <= 0.0 {
            let name = &self.materials[materials[0]].name;
            return Err(format!("material \"{name}\" is on no face that could emit lumens"));
        }
        let radiance = amount.radiance(area)?;
        for &number in materials {
            let material = &mut self.materials[number];
            (material.emission, material.emission_texture) = (radiance, None);
        }
        Ok(())
    }

    /// Area from which a material's faces emit, m².
    fn area_of(&self, material: usize) -> f64 {
        let sides = if self.materials[material].double_sided { 2.0 } else { 1.0 };
        let faces = self.faces.iter().filter(|face| face.material.index() == material);
        sides * faces.map(|face| area_vector(&face.corners(&self.positions)).length()).sum::<f64>()
    }

    /// Adds a lamp as a black rectangle of a material and an object of its own; its back is black, too.
    ///
    /// # Errors
    /// When it has no area or no direction, or is beyond all bounds.
    pub fn add_area_light(&mut self, lamp: &AreaLight) -> Result<()> {
        let wrong =
            |message: &str| Error::Setting { name: "area-light", message: message.to_owned() };
        let [width, depth] = lamp.size;
        let is_length = |x: f64| x > 0.0 && x <= MAX_SIZE;
        if !(is_length(width) && is_length(depth) && lamp.centre.abs().max_element() <= MAX_SIZE) {
            return Err(wrong("a lamp has a size above 0 and is not millions of metres away"));
        }
        let normal = lamp.direction.try_normalize();
        let normal = normal.ok_or_else(|| wrong("the direction has no length"))?;
        let emission = lamp.amount.radiance(width * depth).map_err(|message| wrong(&message))?;
        self.photometric |= lamp.amount.is_flux();
        let number = 1 + self.objects.iter().filter(|name| name.starts_with(AREA_LIGHT)).count();
        let name = format!("{AREA_LIGHT} {number}");
        let first = self.positions.len() as u32;
        self.positions.extend(rectangle(lamp.centre, lamp.size, normal));
        self.faces.push(Face {
            vertices: (first..first + 4).collect(),
            material: MaterialId(self.materials.len() as u32),
            object: self.objects.len() as u32,
            ..Face::default()
        });
        self.objects.push(name.clone());
        self.materials.push(Material {
            name,
            reflectance: Rgb::ZERO,
            emission,
            ..Material::default()
        });
        Ok(())
    }
}

/// What added lamps are called, with a number after it.
const AREA_LIGHT: &str = "area light";

/// Lamps further away or larger are mistakes, m.
const MAX_SIZE: f64 = 1e6;

/// Corners of a rectangle, counter-clockwise seen from where its unit `normal` points.
fn rectangle(centre: DVec3, [width, depth]: [f64; 2], normal: DVec3) -> [DVec3; 4] {
    let across = DVec3::Y.cross(normal);
    // Nearly straight up or down, the horizontal would turn about itself.
    let x = if across.length() < 1e-6 { DVec3::X } else { across.normalize() };
    let (u, v) = (x * width / 2.0, normal.cross(x) * depth / 2.0);
    [centre - u - v, centre + u - v, centre + u + v, centre - u + v]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_are_radiances_or_lumens() {
        assert_eq!("15".parse(), Ok(Amount::Radiance(Rgb::splat(15.0))));
        assert_eq!("17, 12,4".parse(), Ok(Amount::Radiance(Rgb::new(17.0, 12.0, 4.0))));
        assert_eq!("800 lm".parse(), Ok(Amount::Flux(800.0)));
        for wrong in ["", "lm", "1,2", "-1", "nan", "1,2,3,4", "inflm", "8lux"] {
            assert!(wrong.parse::<Amount>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn rectangles_face_where_they_shine() {
        for normal in [DVec3::NEG_Y, DVec3::Y, DVec3::X, DVec3::new(1.0, -2.0, 0.5).normalize()] {
            let corners = rectangle(DVec3::ONE, [2.0, 3.0], normal);
            let area = area_vector(&corners);
            assert!((area - normal * 6.0).length() < 1e-12, "{normal} {area}");
        }
        let down = rectangle(DVec3::ZERO, [2.0, 4.0], DVec3::NEG_Y);
        assert!(down.iter().all(|p| p.x.abs() == 1.0 && p.z.abs() == 2.0), "{down:?}");
    }
}
