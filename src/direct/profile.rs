//! How the radiance of an emitter depends on the direction from which it comes, and what arrives of it.

use std::f64::consts::PI;

use glam::DVec3;

use crate::form_factor::contour::point_to_polygon_above;
use crate::geometry::Polygon;
use crate::visibility::SurfacePoint;

/// How an emitter's radiance depends on the direction from which it comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RadianceProfile {
    /// Not at all, from a surface.
    Diffuse,
    /// Not at all, from the sky.
    UniformSky,
    /// As that of an overcast sky.
    OvercastSky,
}

impl RadianceProfile {
    /// Irradiance of a place with unit normal by a polygon above its horizon, as a share of the exitance.
    pub(super) fn weight(self, receiver: SurfacePoint, polygon: &[DVec3]) -> f64 {
        let factor = point_to_polygon_above(receiver.position, receiver.normal, polygon);
        match self {
            Self::Diffuse | Self::UniformSky => factor,
            Self::OvercastSky => overcast(receiver, polygon, factor),
        }
    }

    /// Radiance along a unit direction towards the emitter, as a share of the largest.
    pub(super) fn radiance(self, direction: DVec3) -> f64 {
        match self {
            Self::Diffuse | Self::UniformSky => 1.0,
            Self::OvercastSky => overcast_radiance(direction),
        }
    }

    pub(super) fn is_sky(self) -> bool {
        self != Self::Diffuse
    }
}

/// Irradiance by the part of an overcast sky that is seen in a polygon, as a share of π Lz; the polygon is above
/// the horizon of a place with unit `normal`.
///
/// ∫ (1 + 2 sin γ)/3 cos θ dω = (π F + 2 ∫ (Y·ω)(n·ω) dω)/3, the second by the irradiance tensor of rank two,
/// 3 Y·T·n = (Y·n) Ω - Σₖ (n·mₖ) Y·∫ω ds over the edges with outward normals mₖ ([Arvo 1995]).
///
/// [Arvo 1995]: https://doi.org/10.1145/218380.218467
fn overcast(receiver: SurfacePoint, polygon: &[DVec3], form_factor: f64) -> f64 {
    let SurfacePoint { position: place, normal } = receiver;
    let rays: Polygon = polygon.iter().map(|&p| (p - place).normalize_or_zero()).collect();
    let middle = rays.iter().sum::<DVec3>();
    let mut sum = normal.y * solid_angle(&rays);
    for (k, &a) in rays.iter().enumerate() {
        let b = rays[(k + 1) % rays.len()];
        let cross = a.cross(b);
        let Some(side) = cross.try_normalize() else { continue };
        let outward = if side.dot(middle) > 0.0 { -side } else { side };
        // ∫ω ds along the arc: (a + b) tan(Θ/2).
        let arc = (a + b) * (cross.length() / (1.0 + a.dot(b)).max(f64::MIN_POSITIVE));
        sum -= normal.dot(outward) * arc.y;
    }
    ((form_factor + 2.0 * sum / (3.0 * PI)) / 3.0).max(0.0)
}

/// Solid angle of a convex spherical polygon, sr ([Van Oosterom and Strackee 1983]).
///
/// [Van Oosterom and Strackee 1983]: https://doi.org/10.1109/TBME.1983.325207
pub(super) fn solid_angle(rays: &[DVec3]) -> f64 {
    let triangle = |pair: &[DVec3]| {
        let (a, b, c) = (rays[0], pair[0], pair[1]);
        let below = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
        2.0 * a.dot(b.cross(c)).abs().atan2(below)
    };
    rays.windows(2).skip(1).map(triangle).sum()
}

/// Radiance of an overcast sky in a unit direction, as a share of that at the zenith.
fn overcast_radiance(direction: DVec3) -> f64 {
    (1.0 + 2.0 * direction.y.max(0.0)) / 3.0
}
