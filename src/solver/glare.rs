//! Patches on which light varies far beyond all others, as the places that gather it see them.
//!
//! The spot over an emitter that shines at the ceiling from close by is the usual one. What hides a part of such a
//! patch is often what lights it, so that the bright part is the hidden one: the share of cells that see the patch,
//! right for any other, would be wrong. So it is seen piece by piece.

use std::f64::consts::PI;

use glam::DVec3;
use smallvec::SmallVec;

use super::gather_points::IncidentLight;
use super::sources::{RadiosityPiece, Sources};
use crate::colour::Rgb;
use crate::form_factor::contour::point_to_polygon;
use crate::geometry::HalfSpace;
use crate::mesh::{ElementId, Mesh, PatchId};
use crate::visibility::{Occluders, SurfacePoint};

/// Radiosity that varies by more than this many times the mean of the scene glares.
const GLARING: f64 = 4.0;

/// Deepest division of a leaf.
const DEEPEST: u32 = 6;

/// By element, whether its radiosity varies so much, in a scene with a mean radiosity of `mean`, W/m².
pub(super) fn glaring(mesh: &Mesh, sources: &Sources<'_>, mean: f64) -> Vec<bool> {
    let elements = mesh.element_ids();
    elements.map(|element| sources.spread(element) > GLARING * mean).collect()
}

/// A place that light is gathered at, looking at one patch that glares.
pub(super) struct Gaze<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) occluders: &'a Occluders,
    pub(super) sources: &'a Sources<'a>,
    /// The place.
    pub(super) eye: SurfacePoint,
    /// Differences of irradiance that do not matter, W/m².
    pub(super) fine: f64,
}

/// One such patch before that place.
struct Look<'g, 'a> {
    gaze: &'g Gaze<'a>,
    /// Unit normal of the patch.
    normal: DVec3,
    /// Whether nothing stands before it.
    is_clear: bool,
    /// How many factors it took so far.
    factors: u64,
}

impl Gaze<'_> {
    /// Tells `arrive` of the light of a patch. Returns the patch's form factor, as if nothing stood before it, and how
    /// many factors it took.
    pub(super) fn receive(
        &self,
        patch: PatchId,
        arrive: &mut impl FnMut(&IncidentLight<'_>),
    ) -> (f64, u64) {
        let Self { mesh, sources, eye: SurfacePoint { position: site, normal }, .. } = *self;
        let patch = &mesh[patch];
        let above = HalfSpace::new(site, normal).clip(&patch.corners);
        let is_before = (site - patch.corners[0]).dot(patch.normal) > self.occluders.epsilon();
        if above.len() < 3 || !is_before {
            return (0.0, 0);
        }
        let is_clear = !self.occluders.may_be_hidden(site, &above, patch.normal);
        let mut look = Look { gaze: self, normal: patch.normal, is_clear, factors: 0 };
        let mut open: SmallVec<[ElementId; 32]> = SmallVec::from_elem(patch.root, 1);
        while let Some(source) = open.pop() {
            let piece = sources.piece(mesh, source);
            let factor = look.factor(&piece.corners);
            let parts = sources.parts(mesh, source);
            if !parts.is_empty() && look.is_coarse(factor, sources.spread(source)) {
                open.extend_from_slice(parts);
                continue;
            }
            let light = look.light(&piece, factor, DEEPEST);
            arrive(&IncidentLight { light, corners: &piece.corners });
        }
        (look.factor(&patch.corners), look.factors)
    }
}

impl Look<'_, '_> {
    /// Irradiance by a piece of a leaf with this form factor, divided while its variation matters.
    fn light(&mut self, piece: &RadiosityPiece, factor: f64, depth: u32) -> Rgb {
        if depth == 0 || !self.is_coarse(factor, piece.spread()) {
            return if self.is_clear { piece.mean() * factor } else { self.seen(piece) };
        }
        let parts = piece.parts().into_iter();
        let mut light = |part: RadiosityPiece| {
            let factor = self.factor(&part.corners);
            self.light(&part, factor, depth - 1)
        };
        parts.map(&mut light).sum()
    }

    /// True if a source whose radiosity is up to so far from its mean, W/m², may send more or less than it seems to by
    /// as much as matters.
    ///
    /// Of what is seen whole, the mean is right but for how unlike its parts are seen: the less, the smaller it looks.
    fn is_coarse(&self, factor: f64, spread: f64) -> bool {
        let unlike = if self.is_clear { size(factor).min(1.0) } else { 1.0 };
        factor * spread * unlike > self.gaze.fine
    }

    /// Irradiance by what is not hidden of a piece.
    fn seen(&mut self, piece: &RadiosityPiece) -> Rgb {
        let SurfacePoint { position: site, normal } = self.gaze.eye;
        let above = HalfSpace::new(site, normal).clip(&piece.corners);
        if above.len() < 3 {
            return Rgb::ZERO;
        }
        let seen = self.gaze.occluders.visible_pieces(site, &above, self.normal);
        seen.iter().map(|part| piece.at(middle(part)) * self.factor(part)).sum()
    }

    fn factor(&mut self, corners: &[DVec3]) -> f64 {
        self.factors += 1;
        point_to_polygon(self.gaze.eye.position, self.gaze.eye.normal, corners)
    }
}

/// How large something looks that has this form factor, and is seen from the front: its size over its distance.
fn size(factor: f64) -> f64 {
    2.0 * (PI * factor).sqrt()
}

fn middle(corners: &[DVec3]) -> DVec3 {
    corners.iter().sum::<DVec3>() / corners.len() as f64
}
