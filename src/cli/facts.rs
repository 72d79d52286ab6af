//! A scene in figures, for people and for programs.

use std::fmt::{self, Display, Formatter};
use std::path::PathBuf;

use radiosity::colour::{LUMENS_PER_WATT, Rgb, luminance};
use radiosity::light::Optics;
use radiosity::mesh::Mesh;
use radiosity::scene::{Light, Material, NamedLight};
use radiosity::{Scene, Surfaces};
use serde::Serialize;

use super::options::HINT;
use super::record::{CameraRecord, triple};

/// A scene in figures.
#[derive(Debug, Serialize)]
pub(crate) struct Facts {
    scene: PathBuf,
    faces: usize,
    surfaces: usize,
    /// Area of all surfaces, m².
    area: f64,
    contact_lines: usize,
    patches: usize,
    /// Opposite corners of the bounding box, m.
    bounds: [[f64; 3]; 2],
    materials: Vec<MaterialFacts>,
    lights: Vec<LightFacts>,
    cameras: Vec<CameraRecord>,
    notes: Vec<String>,
}

#[derive(Debug, Serialize)]
struct MaterialFacts {
    name: String,
    reflectance: [f64; 3],
    /// Emitted radiance, W/(m² sr).
    emission: [f64; 3],
    double_sided: bool,
    texture: Option<String>,
    emission_texture: Option<String>,
    /// Area of its surfaces, m².
    area: f64,
    /// Power they emit, W per channel.
    power: [f64; 3],
    /// The same as luminous flux, lm.
    flux: f64,
}

#[derive(Debug, Serialize)]
struct LightFacts {
    name: String,
    kind: &'static str,
    /// In the unit.
    strength: [f64; 3],
    /// W/sr of points; W/m² of directional lights and suns, facing them, and of skies, horizontally; W of luminaires.
    unit: &'static str,
}

impl Facts {
    pub(crate) fn new(path: PathBuf, scene: &Scene, surfaces: &Surfaces, mesh: &Mesh) -> Self {
        let (low, high) = scene.bounds().unwrap_or_default();
        let mut notes = [scene.notes.as_slice(), &surfaces.notes].concat();
        if !scene.is_lit() {
            notes.push(format!("nothing emits light; this cannot be solved; {HINT}"));
        }
        if surfaces.extent < 0.9 * scene.extent() {
            notes.push(format!(
                "some surfaces are much larger than the rest; sizes go by the rest, {:.3} m across",
                surfaces.extent
            ));
        }
        let totals = totals(scene.materials.len(), surfaces, mesh);
        let material = |(material, totals)| MaterialFacts::new(scene, material, totals);
        Self {
            scene: path,
            faces: scene.faces.len(),
            surfaces: surfaces.list.len(),
            area: surfaces.area(),
            contact_lines: surfaces.list.iter().map(|surface| surface.contacts.len()).sum(),
            patches: mesh.patches.len(),
            bounds: [low.to_array(), high.to_array()],
            materials: scene.materials.iter().zip(totals).map(material).collect(),
            lights: scene.lights.iter().map(LightFacts::from).collect(),
            cameras: scene.cameras.iter().map(CameraRecord::from).collect(),
            notes,
        }
    }
}

impl MaterialFacts {
    fn new(scene: &Scene, material: &Material, totals: Totals) -> Self {
        let Totals { area, power } = totals;
        let texture = |index: Option<u32>| Some(scene.textures.get(index? as usize)?.name.clone());
        Self {
            name: material.name.clone(),
            reflectance: material.reflectance.to_array(),
            emission: material.emission.to_array(),
            double_sided: material.double_sided,
            texture: texture(material.texture),
            emission_texture: texture(material.emission_texture),
            area,
            power: power.to_array(),
            flux: luminance(power) * LUMENS_PER_WATT,
        }
    }
}

/// Of the surfaces of a material together.
#[derive(Clone, Copy, Default)]
struct Totals {
    /// m².
    area: f64,
    /// What they emit, W.
    power: Rgb,
}

/// By material.
fn totals(materials: usize, surfaces: &Surfaces, mesh: &Mesh) -> Vec<Totals> {
    let mut totals = vec![Totals::default(); materials];
    for (patch, exitance) in mesh.patches.iter().zip(Optics::new(surfaces, mesh).exitance) {
        let own = &mut totals[surfaces[patch.surface].material.index()];
        own.area += patch.area;
        own.power += exitance * patch.area;
    }
    totals
}

impl From<&NamedLight> for LightFacts {
    fn from(NamedLight { name, light }: &NamedLight) -> Self {
        let watts = |lumens: f64| Rgb::splat(lumens / LUMENS_PER_WATT);
        let (strength, unit) = match light {
            Light::Luminaire { photometry, .. } => (watts(photometry.flux()), "W"),
            Light::Point { .. } | Light::Spot { .. } => {
                (light.strength().unwrap_or_default(), "W/sr")
            }
            _ => (light.strength().unwrap_or_default(), "W/m²"),
        };
        Self { name: name.clone(), kind: light.kind(), strength: strength.to_array(), unit }
    }
}

impl Display for Facts {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [low, high] = self.bounds;
        let size = [0, 1, 2].map(|axis| high[axis] - low[axis]);
        writeln!(f, "{}", self.scene.display())?;
        writeln!(f, "size       {} m, from {} to {}", triple(size), triple(low), triple(high))?;
        writeln!(f, "faces      {}", self.faces)?;
        writeln!(f, "surfaces   {}, {:.4} m²", self.surfaces, self.area)?;
        writeln!(f, "contacts   {} lines", self.contact_lines)?;
        writeln!(f, "patches    {}", self.patches)?;
        writeln!(f, "materials  {}", self.materials.len())?;
        for material in &self.materials {
            writeln!(f, "  {material}")?;
        }
        let emitters = self.materials.iter().filter(|material| material.flux > 0.0);
        writeln!(
            f,
            "emitters   {} materials, {} lights",
            emitters.clone().count(),
            self.lights.len()
        )?;
        for material in emitters {
            let MaterialFacts { name, power, flux, .. } = material;
            writeln!(f, "  {name}: {} W, {flux:.4} lm", triple(*power))?;
        }
        for light in &self.lights {
            let LightFacts { name, kind, strength, unit } = light;
            let kind = if name == kind {
                format!("{kind} light")
            } else {
                format!("{kind} light \"{name}\"")
            };
            writeln!(f, "  {kind}: {} {unit}", triple(*strength))?;
        }
        write!(f, "cameras    {}", self.cameras.len())?;
        for (number, camera) in self.cameras.iter().enumerate() {
            write!(f, "\n  {number} {camera}")?;
        }
        for note in &self.notes {
            write!(f, "\nnote: {note}")?;
        }
        Ok(())
    }
}

impl Display for MaterialFacts {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { name, area, .. } = self;
        write!(f, "{name}: {area:.4} m², reflectance {}", triple(self.reflectance))?;
        if self.emission != [0.0; 3] {
            write!(f, ", emission {} W/(m² sr)", triple(self.emission))?;
        }
        if let Some(texture) = &self.texture {
            write!(f, ", texture {texture}")?;
        }
        if let Some(texture) = &self.emission_texture {
            write!(f, ", emission texture {texture}")?;
        }
        if self.double_sided { write!(f, ", both sides") } else { Ok(()) }
    }
}
