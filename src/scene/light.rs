//! Lights without a surface.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;
use serde::Serialize;

use super::photometry::Photometry;
use crate::colour::{LUMENS_PER_WATT, Rgb};

/// A light from a point or from infinitely far, in radiometric units
/// (files give candela and lux; see [`crate::colour::LUMENS_PER_WATT`]).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Light {
    /// Shines equally in all directions.
    Point {
        /// Where it is, m.
        position: DVec3,
        /// Radiant intensity, W/sr.
        intensity: Rgb,
    },
    /// Shines in a cone, fading from the inner to the outer angle.
    Spot {
        /// Where it is, m.
        position: DVec3,
        /// Unit axis of the cone, away from the light.
        direction: DVec3,
        /// Radiant intensity on the axis, W/sr.
        intensity: Rgb,
        /// Half angle at which fading begins, radians.
        inner_angle: f64,
        /// Half angle beyond which there is no light, radians.
        outer_angle: f64,
    },
    /// Shines in one direction everywhere, like the sun.
    Directional {
        /// Unit vector the light travels along.
        direction: DVec3,
        /// Irradiance of a surface that faces it, W/m².
        irradiance: Rgb,
    },
    /// Shines as a measured luminaire does, aimed down (-Y).
    Luminaire {
        /// Where it is, m.
        position: DVec3,
        /// What it sends where.
        photometry: Arc<Photometry>,
        /// Angle from +X to its horizontal angle 0, radians, counter-clockwise seen from above.
        turn: f64,
    },
    /// Shines from a disc of half a degree infinitely far away, so that shadows have narrow borders.
    Sun {
        /// Unit vector the light of its middle travels along.
        direction: DVec3,
        /// Irradiance of a surface that faces it, W/m².
        irradiance: Rgb,
    },
    /// Shines from everywhere above the horizon; Y is up.
    Sky {
        /// How bright it is where.
        sky: Sky,
        /// Irradiance of a horizontal place that sees all of it, W/m².
        irradiance: Rgb,
    },
}

/// A light with a name, by which it can be dimmed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedLight {
    /// As in the file, or what kind of light it is; several lights may share it.
    pub name: String,
    /// What it sends out.
    pub light: Light,
}

impl From<Light> for NamedLight {
    /// Named after its kind.
    fn from(light: Light) -> Self {
        Self { name: light.kind().to_owned(), light }
    }
}

/// How the radiance of a sky depends on the elevation γ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Sky {
    /// L = E / π everywhere.
    Uniform,
    /// The CIE standard overcast sky, L = Lz (1 + 2 sin γ) / 3 with Lz = 9 E / (7 π) at the zenith
    /// ([Moon and Spencer 1942]; ISO 15469, type 16).
    ///
    /// [Moon and Spencer 1942]: https://doi.org/10.1364/JOSA.32.000706
    Overcast,
}

/// Illuminance of a plane that faces the sun outside of the atmosphere, lx ([IES 1984], equation 5).
///
/// [IES 1984]: https://doi.org/10.1080/00994480.1984.10748791
const SUN_OUTSIDE: f64 = 127_500.0;

/// Extinction of a clear atmosphere by air mass (the same).
const CLEAR_AIR: f64 = 0.21;

/// Illuminance by an overcast sky on the ground, lx: so usual in daylight design that a daylight factor
/// in per cent is a hundredth of the lux.
pub const DESIGN_SKY: f64 = 10_000.0;

/// Illuminance of a plane that faces the sun through clear air, lx: 127 500 exp(-0.21 / sin elevation),
/// as in [IES 1984]; `elevation` in degrees. None at or below the horizon.
///
/// [IES 1984]: https://doi.org/10.1080/00994480.1984.10748791
pub fn clear_sun(elevation: f64) -> f64 {
    let sine = elevation.to_radians().sin();
    if sine > 0.0 { SUN_OUTSIDE * (-CLEAR_AIR / sine).exp() } else { 0.0 }
}

/// Half the angle that the sun fills, radians.
pub(crate) const SUN_RADIUS: f64 = 0.2666 * PI / 180.0;

impl Sky {
    /// Radiance in a unit `direction`, Y up, as a share of the irradiance of an open horizontal place, 1/sr; none
    /// below the horizon.
    pub fn radiance(self, direction: DVec3) -> f64 {
        match self {
            _ if direction.y < 0.0 => 0.0,
            Self::Uniform => 1.0 / PI,
            Self::Overcast => 9.0 / (7.0 * PI) * (1.0 + 2.0 * direction.y) / 3.0,
        }
    }
}

impl Light {
    /// Where it is, m; `None` if it is infinitely far away.
    pub fn position(&self) -> Option<DVec3> {
        match *self {
            Self::Point { position, .. }
            | Self::Spot { position, .. }
            | Self::Luminaire { position, .. } => Some(position),
            Self::Directional { .. } | Self::Sun { .. } | Self::Sky { .. } => None,
        }
    }

    /// What is seen of it in a unit `direction` far outside of the scene, W/(m² sr): of skies and suns. Nothing of
    /// lights that fill no angle.
    pub fn radiance(&self, direction: DVec3) -> Rgb {
        match *self {
            Self::Sky { sky, irradiance } => irradiance * sky.radiance(direction),
            Self::Sun { direction: away, irradiance }
                if -away.dot(direction) > SUN_RADIUS.cos() =>
            {
                irradiance / (PI * SUN_RADIUS.sin().powi(2))
            }
            _ => Rgb::ZERO,
        }
    }

    /// A sun at an `azimuth`, degrees clockwise from north (-Z; east is +X), and an `elevation` over the
    /// horizon, degrees, with this illuminance of a plane that faces it, lx.
    pub fn sun(azimuth: f64, elevation: f64, lux: f64) -> Self {
        let (azimuth, elevation) = (azimuth.to_radians(), elevation.to_radians());
        let flat = DVec3::new(azimuth.sin(), 0.0, -azimuth.cos()) * elevation.cos();
        let towards = flat + DVec3::Y * elevation.sin();
        Self::Sun {
            direction: -towards.normalize_or(DVec3::Y),
            irradiance: Rgb::splat(lux / LUMENS_PER_WATT),
        }
    }

    /// What kind of light it is, in a word.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Point { .. } => "point",
            Self::Spot { .. } => "spot",
            Self::Directional { .. } => "directional",
            Self::Luminaire { .. } => "luminaire",
            Self::Sun { .. } => "sun",
            Self::Sky { .. } => "sky",
        }
    }

    /// Radiant intensity, W/sr, or irradiance, W/m²; none of a luminaire, whose strength is its photometry.
    pub fn strength(&self) -> Option<Rgb> {
        match self {
            Self::Point { intensity, .. } | Self::Spot { intensity, .. } => Some(*intensity),
            Self::Directional { irradiance, .. }
            | Self::Sun { irradiance, .. }
            | Self::Sky { irradiance, .. } => Some(*irradiance),
            Self::Luminaire { .. } => None,
        }
    }

    /// The same light with another [`strength`](Self::strength), if it has one.
    #[must_use]
    pub fn with_strength(mut self, strength: Rgb) -> Self {
        match &mut self {
            Self::Point { intensity, .. } | Self::Spot { intensity, .. } => *intensity = strength,
            Self::Directional { irradiance, .. }
            | Self::Sun { irradiance, .. }
            | Self::Sky { irradiance, .. } => *irradiance = strength,
            Self::Luminaire { .. } => (),
        }
        self
    }

    /// A white sky with this illuminance of an open horizontal plane, lx.
    pub fn sky(sky: Sky, lux: f64) -> Self {
        Self::Sky { sky, irradiance: Rgb::splat(lux / LUMENS_PER_WATT) }
    }
}
