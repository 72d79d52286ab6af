//! Lights by their names: each group can be solved for by itself, and dimmed when all is done.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::model::{Surface, Surfaces};
use crate::colour::{LUMENS_PER_WATT, Rgb, luminance};
use crate::scene::{Light, NamedLight, matches};

/// Lights that are dimmed together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightGroup {
    /// That of the materials and lights in it, or the pattern that they match.
    pub name: String,
    /// Of the strength.
    pub unit: StrengthUnit,
    /// That of its strongest light, channel by channel; the light of the group is proportional to it.
    pub strength: Rgb,
    /// Luminous flux at a white strength of 1, lm, if it can be told.
    pub lumens: Option<f64>,
}

/// What the strength of a light is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum StrengthUnit {
    /// Radiance of surfaces.
    #[serde(rename = "W/(m^2 sr)")]
    Radiance,
    /// Radiant intensity of points.
    #[serde(rename = "W/sr")]
    Intensity,
    /// Irradiance by suns, facing them, and by skies, on open ground.
    #[serde(rename = "W/m^2")]
    Irradiance,
    /// What the file says, be it of luminaires, be it of lights of several kinds.
    #[serde(rename = "1")]
    Share,
}

/// An emitter: a material or a light, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Emitter {
    Material(usize),
    Light(usize),
}

impl Surfaces {
    /// The lights in groups: those that match one of the patterns, each of which may have `*` for any text and `?`
    /// for any character, and all others by their own names, in the order of these.
    pub fn light_groups(&self, patterns: &[String]) -> Vec<LightGroup> {
        self.members(patterns).into_iter().map(|(name, group)| self.group(name, &group)).collect()
    }

    /// The same surfaces where one of the [groups](Self::light_groups) alone shines, at a strength of 1 in each channel.
    ///
    /// The light does not depend on the strength that the group has; on that of its lights among each other it does.
    #[must_use]
    pub fn lit_by(&self, group: &LightGroup, patterns: &[String]) -> Self {
        let members = self.members(patterns).remove(&group.name).unwrap_or_default();
        let share = |emitter: Emitter| {
            let shines = members.contains(&emitter);
            if shines { group.share(self.strength(emitter)) } else { Rgb::ZERO }
        };
        let mut lit = self.clone();
        for (number, material) in lit.materials.iter_mut().enumerate() {
            material.emission = share(Emitter::Material(number));
        }
        for surface in &mut lit.list {
            surface.exitance = lit.materials[surface.material.index()].emission * PI;
        }
        lit.lights.clear();
        for (number, NamedLight { name, light }) in self.lights.iter().enumerate() {
            let emitter = Emitter::Light(number);
            if members.contains(&emitter) {
                let light = light.clone().with_strength(share(emitter));
                lit.lights.push(NamedLight { name: name.clone(), light });
            }
        }
        lit
    }

    /// The emitters of each group.
    fn members(&self, patterns: &[String]) -> BTreeMap<String, Vec<Emitter>> {
        let materials = self.materials.iter().enumerate();
        let glowing = materials.filter(|(_, material)| material.emission.max_element() > 0.0);
        let glowing = glowing.map(|(number, m)| (&m.name, Emitter::Material(number)));
        let lights = self.lights.iter().enumerate();
        let lights = lights.map(|(number, named)| (&named.name, Emitter::Light(number)));
        let mut members: BTreeMap<String, Vec<Emitter>> = BTreeMap::new();
        for (name, emitter) in glowing.chain(lights) {
            let pattern = patterns.iter().find(|pattern| matches(pattern, name));
            members.entry(pattern.unwrap_or(name).clone()).or_default().push(emitter);
        }
        members
    }

    fn group(&self, name: String, members: &[Emitter]) -> LightGroup {
        let unit = self.unit(members[0]);
        let is_uniform = members.iter().all(|&member| self.unit(member) == unit);
        let unit = if is_uniform { unit } else { StrengthUnit::Share };
        let strongest = members.iter().map(|&m| self.strength(m)).fold(Rgb::ZERO, Rgb::max);
        let strength = if unit == StrengthUnit::Share { Rgb::ONE } else { strongest };
        let group = LightGroup { name, unit, strength, lumens: None };
        let lumens = members.iter().map(|&member| self.lumens(member, &group)).sum();
        LightGroup { lumens, ..group }
    }

    fn unit(&self, emitter: Emitter) -> StrengthUnit {
        match emitter {
            Emitter::Material(_) => StrengthUnit::Radiance,
            Emitter::Light(number) => match self.lights[number].light {
                Light::Point { .. } | Light::Spot { .. } => StrengthUnit::Intensity,
                Light::Luminaire { .. } => StrengthUnit::Share,
                _ => StrengthUnit::Irradiance,
            },
        }
    }

    /// In the emitter's own unit.
    fn strength(&self, emitter: Emitter) -> Rgb {
        match emitter {
            Emitter::Material(number) => self.materials[number].emission,
            Emitter::Light(number) => self.lights[number].light.strength().unwrap_or(Rgb::ONE),
        }
    }

    /// Luminous flux of an emitter of a group at a white strength of 1, lm.
    fn lumens(&self, emitter: Emitter, group: &LightGroup) -> Option<f64> {
        let share = luminance(group.share(self.strength(emitter))) * LUMENS_PER_WATT;
        match emitter {
            Emitter::Material(number) => {
                let is_even = self.materials[number].emission_texture.is_none();
                let surfaces = self.list.iter().filter(|s| s.material.index() == number);
                is_even.then(|| share * PI * surfaces.map(Surface::area).sum::<f64>())
            }
            Emitter::Light(number) => match &self.lights[number].light {
                Light::Point { .. } => Some(share * 4.0 * PI),
                Light::Luminaire { photometry, .. } => Some(photometry.flux()),
                _ => None,
            },
        }
    }
}

impl LightGroup {
    /// Whether lights of a name are in the group.
    pub fn holds(&self, name: &str) -> bool {
        self.name == name || matches(&self.name, name)
    }

    /// What a light of the group has of its strength, channel by channel; where the group has none of a colour, as
    /// much as of all colours together.
    fn share(&self, strength: Rgb) -> Rgb {
        if self.unit == StrengthUnit::Share {
            return strength;
        }
        let whole = strength.max_element() / self.strength.max_element().max(f64::MIN_POSITIVE);
        Rgb::select(self.strength.cmpgt(Rgb::ZERO), strength / self.strength, Rgb::splat(whole))
    }
}
