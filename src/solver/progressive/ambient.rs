//! What light that is still unshot will come to, before it is known where it arrives.

use std::f64::consts::TAU;

use glam::DVec3;

use super::Shooting;
use crate::colour::Rgb;
use crate::mesh::Patch;

/// Rays that tell how much of the unshot light arrives anywhere: right to some hundredths.
const RAYS: usize = 1024;

impl Shooting<'_, '_> {
    /// Estimate of the irradiance that the unshot light will give rise to, the same everywhere, W/m².
    ///
    /// The mean unshot radiosity times 1 / (1 - mean reflectance), as in Cohen et al. 1988: exact for
    /// a closed room that is all alike.
    pub(in crate::solver) fn ambient(&self) -> Rgb {
        self.ambient_if(1.0)
    }

    /// The same where some light finds its way out: less, since that gives rise to nothing.
    pub(in crate::solver) fn ambient_of_the_rest(&self) -> Rgb {
        self.ambient_if(self.arriving())
    }

    /// The same if this share of all light that leaves a surface arrives at another.
    fn ambient_if(&self, arriving: f64) -> Rgb {
        let area: f64 = self.mesh.patches.iter().map(|patch| patch.area).sum();
        let reflectance: Rgb =
            self.mesh.patches.iter().map(|patch| patch.reflectance * (patch.area / area)).sum();
        self.unshot_power() / area * arriving / (Rgb::ONE - reflectance * arriving)
    }

    /// Share of the unshot light that meets the front of a surface, by rays from those that hold it.
    fn arriving(&self) -> f64 {
        let held: Vec<f64> = self
            .areas
            .iter()
            .zip(&self.unshot)
            .map(|(a, held)| a * held.abs().element_sum())
            .collect();
        let all: f64 = held.iter().sum();
        if all <= 0.0 {
            return 1.0;
        }
        let (mut group, mut passed, mut met) = (0, held[0], 0);
        for ray in 0..RAYS {
            let wanted = all * (ray as f64 + 0.5) / RAYS as f64;
            while passed < wanted && group + 1 < held.len() {
                group += 1;
                passed += held[group];
            }
            let members = self.groups.members(group);
            met += usize::from(self.meets_a_front(&self.mesh[members[ray % members.len()]], ray));
        }
        met as f64 / RAYS as f64
    }

    /// Whether one of the rays that a patch's light may take meets a front.
    fn meets_a_front(&self, patch: &Patch, ray: usize) -> bool {
        let middle = patch.corners.iter().sum::<DVec3>() / patch.corners.len() as f64;
        let direction = cosine_direction(patch.normal, ray);
        let met = self.occluders.first(middle, direction);
        met.is_some_and(|met| met.front || self.surfaces.list[met.surface as usize].two_sided)
    }
}

/// A direction about a unit normal, as often as its cosine says: the ray of this number of a sequence that is
/// even over all.
fn cosine_direction(normal: DVec3, ray: usize) -> DVec3 {
    // Multiples of the powers of the plastic number, whose parts after the point are even in two dimensions.
    const STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];
    let [u, v] = STEPS.map(|step| ((ray as f64 + 0.5) * step).fract());
    let (right, up) = normal.any_orthonormal_pair();
    let (sine, cosine) = (u.sqrt(), (1.0 - u).sqrt());
    (right * (TAU * v).cos() + up * (TAU * v).sin()) * sine + normal * cosine
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_as_often_as_their_cosines_say() {
        let normal = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        let mean: DVec3 =
            (0..RAYS).map(|ray| cosine_direction(normal, ray)).sum::<DVec3>() / RAYS as f64;
        assert!(mean.distance(normal * (2.0 / 3.0)) < 0.01, "{mean}");
        assert!((0..RAYS).all(|ray| (cosine_direction(normal, ray).length() - 1.0).abs() < 1e-12));
    }
}
