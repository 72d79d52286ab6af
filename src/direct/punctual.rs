//! Lights without a surface.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};

use super::profile::solid_angle;
use crate::colour::{LUMENS_PER_WATT, Rgb};
use crate::light::Direct;
use crate::scene::Light;
use crate::visibility::{Occluders, SurfacePoint};

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

/// A light nearer than this many radii of a disc shines unevenly on it.
const NEAR: f64 = 16.0;

/// Discs within each other whose light is added up: a peak with steps that are not steep.
const DISCS: usize = 8;

/// Solid angle in which intensity is taken as even, sr, and how often a triangle is quartered at most to get there.
const SMALL: f64 = 0.02;
const DEEPEST: u32 = 14;

/// Corners of the polygon that stands for a disc.
const CORNERS: usize = 8;

/// What arrives at a place with a unit normal, if something may.
pub(super) fn shine(
    light: &Light,
    occluders: &Occluders,
    receiver: SurfacePoint,
) -> Option<Direct> {
    let (unoccluded, source) = irradiance(light, receiver, 0.0)?;
    let place = receiver.position;
    let hidden = occluders.blocks(place, source.end(place, occluders));
    let irradiance = if hidden { Rgb::ZERO } else { unoccluded };
    Some(Direct { irradiance, unoccluded })
}

/// Irradiance of an unshadowed place with unit `normal`, W/m², the mean over a disc of that radius, m, around it;
/// `None` where none arrives.
///
/// E = I cos θ / d² from a point, E cos θ from a direction. From a point near the disc, E = Σ I Ω / A by the solid angles
/// Ω of triangles of area A in all: so all that it sends towards a surface arrives, however near it is.
pub(super) fn irradiance(
    light: &Light,
    receiver: SurfacePoint,
    radius: f64,
) -> Option<(Rgb, Source)> {
    let SurfacePoint { position: place, normal } = receiver;
    let (irradiance, from) = match *light {
        // Not of a point: they are among the areas.
        Light::Sun { .. } | Light::Sky { .. } => return None,
        Light::Directional { direction, irradiance } => {
            (irradiance * (-direction.dot(normal)).max(0.0), Source::Direction(-direction))
        }
        _ => {
            let position = light.position()?;
            let (way, height) = (position - place, (position - place).dot(normal));
            let distance = way.length();
            if height <= 0.0 {
                return None;
            }
            let irradiance = if distance < NEAR * radius {
                on_disc(light, position, receiver, radius)
            } else {
                intensity(light, -way / distance) * (height / distance.powi(3))
            };
            (irradiance, Source::Position(position))
        }
    };
    (irradiance.max_element() > 0.0).then_some((irradiance, from))
}

/// Mean irradiance of a disc that faces a point, W/m², its middle counting most: that of discs of several radii.
fn on_disc(light: &Light, position: DVec3, receiver: SurfacePoint, radius: f64) -> Rgb {
    let SurfacePoint { position: place, normal } = receiver;
    let turn = 2.0 * PI / CORNERS as f64;
    let (x, y) = normal.any_orthonormal_pair();
    let (mut flux, mut area) = (Rgb::ZERO, 0.0);
    for radius in (1..=DISCS).map(|k| radius * k as f64 / DISCS as f64) {
        let corner = |k: usize| {
            let (sine, cosine) = (turn * k as f64).sin_cos();
            place + (x * cosine + y * sine) * radius
        };
        let triangle = |k: usize| {
            let corners = [place, corner(k), corner(k + 1)].map(|corner| corner - position);
            flux_through(light, corners, DEEPEST)
        };
        flux += (0..CORNERS).map(triangle).sum::<Rgb>();
        area += CORNERS as f64 / 2.0 * turn.sin() * radius * radius;
    }
    flux / area
}

/// What a light sends through a triangle, seen from it, W: into pieces that look small, unless it shines evenly.
fn flux_through(light: &Light, [a, b, c]: [DVec3; 3], depth: u32) -> Rgb {
    let rays = [a, b, c].map(DVec3::normalize);
    let angle = solid_angle(&rays);
    if depth == 0 || angle < SMALL || matches!(light, Light::Point { .. }) {
        return intensity(light, rays.iter().sum::<DVec3>().normalize()) * angle;
    }
    let [d, e, f] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
    let parts = [[a, d, f], [d, b, e], [f, e, c], [d, e, f]];
    parts.into_iter().map(|part| flux_through(light, part, depth - 1)).sum()
}

/// Radiant intensity of a light that is somewhere, into a unit direction away from it, W/sr.
///
/// A spot fades as `KHR_lights_punctual` recommends, with the square of a linear ramp over the cosine of the angle.
pub(super) fn intensity(light: &Light, away: DVec3) -> Rgb {
    match *light {
        Light::Point { intensity, .. } => intensity,
        Light::Spot { direction, intensity, inner_angle, outer_angle, .. } => {
            let (inner, outer) = (inner_angle.cos(), outer_angle.cos());
            let ramp = (away.dot(direction) - outer) / (inner - outer).max(1e-9);
            intensity * ramp.clamp(0.0, 1.0).powi(2)
        }
        Light::Luminaire { ref photometry, turn, .. } => {
            let candela = photometry.candela(DQuat::from_rotation_y(-turn) * away);
            Rgb::splat(candela / LUMENS_PER_WATT)
        }
        Light::Sun { .. } | Light::Sky { .. } | Light::Directional { .. } => Rgb::ZERO,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_a_spot_sends_towards_a_plane_arrives_however_near_it_is() {
        let (inner_angle, outer_angle): (f64, f64) = (0.5, 0.9);
        // What its ramp over the cosine leaves: a third of the band, and all inside of it.
        let share = 1.0 - inner_angle.cos() + (inner_angle.cos() - outer_angle.cos()) / 3.0;
        for height in [0.1, 0.01, 1e-3, 1e-4] {
            let light = Light::Spot {
                position: DVec3::Z * height,
                direction: DVec3::NEG_Z,
                intensity: Rgb::ONE,
                inner_angle,
                outer_angle,
            };
            let step = 0.01;
            let at = |k: i32| step * (f64::from(k) + 0.3);
            let places =
                (-40..40).flat_map(|i| (-40..40).map(move |j| DVec3::new(at(i), at(j), 0.0)));
            let found = places
                .filter_map(|place| irradiance(&light, SurfacePoint::new(place, DVec3::Z), 0.1));
            let flux: f64 = found.map(|(irradiance, _)| irradiance.x * step * step).sum();
            let expected = 2.0 * PI * share;
            assert!((flux / expected - 1.0).abs() < 0.01, "{flux} W of {expected} from {height} m");
        }
    }
}
