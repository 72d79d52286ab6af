//! The kinds of lamps, and how regions and places see them.

use glam::DVec3;

use super::RadianceProfile;
use super::globe::Globe;
use super::view::{Receiver, View};
use crate::colour::Rgb;
use crate::scene::Light;
use crate::visibility::{Body, Facet, HalfSpace, Polygon};

/// An emitter.
#[derive(Clone, Debug)]
pub(super) enum Lamp {
    Area(AreaLamp),
    Globe(Globe),
    /// Without a surface.
    Point(Light),
}

/// A convex polygon that emits from its front.
#[derive(Clone, Debug)]
pub(super) struct AreaLamp {
    pub(super) corners: Polygon,
    pub(super) front: HalfSpace,
    /// W/m²; of skies, at the zenith.
    pub(super) exitance: Rgb,
    pub(super) profile: RadianceProfile,
}

impl Lamp {
    /// Where it is, if it is somewhere.
    pub(super) fn body(&self) -> Option<Body> {
        match self {
            Self::Area(lamp) => {
                Some(Body::polygon(Facet { corners: &lamp.corners, plane: lamp.front }))
            }
            Self::Globe(globe) => Some(Body::cuboid(globe.low, globe.high)),
            Self::Point(light) => light.position().map(Body::point),
        }
    }

    /// The part of it that some place on a receiver may see, if it is somewhere.
    pub(super) fn body_above(&self, receiver: Facet<'_>) -> Option<Body> {
        match self {
            Self::Area(lamp) => {
                let above = lamp.above(receiver)?;
                Some(Body::polygon(Facet { corners: &above, plane: lamp.front }))
            }
            other => other.body(),
        }
    }

    /// False only if no place on the receiver is lit, whatever stands between.
    pub(super) fn may_reach(&self, receiver: Facet<'_>) -> bool {
        let is_above = |p: DVec3| receiver.plane.depth(p) >= 0.0;
        match self {
            Self::Area(lamp) => {
                receiver.corners.iter().any(|&corner| lamp.front.depth(corner) > 0.0)
                    && lamp.corners.iter().any(|&corner| is_above(corner))
            }
            Self::Globe(globe) => {
                let up = receiver.plane.normal.cmpge(DVec3::ZERO);
                is_above(DVec3::select(up, globe.high, globe.low))
            }
            Self::Point(light) => light.position().is_none_or(is_above),
        }
    }

    /// True if a surface is the lamp itself and hides nothing of it.
    pub(super) fn is_part(&self, surface: u32) -> bool {
        matches!(self, Self::Globe(globe) if globe.surfaces.binary_search(&surface).is_ok())
    }

    /// As a place with a unit normal sees it, if it sees something; lights without a surface have no view.
    pub(super) fn view(&self, receiver: Receiver) -> Option<View<'_>> {
        match self {
            Self::Area(lamp) => lamp.view(receiver),
            Self::Globe(globe) => globe.view(receiver),
            Self::Point(_) => None,
        }
    }
}

impl AreaLamp {
    fn view(&self, receiver: Receiver) -> Option<View<'_>> {
        if self.front.depth(receiver.0) <= 0.0 {
            return None;
        }
        let polygon = self.above_plane(HalfSpace::new(receiver.0, receiver.1));
        (!polygon.is_empty()).then(|| View {
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
    pub(super) fn above(&self, receiver: Facet<'_>) -> Option<Polygon> {
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
