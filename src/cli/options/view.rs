//! What a picture shows: size, camera, exposure and quantity.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use glam::DVec3;
use radiosity::reconstruct::TriMesh;
use radiosity::render::{Display, RenderOptions, View, automatic_camera, exposure_seen};
use radiosity::scene::{Camera, NamedLight};
use radiosity::tone::{Exposure, exposure_scale};
use radiosity::{Error, Result};

use super::values::{self, Size};

/// Full vertical angle of view of a camera given without one, degrees.
const DEFAULT_FOV: f64 = 45.0;

/// Size of a picture if nothing is said of it.
const SIZE: Size = Size { width: 960, height: 720 };

/// What is said where there is no picture.
const NO_PICTURE: &str = "there is no picture that it would be for; write one, too";

/// What is written beside pictures.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Elsewhere {
    /// Nothing that is exposed.
    Nothing,
    /// Colours that are exposed as a picture would be.
    Colours,
    /// Something with a picture in it.
    Picture,
}

/// The picture and what may be seen in it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Picture")]
pub(crate) struct PictureOptions {
    /// Size of the picture in pixels (default: 960x720)
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    size: Option<Size>,

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
    ///
    /// `auto` goes by the mesh and by what the camera sees of it; a GLB's colours have the brightness of the picture.
    #[arg(long, value_name = "EV", value_parser = values::exposure)]
    #[arg(allow_hyphen_values = true)]
    exposure: Option<Exposure>,

    /// What to show (default: light); all but `light` with a legend below the picture (PNG)
    ///
    /// One for all pictures, or one for each in their order: --view light,error
    #[arg(long, value_enum, value_delimiter = ',')]
    view: Vec<ViewChoice>,

    /// Evaluate direct light anew at the samples of the picture, for shadows finer than the mesh
    ///
    /// Reflected light is that of the solution; smooth pixels get one evaluation, others sixteen. Ctrl-C interpolates the rest of the picture.
    #[arg(long)]
    final_gather: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ViewChoice {
    /// The light, as the eye would see it
    Light,
    /// The light, with the mesh drawn over it
    Wireframe,
    /// Radiosity in false colours, W/m²
    Radiosity,
    /// Irradiance straight from emitters in false colours, W/m²
    Direct,
    /// Irradiance by reflected light in false colours, W/m²
    Indirect,
    /// Illuminance in false colours with lines of equal illuminance, lux (683 lm/W)
    Illuminance,
    /// How often patches were divided in a row
    Level,
    /// Why elements were divided
    Reason,
    /// Error of interpolation in the middle of elements, as a share of what is allowed
    Error,
}

impl From<ViewChoice> for View {
    fn from(shown: ViewChoice) -> Self {
        match shown {
            ViewChoice::Light => Self::Light,
            ViewChoice::Wireframe => Self::Wireframe,
            ViewChoice::Radiosity => Self::Radiosity,
            ViewChoice::Direct => Self::Direct,
            ViewChoice::Indirect => Self::Indirect,
            ViewChoice::Illuminance => Self::Illuminance,
            ViewChoice::Level => Self::Level,
            ViewChoice::Reason => Self::Reason,
            ViewChoice::Error => Self::Error,
        }
    }
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
    fn camera(&self, choice: &CameraChoice, mesh: &TriMesh) -> Camera {
        match choice {
            CameraChoice::Given(camera) => camera.clone(),
            CameraChoice::Automatic(fov) => {
                let Size { width, height } = self.size();
                let found = automatic_camera(mesh, f64::from(width) / f64::from(height));
                Camera { vertical_fov: fov.unwrap_or(found.vertical_fov), ..found }
            }
        }
    }

    /// The camera itself, and the exposure of a mesh from there: the one asked for or else `kept`, and if that is
    /// automatic, one by what is seen.
    pub(crate) fn look(
        &self,
        choice: &CameraChoice,
        mesh: &TriMesh,
        kept: Exposure,
    ) -> (Camera, Exposure) {
        let camera = self.camera(choice, mesh);
        let Size { width, height } = self.size();
        let exposure = match self.exposure.unwrap_or(kept) {
            Exposure::Automatic => {
                exposure_seen(mesh, &camera, f64::from(width) / f64::from(height))
            }
            chosen => chosen,
        };
        (camera, exposure)
    }

    /// Which view goes into which of the files.
    pub(crate) fn views<'a>(&self, files: &'a [PathBuf]) -> Result<Vec<(View, Vec<&'a PathBuf>)>> {
        let views = self.view.iter().copied().map(View::from);
        if let [] | [_] = *self.view {
            let only = self.view.first().map_or(View::Light, |&only| only.into());
            return Ok(vec![(only, files.iter().collect())]);
        }
        if self.view.len() != files.len() {
            let (views, files) = (self.view.len(), files.len());
            let message =
                format!("{views} views for {files} pictures; give one, or one for each picture");
            return Err(Error::Setting { name: "view", message });
        }
        Ok(views.zip(files).map(|(view, file)| (view, vec![file])).collect())
    }

    /// Whether a solved file alone, without its scene, holds what is asked for.
    pub(crate) fn check_for_file(&self) -> Result<()> {
        const SOLVE: &str =
            "which a solved GLB does not hold; `radiosity solve SCENE --image FILE.png`";
        let refused = |name, message| Err(Error::Setting { name, message });
        if self.final_gather {
            let message = format!("evaluates light in the scene, {SOLVE} --final-gather does it");
            return refused("final-gather", message);
        }
        if let Some(view) = self.view.iter().find(|&&view| View::from(view).needs_solution()) {
            let name = view.to_possible_value();
            let name = name.as_ref().map_or("", |value| value.get_name());
            let message = format!("{name} shows the solution, {SOLVE} --view {name} does it");
            return refused("view", message);
        }
        Ok(())
    }

    /// Refuses what would do nothing: wishes for a picture without one, an exposure where nothing is exposed.
    ///
    /// `files` are the pictures to write; other things with a picture in them, or with colours exposed for one, may be
    /// written beside them.
    pub(crate) fn check_use(&self, files: &[PathBuf], elsewhere: Elsewhere) -> Result<()> {
        let refused =
            |name, message: &str| Err(Error::Setting { name, message: message.to_owned() });
        let (drawn, exposed) = match elsewhere {
            Elsewhere::Nothing => (!files.is_empty(), false),
            Elsewhere::Colours => (!files.is_empty(), true),
            Elsewhere::Picture => (true, true),
        };
        if !drawn && self.size.is_some() {
            return refused("size", NO_PICTURE);
        }
        if !drawn && self.final_gather {
            return refused("final-gather", NO_PICTURE);
        }
        if files.is_empty() && !self.view.is_empty() {
            return refused("view", NO_PICTURE);
        }
        let from = self.camera.is_some() || self.eye.is_some() || self.fov.is_some();
        if !drawn && !exposed && (from || self.exposure.is_some()) {
            return refused(
                "camera",
                "nothing is written that would show it; ask for a picture, too",
            );
        }
        let is_linear =
            |file: &PathBuf| !file.extension().is_some_and(|end| end.eq_ignore_ascii_case("png"));
        if !exposed && self.exposure.is_some() && files.iter().all(is_linear) {
            return refused(
                "exposure",
                "a .hdr or .exr has light as it is; only a .png is exposed",
            );
        }
        let shows_direct = |&view: &ViewChoice| {
            !matches!(
                view,
                ViewChoice::Indirect | ViewChoice::Level | ViewChoice::Reason | ViewChoice::Error
            )
        };
        let is_gathered = self.view.is_empty() || self.view.iter().any(shows_direct);
        if self.final_gather && !is_gathered && !matches!(elsewhere, Elsewhere::Picture) {
            return refused("final-gather", "none of the views shows direct light");
        }
        Ok(())
    }

    fn size(&self) -> Size {
        self.size.unwrap_or(SIZE)
    }

    /// Pixels of a picture.
    pub(crate) fn pixels(&self) -> u64 {
        let Size { width, height } = self.size();
        u64::from(width) * u64::from(height)
    }

    /// How to draw one view, the skies and suns among some lights behind it.
    pub(crate) fn drawing(&self, view: View, sky: &[NamedLight]) -> RenderOptions {
        let (Size { width, height }, final_gather) = (self.size(), self.final_gather);
        let sky = sky.to_vec();
        RenderOptions { view, width, height, final_gather, sky, ..RenderOptions::default() }
    }
}

/// How pictures of a mesh are to be shown.
pub(crate) fn display(mesh: &TriMesh, exposure: Exposure) -> Display {
    Display::exposed(exposure_scale(mesh, exposure))
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
