//! The kinds of emitters, and how regions and places see them.

use std::f64::consts::PI;

use glam::DVec3;

use super::globe::Globe;
use super::profile::RadianceProfile;
use super::view::{EmitterView, FAR};
use crate::colour::Rgb;
use crate::geometry::area_vector;
use crate::geometry::{HalfSpace, PlanarPolygon, Polygon};
use crate::scene::Light;
use crate::surface::SurfaceId;
use crate::visibility::{ConvexBody, SurfacePoint};

/// An emitter.
#[derive(Clone, Debug)]
pub(super) enum Emitter {
    Area(AreaEmitter),
    Globe(Globe),
    /// Without a surface.
    Point(Light),
}

/// A convex polygon that emits from its front.
#[derive(Clone, Debug)]
pub(super) struct AreaEmitter {
    pub(super) corners: Polygon,
    pub(super) front: HalfSpace,
    /// W/m²; of skies, at the zenith.
    pub(super) exitance: Rgb,
    pub(super) profile: RadianceProfile,
}

impl Emitter {
    /// Where it is, if it is somewhere.
    pub(super) fn body(&self) -> Option<ConvexBody> {
        match self {
            Self::Area(emitter) => Some(ConvexBody::polygon(PlanarPolygon {
                corners: &emitter.corners,
                plane: emitter.front,
            })),
            Self::Globe(globe) => Some(ConvexBody::cuboid(globe.low, globe.high)),
            Self::Point(light) => light.position().map(ConvexBody::point),
        }
    }

    /// The part of it that some place on a receiver may see, if it is somewhere.
    pub(super) fn body_above(&self, receiver: PlanarPolygon<'_>) -> Option<ConvexBody> {
        match self {
            Self::Area(emitter) => {
                let above = emitter.above(receiver)?;
                Some(ConvexBody::polygon(PlanarPolygon { corners: &above, plane: emitter.front }))
            }
            other => other.body(),
        }
    }

    /// No place on a body gets more than this, whatever stands between, as the mean of the channels, W/m².
    ///
    /// E ≤ M min(1, A cos cos / (π d²)), by the greatest cosines and the shortest distance between boxes, after
    /// [Smits, Arvo and Greenberg 1994]; of lights without a surface and of skies, no bound is known.
    ///
    /// [Smits, Arvo and Greenberg 1994]: https://doi.org/10.1145/192161.192277
    pub(super) fn most_on(&self, receiver: &ConvexBody) -> f64 {
        let (exitance, area) = match self {
            Self::Area(emitter) if !emitter.profile.is_sky() => {
                (emitter.exitance, area_vector(&emitter.corners).length())
            }
            Self::Globe(globe) => {
                (globe.exitance, 0.25 * PI * globe.low.distance_squared(globe.high))
            }
            _ => return f64::INFINITY,
        };
        let Some(source) = self.body() else { return f64::INFINITY };
        let [(low, high), (lowest, highest)] = [receiver.bounds(), source.bounds()];
        let distance = (lowest - high).max(low - highest).max(DVec3::ZERO).length();
        let cosine = |front: Option<HalfSpace>, body: &ConvexBody| {
            let height = |plane: HalfSpace| {
                body.corners().iter().map(|&corner| plane.depth(corner)).fold(0.0, f64::max)
            };
            front.map_or(1.0, |plane| (height(plane) / distance).min(1.0))
        };
        if distance <= 0.0 {
            return exitance.element_sum() / 3.0;
        }
        let cosines = cosine(receiver.front(), &source) * cosine(source.front(), receiver);
        exitance.element_sum() / 3.0 * (area * cosines / (PI * distance * distance)).min(1.0)
    }

    /// What arrives at a place if nothing stands between, W/m², and from where, by the middle of a polygon that looks
    /// small; `None` of all others.
    pub(super) fn glance(&self, receiver: SurfacePoint) -> Option<(Rgb, DVec3)> {
        let SurfacePoint { position: place, normal } = receiver;
        let Self::Area(emitter) = self else { return None };
        let middle = emitter.corners.iter().sum::<DVec3>() / emitter.corners.len() as f64;
        let (way, area) = (middle - place, area_vector(&emitter.corners).length());
        let square = way.length_squared();
        if area > FAR * square || emitter.profile.is_sky() {
            return None;
        }
        let cosines = way.dot(normal).max(0.0) * (-way.dot(emitter.front.normal)).max(0.0);
        Some((emitter.exitance * (area * cosines / (PI * square * square)), middle))
    }

    /// False only if no place on the receiver is lit, whatever stands between.
    pub(super) fn may_reach(&self, receiver: PlanarPolygon<'_>) -> bool {
        let is_above = |p: DVec3| receiver.plane.depth(p) >= 0.0;
        match self {
            Self::Area(emitter) => {
                receiver.corners.iter().any(|&corner| emitter.front.depth(corner) > 0.0)
                    && emitter.corners.iter().any(|&corner| is_above(corner))
            }
            Self::Globe(globe) => {
                let up = receiver.plane.normal.cmpge(DVec3::ZERO);
                is_above(DVec3::select(up, globe.high, globe.low))
            }
            Self::Point(light) => light.position().is_none_or(is_above),
        }
    }

    /// True if a surface is the emitter itself and hides nothing of it.
    pub(super) fn is_part(&self, surface: SurfaceId) -> bool {
        matches!(self, Self::Globe(globe) if globe.surfaces.binary_search(&surface).is_ok())
    }

    /// As a place with a unit normal sees it, if it sees something; lights without a surface have no view.
    pub(super) fn view(&self, receiver: SurfacePoint) -> Option<EmitterView<'_>> {
        match self {
            Self::Area(emitter) => emitter.view(receiver),
            Self::Globe(globe) => globe.view(receiver),
            Self::Point(_) => None,
        }
    }
}

impl AreaEmitter {
    fn view(&self, receiver: SurfacePoint) -> Option<EmitterView<'_>> {
        if self.front.depth(receiver.position) <= 0.0 {
            return None;
        }
        let polygon = self.above_plane(HalfSpace::new(receiver.position, receiver.normal));
        (!polygon.is_empty()).then(|| EmitterView {
            weight: self.profile.weight(receiver, &polygon),
            receiver,
            polygon,
            normal: self.front.normal,
            exitance: self.exitance,
            profile: self.profile,
            own: &[],
        })
    }

    /// The part that some place on a receiver may see, if there is one.
    pub(super) fn above(&self, receiver: PlanarPolygon<'_>) -> Option<Polygon> {
        let faces = receiver.corners.iter().any(|&corner| self.front.depth(corner) > 0.0);
        let above = self.above_plane(receiver.plane);
        (faces && !above.is_empty()).then_some(above)
    }

    fn above_plane(&self, horizon: HalfSpace) -> Polygon {
        if self.corners.iter().all(|&corner| horizon.depth(corner) >= 0.0) {
            return self.corners.clone();
        }
        horizon.clip(&self.corners)
    }
}
