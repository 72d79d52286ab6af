//! Lights without a surface.

use glam::{DQuat, DVec3};

use crate::colour::{LUMENS_PER_WATT, Rgb};
use crate::mesh::Direct;
use crate::scene::Light;
use crate::visibility::Occluders;

/// Where the light of a punctual light comes from, as seen from a place.
pub(super) enum Source {
    /// A position, m.
    Position(DVec3),
    /// A unit direction, towards the light.
    Direction(DVec3),
}

impl Source {
    /// The far end of a shadow ray from a place.
    pub(super) fn end(&self, place: DVec3, occluders: &Occluders) -> DVec3 {
        match *self {
            Self::Position(position) => position,
            Self::Direction(direction) => place + direction * occluders.extent(),
        }
    }
}

/// What arrives at a place with a unit normal, if something may, and the rays that this took.
pub(super) fn shine(
    light: &Light,
    occluders: &Occluders,
    (place, normal): (DVec3, DVec3),
) -> Option<(Direct, u64)> {
    let (unoccluded, source) = irradiance(light, place, normal)?;
    let hidden = occluders.blocks(place, source.end(place, occluders));
    let irradiance = if hidden { Rgb::ZERO } else { unoccluded };
    Some((Direct { irradiance, unoccluded }, 1))
}

/// Irradiance of an unshadowed place with unit `normal`, W/m²; `None` where none arrives.
///
/// E = I cos θ / d² from a point, E cos θ from a direction. A spot fades as
/// `KHR_lights_punctual` recommends, with the square of a linear ramp over the cosine of the angle.
pub(super) fn irradiance(light: &Light, place: DVec3, normal: DVec3) -> Option<(Rgb, Source)> {
    let (irradiance, from) = match *light {
        Light::Luminaire { position, ref photometry, turn } => {
            let away = (place - position).normalize_or_zero();
            let candela = photometry.candela(DQuat::from_rotation_y(-turn) * away);
            let falloff = falloff(position - place, normal, None);
            (Rgb::splat(candela / LUMENS_PER_WATT * falloff), Source::Position(position))
        }
        // Not of a point: they are among the areas.
        Light::Sun { .. } | Light::Sky { .. } => return None,
        Light::Point { position, intensity, range } => {
            (intensity * falloff(position - place, normal, range), Source::Position(position))
        }
        Light::Spot { position, direction, intensity, inner_angle, outer_angle, range } => {
            let to_place = (place - position).normalize_or_zero();
            let (inner, outer) = (inner_angle.cos(), outer_angle.cos());
            let ramp = (to_place.dot(direction) - outer) / (inner - outer).max(1e-9);
            let fade = ramp.clamp(0.0, 1.0).powi(2);
            (
                intensity * (fade * falloff(position - place, normal, range)),
                Source::Position(position),
            )
        }
        Light::Directional { direction, irradiance } => {
            (irradiance * (-direction.dot(normal)).max(0.0), Source::Direction(-direction))
        }
    };
    (irradiance.max_element() > 0.0).then_some((irradiance, from))
}

/// cos θ / d², zero from behind and beyond the range, m⁻².
fn falloff(to_light: DVec3, normal: DVec3, range: Option<f64>) -> f64 {
    let distance = to_light.length();
    if distance <= f64::MIN_POSITIVE || range.is_some_and(|range| distance > range) {
        return 0.0;
    }
    (to_light.dot(normal) / distance).max(0.0) / (distance * distance)
}
