//! What lights at points send out, and how much of it no front of a surface gets.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};
use rayon::prelude::*;

use super::emitter::Emitter;
use super::emitters::Emitters;
use super::punctual::intensity;
use crate::colour::{LUMENS_PER_WATT, Rgb};
use crate::scene::Light;
use crate::surface::SurfaceId;
use crate::visibility::Occluders;

/// Rays by which it is found where the light of one goes: of what leaves through an opening, right to some thousandths
/// of the whole; of what stays in a closed room, exact.
const RAYS: usize = 4096;

/// Powers, W by channel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sent {
    /// All that is sent out.
    pub(crate) emitted: Rgb,
    /// What of it meets nothing.
    pub(crate) escaped: Rgb,
    /// What of it meets backs.
    pub(crate) on_backs: Rgb,
}

impl Emitters {
    /// What the lights at points send out; `is_back` tells of a surface whether nothing is behind its back but black.
    pub(crate) fn sent_by_points(
        &self,
        occluders: &Occluders,
        is_back: impl Fn(SurfaceId) -> bool + Sync,
    ) -> Sent {
        let sent = |emitter: &Emitter| match emitter {
            Emitter::Point(light) => sent_by(light, occluders, &is_back),
            Emitter::Area(_) | Emitter::Globe(_) => None,
        };
        let each: Vec<Sent> = self.list.par_iter().filter_map(sent).collect();
        each.into_iter().fold(Sent::default(), |sum, sent| Sent {
            emitted: sum.emitted + sent.emitted,
            escaped: sum.escaped + sent.escaped,
            on_backs: sum.on_backs + sent.on_backs,
        })
    }
}

fn sent_by(
    light: &Light,
    occluders: &Occluders,
    is_back: &impl Fn(SurfaceId) -> bool,
) -> Option<Sent> {
    let position = light.position()?;
    let (mut all, mut past, mut behind) = (Rgb::ZERO, Rgb::ZERO, Rgb::ZERO);
    for ray in 0..RAYS {
        let away = direction(light, ray);
        let sent = intensity(light, away);
        all += sent;
        match occluders.first(position, away) {
            None => past += sent,
            Some(met) if !met.front && is_back(met.surface) => behind += sent,
            Some(_) => {}
        }
    }
    let emitted = flux(light)?;
    let share = |part: Rgb| Rgb::select(all.cmpgt(Rgb::ZERO), emitted * part / all, Rgb::ZERO);
    Some(Sent { emitted, escaped: share(past), on_backs: share(behind) })
}

/// Power that a light at a point sends out, W; exact. None of one from infinitely far.
///
/// Φ = 4π I; of a spot whose intensity rises with the square of a ramp over the cosine, Φ = 2π I (1 - cos i + (cos i -
/// cos o) / 3) for inner and outer angles i and o; of a luminaire, its file's table integrated.
fn flux(light: &Light) -> Option<Rgb> {
    match *light {
        Light::Point { intensity, .. } => Some(4.0 * PI * intensity),
        Light::Spot { intensity, inner_angle, outer_angle, .. } => {
            let [inner, outer] = [inner_angle, outer_angle].map(f64::cos);
            Some(TAU * intensity * (1.0 - inner + (inner - outer) / 3.0))
        }
        Light::Luminaire { ref photometry, .. } => {
            Some(Rgb::splat(photometry.flux() / LUMENS_PER_WATT))
        }
        Light::Directional { .. } | Light::Sun { .. } | Light::Sky { .. } => None,
    }
}

/// The ray of this number away from a light, of a spiral that is even over the sphere or a spot's cone.
fn direction(light: &Light, ray: usize) -> DVec3 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (axis, lowest) = match *light {
        Light::Spot { direction, outer_angle, .. } => (direction, outer_angle.cos()),
        _ => (DVec3::Y, -1.0),
    };
    let height = 1.0 - (1.0 - lowest) * (ray as f64 + 0.5) / RAYS as f64;
    let (sine, cosine) = (TAU * (ray as f64 * GOLDEN).fract()).sin_cos();
    let radius = (1.0 - height * height).max(0.0).sqrt();
    DQuat::from_rotation_arc(DVec3::Y, axis) * DVec3::new(radius * cosine, height, radius * sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_are_even_over_the_sphere_and_over_a_cone() {
        let spot = Light::Spot {
            position: DVec3::ZERO,
            direction: DVec3::new(0.6, 0.0, -0.8),
            intensity: Rgb::new(1.0, 2.0, 3.0),
            inner_angle: 0.3,
            outer_angle: 0.7,
        };
        let mean =
            |light: &Light| (0..RAYS).map(|ray| direction(light, ray)).sum::<DVec3>() / RAYS as f64;
        let point = Light::Point { position: DVec3::ZERO, intensity: Rgb::ONE };
        assert!(mean(&point).length() < 1e-3);
        let middle = DVec3::new(0.6, 0.0, -0.8) * (1.0 + 0.7_f64.cos()) / 2.0;
        assert!(mean(&spot).distance(middle) < 1e-3);
        // The flux of the spot is the mean intensity of its rays times the cone's solid angle.
        let rays = (0..RAYS).map(|ray| intensity(&spot, direction(&spot, ray)));
        let found = rays.sum::<Rgb>() / RAYS as f64 * TAU * (1.0 - 0.7_f64.cos());
        let expected = flux(&spot).expect("a spot has a flux");
        assert!((found / expected - Rgb::ONE).abs().max_element() < 1e-3, "{found} {expected}");
    }
}
