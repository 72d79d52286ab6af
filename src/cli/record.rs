//! What a solved GLB remembers of how it was made, so that its pictures can be made again.

use std::fmt::{self, Display, Formatter};

use glam::DVec3;
use radiosity::scene::{Camera, Light, NamedLight, Sky};
use radiosity::{Length, Scene, Settings};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The settings of a solution in metres.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SettingsRecord {
    tolerance: f64,
    min_element: f64,
    max_level: u32,
    patch_size: f64,
    uniform: Option<f64>,
    discontinuity_lines: bool,
    shadow_rays: Option<u32>,
    stop: f64,
    max_shots: Option<usize>,
    solver: &'static str,
    omega: f64,
    hemicube_resolution: u32,
}

impl SettingsRecord {
    /// The settings as they are for a scene with a bounding box of this diagonal, m.
    pub(crate) fn new(settings: &Settings, extent: f64) -> Self {
        let metres = |length: Length| length.metres(extent);
        Self {
            tolerance: settings.tolerance,
            min_element: metres(settings.min_element),
            max_level: settings.max_level,
            patch_size: metres(settings.patch_size),
            uniform: settings.uniform,
            discontinuity_lines: settings.discontinuity_lines,
            shadow_rays: settings.shadow_rays,
            stop: settings.unshot_limit,
            max_shots: settings.max_shots,
            solver: settings.method.name(),
            omega: settings.omega,
            hemicube_resolution: settings.hemicube_resolution,
        }
    }
}

impl Display for SettingsRecord {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { tolerance, min_element, max_level, patch_size, .. } = self;
        write!(f, "tolerance {tolerance}, ")?;
        match self.uniform {
            Some(size) => write!(f, "uniform {size} m, ")?,
            None => write!(f, "elements from {min_element:.4} m, level {max_level}, ")?,
        }
        if !self.discontinuity_lines {
            write!(f, "no discontinuity lines, ")?;
        }
        if let Some(rays) = self.shadow_rays {
            write!(f, "{rays} rays to a lamp's triangle, ")?;
        }
        write!(f, "patches up to {patch_size:.4} m, hemicubes of {}, ", self.hemicube_resolution)?;
        write!(f, "{}, omega {}", self.solver, self.omega)
    }
}

/// A camera of the scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct CameraRecord {
    name: String,
    eye: [f64; 3],
    target: [f64; 3],
    up: [f64; 3],
    vertical_fov_degrees: f64,
}

impl From<&Camera> for CameraRecord {
    fn from(camera: &Camera) -> Self {
        Self {
            name: camera.name.clone(),
            eye: camera.eye.to_array(),
            target: camera.target.to_array(),
            up: camera.up.to_array(),
            vertical_fov_degrees: camera.vertical_fov.to_degrees(),
        }
    }
}

impl Display for CameraRecord {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let name = if self.name.is_empty() { "unnamed" } else { &self.name };
        let (eye, target) = (triple(self.eye), triple(self.target));
        write!(f, "{name}: eye {eye}, target {target}, {:.1} degrees", self.vertical_fov_degrees)
    }
}

impl CameraRecord {
    fn camera(self) -> Option<Camera> {
        let [eye, target, up] = [self.eye, self.target, self.up].map(DVec3::from);
        let is_view = [eye, target, up].iter().all(|v| v.is_finite()) && eye != target;
        (is_view && (1e-3..180.0).contains(&self.vertical_fov_degrees)).then(|| Camera {
            name: self.name,
            eye,
            target,
            up,
            vertical_fov: self.vertical_fov_degrees.to_radians(),
        })
    }
}

/// What is seen where there is no mesh; irradiances in W/m².
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
enum SkyRecord {
    Uniform { irradiance: [f64; 3] },
    CieOvercast { irradiance: [f64; 3] },
    Sun { direction: [f64; 3], irradiance: [f64; 3] },
}

impl SkyRecord {
    fn new(light: &Light) -> Option<Self> {
        Some(match *light {
            Light::Sky { sky: Sky::Uniform, irradiance } => {
                Self::Uniform { irradiance: irradiance.to_array() }
            }
            Light::Sky { sky: Sky::Overcast, irradiance } => {
                Self::CieOvercast { irradiance: irradiance.to_array() }
            }
            Light::Sun { direction, irradiance } => {
                Self::Sun { direction: direction.to_array(), irradiance: irradiance.to_array() }
            }
            _ => return None,
        })
    }

    fn light(self) -> Option<Light> {
        let light = match self {
            Self::Uniform { irradiance } => {
                Light::Sky { sky: Sky::Uniform, irradiance: irradiance.into() }
            }
            Self::CieOvercast { irradiance } => {
                Light::Sky { sky: Sky::Overcast, irradiance: irradiance.into() }
            }
            Self::Sun { direction, irradiance } => Light::Sun {
                direction: DVec3::from(direction).try_normalize()?,
                irradiance: irradiance.into(),
            },
        };
        let seen = light.radiance(DVec3::Y);
        (seen.is_finite() && seen.min_element() >= 0.0).then_some(light)
    }
}

/// The same with its name.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct NamedSky {
    name: String,
    #[serde(flatten)]
    sky: SkyRecord,
}

/// The skies and suns that a stamp's settings hold.
pub(crate) fn lights(settings: &Value) -> Vec<NamedLight> {
    let light = |NamedSky { name, sky }| Some(NamedLight { name, light: sky.light()? });
    kept(settings, "sky").into_iter().filter_map(light).collect()
}

/// Puts the skies and suns among some lights into a stamp's settings.
pub(crate) fn keep_lights(settings: &mut Value, lights: &[NamedLight]) {
    let record = |NamedLight { name, light }: &NamedLight| {
        Some(NamedSky { name: name.clone(), sky: SkyRecord::new(light)? })
    };
    keep(settings, "sky", &lights.iter().filter_map(record).collect::<Vec<_>>());
}

/// A list in a stamp's settings; empty if there is none that can be read.
fn kept<T: DeserializeOwned>(settings: &Value, name: &str) -> Vec<T> {
    let list = settings.get(name).cloned().unwrap_or_default();
    serde_json::from_value(list).unwrap_or_default()
}

fn keep(settings: &mut Value, name: &str, list: &impl Serialize) {
    if let (Some(fields), Ok(list)) = (settings.as_object_mut(), serde_json::to_value(list)) {
        fields.insert(name.to_owned(), list);
    }
}

/// What goes into the settings of a GLB's stamp.
pub(crate) fn stamped(settings: &SettingsRecord, scene: &Scene) -> Value {
    let cameras: Vec<CameraRecord> = scene.cameras.iter().map(CameraRecord::from).collect();
    let mut record = serde_json::to_value(settings).unwrap_or_default();
    keep(&mut record, "cameras", &cameras);
    keep_lights(&mut record, &scene.lights);
    record
}

/// The cameras that a stamp's settings hold; none if they were written by something else.
pub(crate) fn cameras(settings: &Value) -> Vec<Camera> {
    kept(settings, "cameras").into_iter().filter_map(CameraRecord::camera).collect()
}

/// Three numbers, to four digits behind the point at most.
pub(crate) fn triple(numbers: [f64; 3]) -> String {
    let rounded = numbers.map(|x| ((x * 1e4).round() / 1e4 + 0.0).to_string());
    format!("({})", rounded.join(", "))
}
