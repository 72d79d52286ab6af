//! Lights without a surface.

use glam::DVec3;

use crate::colour::Rgb;

/// A light from a point or from infinitely far, in radiometric units
/// (files give candela and lux; see [`crate::colour::LUMENS_PER_WATT`]).
#[derive(Clone, Debug, PartialEq)]
pub enum Light {
    /// Shines equally in all directions.
    Point {
        /// Where it is, m.
        position: DVec3,
        /// Radiant intensity, W/sr.
        intensity: Rgb,
        /// Distance beyond which it is not felt, m, if the file limits it.
        range: Option<f64>,
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
        /// Distance beyond which it is not felt, m, if the file limits it.
        range: Option<f64>,
    },
    /// Shines in one direction everywhere, like the sun.
    Directional {
        /// Unit vector the light travels along.
        direction: DVec3,
        /// Irradiance of a surface that faces it, W/m².
        irradiance: Rgb,
    },
}
