//! What a picture shows: size, camera, exposure and overlays.

use clap::{Args, ValueEnum};
use glam::DVec3;
use radiosity::reconstruct::TriMesh;
use radiosity::render::{
    Display, FalseColour, Picture, Quantity, RenderOptions, automatic_camera, render,
};
use radiosity::scene::Camera;
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Error, Result};

use super::values::{self, Size};

/// Full vertical angle of view of a camera given without one, degrees.
const DEFAULT_FOV: f64 = 45.0;

/// The picture and what may be seen in it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Picture")]
pub(crate) struct PictureOptions {
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "960x720", value_parser = values::size)]
    size: Size,

    /// A camera of the file, by name or number from 0; `auto` looks for a view that shows the room
    ///
    /// Default: the file's first camera, or `auto` if it has none.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["eye", "target"])]
    camera: Option<String>,

    /// Where the eye is: x,y,z in metres, Y up
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, requires = "target")]
    #[arg(conflicts_with = "camera", allow_hyphen_values = true)]
    eye: Option<DVec3>,

    /// What the eye looks at: x,y,z in metres
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, requires = "eye")]
    #[arg(conflicts_with = "camera", allow_hyphen_values = true)]
    target: Option<DVec3>,

    /// Vertical angle of view in degrees (1 to 170; default: the camera's, or 45 with --eye)
    #[arg(long, value_name = "DEGREES", value_parser = values::angle)]
    fov: Option<f64>,

    /// Brightness: auto, or an exposure value (EV at ISO 100); one more halves it
    #[arg(long, value_name = "EV", value_parser = values::exposure)]
    #[arg(allow_hyphen_values = true)]
    pub(crate) exposure: Option<Exposure>,

    /// Draw the mesh over the light (PNG only)
    #[arg(long)]
    wireframe: bool,

    /// Show radiosity as colours with a legend, in W/m² or lux (PNG only)
    #[arg(long, alias = "false-color", value_name = "UNIT", value_enum, ignore_case = true)]
    #[arg(num_args = 0..=1, default_missing_value = "W")]
    false_colour: Option<LightUnit>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum LightUnit {
    /// Radiosity, W/m²
    #[value(name = "W")]
    Watts,
    /// Luminous exitance, lux
    Lux,
}

/// Which camera was asked for.
#[derive(Clone, Debug)]
pub(crate) enum CameraChoice {
    Given(Camera),
    /// To be found for the mesh, with this angle of view in radians if there is one.
    Automatic(Option<f64>),
}

impl PictureOptions {
    /// The camera that was asked for, out of those of a file.
    pub(crate) fn choose_camera(&self, cameras: &[Camera]) -> Result<CameraChoice> {
        let fov = self.fov.map(f64::to_radians);
        let camera = match (self.eye, self.target, self.camera.as_deref()) {
            (Some(eye), Some(target), _) => Some(looking(eye, target)?),
            (_, _, Some("auto")) => None,
            (_, _, Some(wanted)) => Some(named(cameras, wanted)?.clone()),
            _ => cameras.first().cloned(),
        };
        let vertical_fov = |camera: &Camera| fov.unwrap_or(camera.vertical_fov);
        Ok(match camera {
            Some(c) => CameraChoice::Given(Camera { vertical_fov: vertical_fov(&c), ..c }),
            None => CameraChoice::Automatic(fov),
        })
    }

    /// The camera itself.
    pub(crate) fn camera(&self, choice: &CameraChoice, mesh: &TriMesh) -> Camera {
        match choice {
            CameraChoice::Given(camera) => camera.clone(),
            CameraChoice::Automatic(fov) => {
                let Size { width, height } = self.size;
                let found = automatic_camera(mesh, f64::from(width) / f64::from(height));
                Camera { vertical_fov: fov.unwrap_or(found.vertical_fov), ..found }
            }
        }
    }

    /// The picture of a mesh.
    pub(crate) fn picture(&self, mesh: &TriMesh, camera: &Camera) -> Picture {
        let Size { width, height } = self.size;
        let wireframe = self.wireframe;
        let options = RenderOptions { width, height, wireframe, ..RenderOptions::default() };
        render(mesh, camera, &options)
    }

    /// How the picture of a mesh is to be shown.
    pub(crate) fn display(&self, mesh: &TriMesh, exposure: Exposure) -> Display {
        let quantity = match self.false_colour {
            None => return Display::Exposed { scale: exposure_scale(mesh, exposure) },
            Some(LightUnit::Watts) => Quantity::Radiosity,
            Some(LightUnit::Lux) => Quantity::LuminousExitance,
        };
        Display::FalseColour(FalseColour { quantity, range: None })
    }
}

fn looking(eye: DVec3, target: DVec3) -> Result<Camera> {
    let view = target - eye;
    if view.try_normalize().is_none() {
        let message = "the eye and its target are the same point".to_owned();
        return Err(Error::Setting { name: "eye", message });
    }
    let steep = view.cross(DVec3::Y).length() < 1e-6 * view.length();
    let up = if steep { DVec3::NEG_Z } else { DVec3::Y };
    let vertical_fov = DEFAULT_FOV.to_radians();
    Ok(Camera { name: String::new(), eye, target, up, vertical_fov })
}

/// The camera of this name, or else of this number.
fn named<'a>(cameras: &'a [Camera], wanted: &str) -> Result<&'a Camera> {
    let by_name = cameras.iter().find(|camera| camera.name == wanted);
    let by_number = || cameras.get(wanted.parse::<usize>().ok()?);
    by_name.or_else(by_number).ok_or_else(|| {
        let names: Vec<String> = cameras
            .iter()
            .enumerate()
            .map(|(number, camera)| format!("{number} ({})", camera.name))
            .collect();
        let known = match names.is_empty() {
            true => "the file has none; use --eye and --target".to_owned(),
            false => format!("the file has {}", names.join(", ")),
        };
        Error::Setting { name: "camera", message: format!("no camera \"{wanted}\"; {known}") }
    })
}
