//! Planar polygons of one material, made by joining coplanar neighbours, and where others touch them.

mod contact;
pub mod cut;
mod light_group;
mod mask;
mod merge;
mod outliers;
mod overlap;
mod partly;
mod picture;
mod plane;
pub mod polygon;
mod tint;
mod weld;

use glam::{DAffine2, DMat2, DVec2, DVec3};

use crate::colour::Rgb;
use crate::error::{Error, Result};
use crate::scene::boxes;
use crate::scene::{Camera, Material, NamedLight, Node, Scene, Texture};

pub use contact::Contact;
pub use light_group::{LightGroup, StrengthUnit};
pub use picture::{mean_reflectance, mean_texture};
pub use plane::Plane;
pub use polygon::{Ring, Segment};
pub use tint::Tint;
pub use weld::Weld;
pub(crate) use weld::{Cells, cell_key, cells_around};

/// All surfaces of a scene, and what else of it light and pictures depend on.
#[derive(Clone, Debug)]
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
    pub tolerance: f64,
    /// What was done about faces in one place, a line each, for the user to read.
    pub notes: Vec<String>,
    /// Why the scene has no surfaces, if it could not be looked at.
    pub flaw: Option<String>,
}

/// A planar polygon of one material that reflects and emits from its front.
#[derive(Clone, Debug)]
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
    /// Index into [`Surfaces::materials`].
    pub material: u32,
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

/// Distances below this share of the scene's extent count as zero: ten times the rounding of 32-bit
/// coordinates.
const TOLERANCE: f64 = 2e-7;

/// The surfaces of a scene and their contact lines; none, with a [flaw](Surfaces::flaw), of one that was made in code
/// and says what cannot be.
pub fn surfaces_of(scene: &Scene) -> Surfaces {
    if let Some(flaw) = scene.flaw() {
        return Surfaces::none(flaw);
    }
    let regions = merge::regions(scene, TOLERANCE * scene.extent());
    let mut notes = Vec::new();
    let regions = mask::cut(scene, regions, &mut notes);
    let regions = overlap::without_overlaps(scene, regions, &mut notes);
    with_contacts(of_regions(scene, regions), notes)
}

/// The faces of a scene, each a surface of its own, or several if its material has holes, and their contact lines; or a [flaw](Surfaces::flaw).
pub fn faces_of(scene: &Scene) -> Surfaces {
    if let Some(flaw) = scene.flaw() {
        return Surfaces::none(flaw);
    }
    let mut notes = Vec::new();
    let regions = mask::cut(scene, merge::single_faces(scene), &mut notes);
    with_contacts(of_regions(scene, regions), notes)
}

fn with_contacts(mut surfaces: Surfaces, notes: Vec<String>) -> Surfaces {
    if surfaces.list.is_empty() {
        return Surfaces::none("cut-outs leave nothing of the scene's faces".to_owned());
    }
    contact::find_contacts(&mut surfaces.list, surfaces.extent, surfaces.tolerance);
    Surfaces { notes, ..surfaces }
}

fn of_regions(scene: &Scene, regions: Vec<merge::Region>) -> Surfaces {
    let mut list = Vec::new();
    for region in regions {
        if region.rings.is_empty() {
            continue;
        }
        let front = Surface::front(scene, region);
        let back = front.two_sided.then(|| front.back());
        list.push(front);
        list.extend(back);
    }
    let extent = outliers::usual_extent(&list);
    let tolerance = TOLERANCE * extent;
    Surfaces {
        list,
        objects: scene.objects.clone(),
        nodes: scene.nodes.clone(),
        cameras: scene.cameras.clone(),
        lights: scene.lights.clone(),
        materials: scene.materials.clone(),
        textures: scene.textures.clone(),
        extent,
        tolerance,
        notes: Vec::new(),
        flaw: None,
    }
}

impl Surfaces {
    /// Those of a scene that cannot be looked at.
    fn none(flaw: String) -> Self {
        Self { flaw: Some(flaw), ..of_regions(&Scene::default(), Vec::new()) }
    }

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
    fn front(scene: &Scene, region: merge::Region) -> Self {
        let face = &scene.faces[region.faces[0]];
        let material = &scene.materials[face.material as usize];
        Self {
            plane: region.plane,
            rings: region.rings,
            contacts: Vec::new(),
            reflectance: material.reflectance,
            tint: region.look.tint,
            exitance: material.emission * std::f64::consts::PI,
            material: face.material,
            object: face.object,
            uv: region.look.uv,
            normals: region.normals,
            two_sided: material.double_sided,
            is_back: false,
        }
    }

    /// The other side of a double-sided polygon: the same places, seen from behind.
    fn back(&self) -> Self {
        let swap = |ring: &Ring| ring.iter().rev().map(|p| DVec2::new(p.y, p.x)).collect();
        Self {
            plane: self.plane.reversed(),
            rings: self.rings.iter().map(swap).collect(),
            uv: self.uv.map(|uv| uv * DAffine2::from_mat2(SWAP)),
            tint: self.tint.reversed(),
            normals: self.normals.iter().rev().map(|&n| -n).collect(),
            is_back: true,
            ..self.clone()
        }
    }

    /// Opposite corners of its bounding box, m.
    pub fn bounds(&self) -> (DVec3, DVec3) {
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

/// Exchanges the two coordinates.
const SWAP: DMat2 = DMat2::from_cols(DVec2::Y, DVec2::X);
