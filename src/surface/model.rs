//! The surfaces themselves, and what of the scene light and pictures depend on besides.

use glam::{DAffine2, DVec2, DVec3};
use serde::Serialize;

use super::ids::SurfaceId;
use super::tint::Tint;
use crate::colour::Rgb;
use crate::error::{Error, Result};
use crate::geometry::Plane;
use crate::geometry::boxes::{self, Aabb};
use crate::geometry::polygon::{self, Ring, Segment};
use crate::scene::{Camera, Material, MaterialId, NamedLight, Node, Texture};

/// Distances below this share of the scene's extent count as zero: ten times the rounding of 32-bit
/// coordinates.
pub(super) const EPSILON: f64 = 2e-7;

/// All surfaces of a scene, and what else of it light and pictures depend on.
#[derive(Clone, Debug, Serialize)]
pub struct Surfaces {
    /// The surfaces, in the order in which the scene first names them.
    pub list: Vec<Surface>,
    /// Names of the scene's objects.
    pub objects: Vec<String>,
    /// The hierarchy that they stand in.
    pub nodes: Vec<Node>,
    /// The scene's cameras, which the hierarchy has places for.
    pub cameras: Vec<Camera>,
    /// Lights without a surface.
    pub lights: Vec<NamedLight>,
    /// The scene's materials.
    pub materials: Vec<Material>,
    /// The scene's textures.
    pub textures: Vec<Texture>,
    /// Diagonal of the scene's bounding box, m, without what is very much larger than all the rest, like the
    /// ground on which a house stands.
    pub extent: f64,
    /// Distances that count as zero, m.
    pub epsilon: f64,
    /// What was done about faces in one place, a line each, for the user to read.
    pub notes: Vec<String>,
    /// Why the scene has no surfaces, if it could not be looked at.
    pub flaw: Option<String>,
}

/// A planar polygon of one material that reflects and emits from its front.
#[derive(Clone, Debug, Serialize)]
pub struct Surface {
    /// Where it lies.
    pub plane: Plane,
    /// Outer ring first, counter-clockwise; holes clockwise; coordinates of the plane, m.
    pub rings: Vec<Ring>,
    /// Lines along which another surface meets this one, or hovers close over it.
    pub contacts: Vec<Contact>,
    /// Diffuse reflectance ρ, 0..=0.99, without the tint's and the texture's part.
    pub reflectance: Rgb,
    /// Factor on it by the colours of vertices.
    pub tint: Tint,
    /// Exitance E = πL, W/m², without the texture's part.
    pub exitance: Rgb,
    /// Its material.
    pub material: MaterialId,
    /// Index into [`Surfaces::objects`]: that of its first face.
    pub object: u32,
    /// From plane coordinates to texture coordinates, where there is a texture.
    pub uv: Option<DAffine2>,
    /// Unit normals of the curved surface it approximates, one per corner of the outer ring; empty if flat.
    pub normals: Vec<DVec3>,
    /// True if it is one of the two sides of a double-sided polygon; the other side has an entry of
    /// its own.
    pub two_sided: bool,
    /// True for the second entry of a double-sided polygon, which blocks no light beyond the first.
    pub is_back: bool,
}

/// A line on a surface along which another surface meets it, or ends close over it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Contact {
    /// Where it runs, in coordinates of the surface's plane, m.
    pub segment: Segment,
    /// How far over the surface the other ends, m; 0 where they meet.
    pub gap: f64,
}

impl Surfaces {
    /// Whether there are any.
    ///
    /// # Errors
    /// [`Error::Scene`] with the [flaw](Self::flaw) of the scene.
    pub fn check(&self) -> Result<()> {
        match &self.flaw {
            Some(flaw) => Err(Error::Scene(flaw.clone())),
            None => Ok(()),
        }
    }

    /// What names each of them, in their order.
    pub fn ids(&self) -> impl Iterator<Item = SurfaceId> + use<> {
        (0..self.list.len() as u32).map(SurfaceId)
    }

    /// The other side of a double-sided polygon; none of any other surface.
    pub fn other_side(&self, id: SurfaceId) -> Option<SurfaceId> {
        let Surface { two_sided, is_back, .. } = self[id];
        two_sided.then(|| SurfaceId(if is_back { id.0 - 1 } else { id.0 + 1 }))
    }

    /// Opposite corners of the box around all surfaces, m; `None` without any.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let bounds = self.list.iter().map(Surface::bounds);
        bounds.reduce(|(low, high), (a, b)| (low.min(a), high.max(b)))
    }

    /// Area of all surfaces, m².
    pub fn area(&self) -> f64 {
        self.list.iter().map(Surface::area).sum()
    }

    /// Area of all surfaces, m², that of those beyond [`Self::extent`] reduced as their patches are larger.
    pub fn divided_area(&self) -> f64 {
        let share = |surface: &Surface| (self.extent / surface.extent().max(self.extent)).powi(2);
        self.list.iter().map(|surface| surface.area() * share(surface)).sum()
    }
}

impl Surface {
    /// Opposite corners of its bounding box, m.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let Aabb { low, high } = self.aabb();
        (low, high)
    }

    /// Its bounding box.
    pub(crate) fn aabb(&self) -> Aabb {
        boxes::around(self.rings.iter().flatten().map(|&p| self.plane.lift(p)))
    }

    /// Diagonal of its bounding box, m.
    pub fn extent(&self) -> f64 {
        let (low, high) = self.bounds();
        low.distance(high)
    }

    /// Area, m².
    pub fn area(&self) -> f64 {
        self.rings.iter().map(|ring| polygon::area(ring)).sum()
    }

    /// Diffuse reflectance at a place of its plane, without the texture's part.
    pub fn reflectance_at(&self, place: DVec2) -> Rgb {
        self.reflectance * self.tint.at(place)
    }

    /// True if it reflects light somewhere.
    pub fn reflects(&self) -> bool {
        self.reflectance.max_element() > 0.0 && self.tint.uniform() != Some(Rgb::ZERO)
    }

    /// True if it sends out light of its own.
    pub fn is_emitter(&self) -> bool {
        self.exitance.max_element() > 0.0
    }
}
