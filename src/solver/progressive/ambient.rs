//! What light that is still unshot will come to, before it is known where it arrives.

use std::f64::consts::TAU;

use glam::DVec3;

use super::shooting::Shooting;
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
        let area = self.area();
        let share = |(patch, reflectance): (&Patch, &Rgb)| *reflectance * (patch.area / area);
        let patches = self.mesh.patches.iter().zip(&self.context.optics.reflectance);
        let reflectance: Rgb = patches.map(share).sum();
        self.unshot_power() / area / (Rgb::ONE - reflectance)
    }

    /// The same where not all is alike: of the light, what finds its way out gives rise to nothing, and the rest is
    /// reflected by what it meets.
    pub(in crate::solver) fn ambient_of_the_rest(&self) -> Rgb {
        let [arriving, reflected] = self.fate();
        self.unshot_power() / self.area() * arriving / (Rgb::ONE - reflected)
    }

    fn area(&self) -> f64 {
        self.mesh.patches.iter().map(|patch| patch.area).sum()
    }

    /// Shares of the unshot light that meet the front of a surface, and that are reflected there, by rays from those
    /// that hold it.
    fn fate(&self) -> [Rgb; 2] {
        let strength = |(area, held): (&f64, &Rgb)| area * held.abs().element_sum();
        let held: Vec<f64> =
            self.areas.iter().zip(&self.state.unshot.radiosity).map(strength).collect();
        let all: f64 = held.iter().sum();
        if all <= 0.0 {
            return [Rgb::ZERO; 2];
        }
        let reflectances = self.reflectances_of_surfaces();
        let (mut cluster, mut passed) = (0, held[0]);
        let [mut arriving, mut reflected] = [Rgb::ZERO; 2];
        for ray in 0..RAYS {
            let wanted = all * (ray as f64 + 0.5) / RAYS as f64;
            while passed < wanted && cluster + 1 < held.len() {
                cluster += 1;
                passed += held[cluster];
            }
            let members = self.context.clusters.members(cluster);
            if let Some(surface) = self.met(&self.mesh[members[ray % members.len()]], ray) {
                arriving += Rgb::ONE / RAYS as f64;
                reflected += reflectances[surface] / RAYS as f64;
            }
        }
        [arriving, reflected]
    }

    /// By surface, its mean reflectance with all textures.
    fn reflectances_of_surfaces(&self) -> Vec<Rgb> {
        let mut sums = vec![(Rgb::ZERO, 0.0); self.context.surfaces.list.len()];
        for (patch, &reflectance) in self.mesh.patches.iter().zip(&self.context.optics.reflectance)
        {
            let (sum, area) = &mut sums[patch.surface.index()];
            *sum += reflectance * patch.area;
            *area += patch.area;
        }
        sums.into_iter().map(|(sum, area)| sum / area.max(f64::MIN_POSITIVE)).collect()
    }

    /// The surface whose front one of the rays meets that a patch's light may take.
    fn met(&self, patch: &Patch, ray: usize) -> Option<usize> {
        let middle = patch.corners.iter().sum::<DVec3>() / patch.corners.len() as f64;
        let met = self.context.occluders.first(middle, cosine_direction(patch.normal, ray))?;
        let surface = met.surface.index();
        (met.front || self.context.surfaces.list[surface].two_sided).then_some(surface)
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
