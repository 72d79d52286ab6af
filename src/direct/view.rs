//! An emitter as a place sees it, and how much of it that is.

use glam::DVec3;

use super::profile::RadianceProfile;
use crate::colour::Rgb;
use crate::form_factor::contour::point_to_polygon;
use crate::geometry::{PlanarPolygon, Polygon};
use crate::light::Direct;
use crate::surface::SurfaceId;
use crate::visibility::{Blockers, Occluders, Pyramid, SurfacePoint};

/// Polygons of a smaller area than this share of the squared distance are taken for points.
pub(super) const FAR: f64 = 0.01;

/// The part of an emitter above the horizon of a place, as a convex polygon.
#[derive(Clone, Debug)]
pub(super) struct EmitterView<'a> {
    pub(super) receiver: SurfacePoint,
    pub(super) polygon: Polygon,
    /// Unit normal of the polygon, towards the place.
    pub(super) normal: DVec3,
    /// W/m²; of skies, at the zenith.
    pub(super) exitance: Rgb,
    pub(super) profile: RadianceProfile,
    /// The whole polygon's irradiance as a share of the exitance.
    pub(super) weight: f64,
    /// Surfaces that are the emitter itself and hide nothing of it.
    pub(super) own: &'a [SurfaceId],
}

/// How much of an emitter is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// Irradiance as a share of the exitance.
    pub(super) weight: f64,
    /// Rays that it took.
    pub(super) rays: u64,
}

impl EmitterView<'_> {
    /// What arrives if nothing stands between, W/m².
    pub(super) fn unoccluded(&self) -> Rgb {
        self.exitance * self.weight
    }

    /// What arrives if so much of it is seen.
    pub(super) fn light(&self, seen: Seen) -> Direct {
        let irradiance = self.exitance * seen.weight.min(self.weight);
        Direct { irradiance, unoccluded: self.unoccluded() }
    }

    /// All of it.
    pub(super) fn all(&self) -> Seen {
        Seen { weight: self.weight, rays: 0 }
    }

    /// What is not hidden, cut out exactly; `None` if more than `most` stand in between, or too many for that.
    pub(super) fn exact(
        &self,
        occluders: &Occluders,
        blockers: &Blockers,
        most: usize,
    ) -> Option<Seen> {
        if blockers.is_clear() {
            return Some(self.all());
        }
        let base = PlanarPolygon::new(&self.polygon, self.normal);
        let view = Pyramid { apex: self.receiver.position, base };
        let is_own = |surface| self.is_own(surface);
        let pieces = occluders.visible_among(view, blockers, most, is_own)?;
        let weight = pieces.iter().map(|piece| self.profile.weight(self.receiver, piece)).sum();
        Some(Seen { weight, rays: 0 })
    }

    /// Whether a place on it is seen.
    pub(super) fn sees(&self, occluders: &Occluders, at: DVec3) -> bool {
        !occluders.blocks_beyond(self.receiver.position, at, |surface| self.is_own(surface))
    }

    /// Irradiance by a triangle of it, as a share of the exitance: the smaller it looks, the more exact.
    pub(super) fn weight_of(&self, triangle: &[DVec3; 3]) -> f64 {
        let SurfacePoint { position: place, normal } = self.receiver;
        let [a, b, c] = *triangle;
        let (middle, sides) = ((a + b + c) / 3.0, (b - a).cross(c - a));
        let towards = middle - place;
        let area = sides.length() / 2.0;
        if area < FAR * towards.length_squared() {
            return area * self.kernel(middle);
        }
        self.profile.radiance(towards.normalize_or_zero())
            * point_to_polygon(place, normal, triangle)
    }

    /// Weight of a small piece of it over its area, 1/m²: cos cos / (π d²) where it glows evenly.
    pub(super) fn kernel(&self, at: DVec3) -> f64 {
        let SurfacePoint { position: place, normal } = self.receiver;
        let way = at - place;
        let square = way.length_squared();
        let cosines = way.dot(normal).max(0.0) * (-way.dot(self.normal)).max(0.0);
        if square > 0.0 {
            self.profile.radiance(way / square.sqrt()) * cosines
                / (std::f64::consts::PI * square * square)
        } else {
            0.0
        }
    }

    fn is_own(&self, surface: SurfaceId) -> bool {
        self.own.binary_search(&surface).is_ok()
    }
}
