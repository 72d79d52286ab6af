//! Other strengths and colours for the lights of a mesh that keeps them apart.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

use super::trimesh::TriMesh;
use crate::colour::{LUMENS_PER_WATT, Rgb};
use crate::error::{Error, Result};
use crate::scene::named;
use crate::surface::{LightGroup, StrengthUnit};

/// Stronger lights, in any unit, are mistakes.
const BRIGHTEST: f64 = 1e12;

/// What becomes of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Dimming {
    /// So many times what it was, by channel: `50%`, `x2`, `x1,0.8,0.6` or `off`.
    Times(Rgb),
    /// A strength in the light's own unit: `15` or `17,12,4`.
    Strength(Rgb),
    /// White of this flux, lm: `800lm`.
    Lumens(f64),
    /// White of this intensity, cd, of a point: `60cd`.
    Candela(f64),
    /// White of this illuminance, lx, of a sun or a sky: `20000lx`.
    Lux(f64),
}

impl FromStr for Dimming {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let wrong = || {
            format!(
                "\"{text}\" is no light; write off, 50%, x2, x1,0.8,0.6, 15, 17,12,4, 800lm, 60cd or 20000lx"
            )
        };
        let number = |text: &str| {
            let number = text.trim().parse().ok();
            number.filter(|x: &f64| x.is_finite() && *x >= 0.0).ok_or_else(wrong)
        };
        let colour = |text: &str| {
            let channels: Vec<f64> =
                text.split(',').map(number).collect::<std::result::Result<_, _>>()?;
            match *channels {
                [grey] => Ok(Rgb::splat(grey)),
                [red, green, blue] => Ok(Rgb::new(red, green, blue)),
                _ => Err(wrong()),
            }
        };
        let text = text.trim();
        if text == "off" {
            return Ok(Self::Times(Rgb::ZERO));
        }
        if let Some(times) = text.strip_prefix('x') {
            return colour(times).map(Self::Times);
        }
        if let Some(percent) = text.strip_suffix('%') {
            return Ok(Self::Times(Rgb::splat(number(percent)? / 100.0)));
        }
        if let Some(lumens) = text.strip_suffix("lm") {
            return number(lumens).map(Self::Lumens);
        }
        if let Some(candela) = text.strip_suffix("cd") {
            return number(candela).map(Self::Candela);
        }
        if let Some(lux) = text.strip_suffix("lx") {
            return number(lux).map(Self::Lux);
        }
        colour(text).map(Self::Strength)
    }
}

impl Dimming {
    /// The strength that a group of lights gets.
    fn applied_to(self, group: &LightGroup) -> std::result::Result<Rgb, String> {
        let of_unit = |unit: StrengthUnit, lumens: f64| {
            let white = Rgb::splat(lumens / LUMENS_PER_WATT);
            (group.unit == unit).then_some(white).ok_or("its strength is in another unit")
        };
        let strength = match self {
            Self::Times(times) => Ok(group.strength * times),
            Self::Strength(strength) => Ok(strength),
            Self::Lumens(lumens) => {
                let white = group.lumens.filter(|unit| *unit > 0.0).map(|unit| lumens / unit);
                white.map(Rgb::splat).ok_or("its lumens are not known")
            }
            Self::Candela(candela) => of_unit(StrengthUnit::Intensity, candela),
            Self::Lux(lux) => of_unit(StrengthUnit::Irradiance, lux),
        };
        let told = |what| format!("light \"{}\": {what}; it is {group}", group.name);
        let strength = strength.map_err(told)?;
        if strength.max_element() <= BRIGHTEST {
            return Ok(strength);
        }
        Err(told("this is brighter than anything that shines"))
    }
}

impl TriMesh {
    /// Dims the lights of a name, or of a pattern with `*` and `?`.
    ///
    /// # Errors
    /// When the mesh does not keep lights apart, there is none of this name, or its strength cannot be told that way.
    pub fn dim(&mut self, pattern: &str, dimming: Dimming) -> Result<()> {
        let wrong = |message: String| Error::Setting { name: "light", message };
        if self.lights.is_empty() {
            let message = "the lights of this mesh are not kept apart; solve it with --relightable";
            return Err(wrong(message.to_owned()));
        }
        let names = self.lights.iter().map(|light| light.group.name.as_str());
        let found = named("light", pattern, names).map_err(wrong)?;
        for light in found {
            let strength = dimming.applied_to(&self.lights[light].group).map_err(wrong)?;
            self.relight(light, strength);
        }
        Ok(())
    }
}

impl Display for LightGroup {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let unit = match self.unit {
            StrengthUnit::Radiance => "W/(m² sr)",
            StrengthUnit::Intensity => "W/sr",
            StrengthUnit::Irradiance => "W/m²",
            StrengthUnit::Share => "times what the scene says",
        };
        let numbers = self.strength.to_array().map(|x| format!("{}", (x * 1e6).round() / 1e6));
        write!(f, "{} {unit}", numbers.join(","))?;
        let flux = crate::colour::luminance(self.strength) * self.lumens.unwrap_or(0.0);
        if flux > 0.0 { write!(f, ", {flux:.1} lm") } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(unit: StrengthUnit, lumens: Option<f64>) -> LightGroup {
        let strength = Rgb::new(4.0, 2.0, 1.0);
        LightGroup { name: "lamp".to_owned(), unit, strength, lumens }
    }

    #[test]
    fn lights_are_dimmed_in_the_units_they_have() {
        let lamp = group(StrengthUnit::Radiance, Some(400.0));
        let applied = |text: &str| text.parse::<Dimming>().unwrap().applied_to(&lamp);
        assert_eq!(applied("off"), Ok(Rgb::ZERO));
        assert_eq!(applied("50%"), Ok(Rgb::new(2.0, 1.0, 0.5)));
        assert_eq!(applied("x2"), Ok(Rgb::new(8.0, 4.0, 2.0)));
        assert_eq!(applied("x 1, 0.5,0"), Ok(Rgb::new(4.0, 1.0, 0.0)));
        assert_eq!(applied("17,12,4"), Ok(Rgb::new(17.0, 12.0, 4.0)));
        assert_eq!(applied("800 lm"), Ok(Rgb::splat(2.0)));
        assert!(applied("60cd").is_err() && applied("100lx").is_err());
        let sun = group(StrengthUnit::Irradiance, None);
        assert_eq!(Dimming::Lux(683.0).applied_to(&sun), Ok(Rgb::ONE));
        assert!(Dimming::Lumens(1.0).applied_to(&sun).is_err());
        for wrong in ["", "x", "-1", "nan%", "1,2", "8 lux", "x1,2,3,4", "inflm"] {
            assert!(wrong.parse::<Dimming>().is_err(), "{wrong}");
        }
    }
}
