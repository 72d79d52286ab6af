//! Which scene to read, and how.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use radiosity::scene::{EmissionUnit, LoadOptions, Sides, Up, settle_sides};
use radiosity::{Error, Result, Scene, load};

use super::lights::{HINT, LightOptions};
use super::values;

/// The scene and what its file leaves open.
#[derive(Debug, Args)]
pub(crate) struct SceneOptions {
    /// The scene: .obj (with its .mtl), .gltf, .glb, .stl or .ply
    #[arg(value_name = "SCENE")]
    pub(crate) path: PathBuf,

    /// Unit of the file's coordinates: m, cm, mm, in, ft, or metres per unit
    ///
    /// glTF is in metres by definition; not all exporters know. `radiosity info` prints the size in metres, which shows a wrong guess.
    #[arg(long, value_name = "UNIT", default_value = "m", value_parser = values::units)]
    #[arg(help_heading = "Reading")]
    units: f64,

    /// Which axis of the file points up
    ///
    /// With `z`, x,y,z of the file become x,z,-y when it is read: its +Y is -Z then, which is north for --sun. Lamps,
    /// cameras and grids are given in the coordinates after that, with Y up. glTF has Y up by definition.
    #[arg(long, value_name = "AXIS", value_enum, default_value_t = UpAxis::Y, help_heading = "Reading")]
    up: UpAxis,

    /// What the file's emission is: radiance in W/(m² sr), or cd/m² (nits), which are divided by 683
    ///
    /// Of `Ke` and of glTF emission. The text of glTF says cd/m², Blender writes W/(m² sr).
    #[arg(long, value_name = "UNIT", value_enum, default_value_t = Emission::Radiance)]
    #[arg(help_heading = "Reading")]
    emission: Emission,

    /// Which sides of surfaces reflect and emit
    ///
    /// The file says so (glTF `doubleSided`; OBJ: front sides only, with black backs), unless lamps, or
    /// daylight in rooms, would shine on backs only: then `auto` turns faces over, or lights both sides, and says so.
    #[arg(long, value_name = "WHEN", value_enum, default_value_t = TwoSided::Auto)]
    #[arg(help_heading = "Reading")]
    two_sided: TwoSided,

    #[command(flatten)]
    lights: LightOptions,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum UpAxis {
    /// As in glTF, and what most exporters make of OBJ
    Y,
    /// As in Blender, and in most programs for buildings
    Z,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Emission {
    /// W/(m² sr)
    Radiance,
    /// cd/m²
    Nits,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum TwoSided {
    /// What the file says, unless it would leave rooms black
    Auto,
    /// Both sides of all surfaces
    On,
    /// What the file says
    Off,
    /// What the file says, every surface turned over
    Flip,
}

impl SceneOptions {
    /// Bytes of the file; of one that cannot be found, none.
    pub(crate) fn bytes(&self) -> u64 {
        std::fs::metadata(&self.path).map_or(0, |about| about.len())
    }

    /// The files that are named to be read; what these name is known once they are.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        [self.path.clone()].into_iter().chain(self.lights.files()).collect()
    }

    /// The scene, with what is added to it. Its notes are told, above all where something could not be added.
    pub(crate) fn load(&self, tell: impl Fn(&str)) -> Result<Scene> {
        let (scene, added) = self.read()?;
        scene.notes.iter().for_each(|note| tell(&format!("note: {note}")));
        added.map(|()| scene)
    }

    /// The scene, and whether all could be added to it.
    pub(crate) fn read(&self) -> Result<(Scene, Result<()>)> {
        let options = self.load_options();
        let mut scene = load(&self.path, &options)?;
        let was_dark = !scene.is_lit();
        if let Err(error) = self.lights.apply(&mut scene) {
            return Ok((scene, Err(error)));
        }
        // Only light tells whether a room was modelled inside out; lamps that are added face as they are told.
        if was_dark && options.two_sided == Sides::Auto && !self.lights.adds_faces() {
            settle_sides(&mut scene, Sides::Auto);
        }
        scene.note_backdrop();
        Ok((scene, Ok(())))
    }

    /// The same, if there is light in it.
    pub(crate) fn load_lit(&self, tell: impl Fn(&str)) -> Result<Scene> {
        let scene = self.load(tell)?;
        if scene.is_lit() {
            return Ok(scene);
        }
        let path = self.path.display();
        Err(Error::Scene(format!(
            "{path}: nothing in the scene emits light; {HINT}; `radiosity info` lists materials"
        )))
    }

    fn load_options(&self) -> LoadOptions {
        let two_sided = match self.two_sided {
            TwoSided::Auto => Sides::Auto,
            TwoSided::On => Sides::Both,
            TwoSided::Off => Sides::AsWritten,
            TwoSided::Flip => Sides::Flipped,
        };
        let up = match self.up {
            UpAxis::Y => Up::Y,
            UpAxis::Z => Up::Z,
        };
        let emission = match self.emission {
            Emission::Radiance => EmissionUnit::Radiance,
            Emission::Nits => EmissionUnit::Nits,
        };
        LoadOptions { metres_per_unit: self.units, up, emission, two_sided }
    }
}
