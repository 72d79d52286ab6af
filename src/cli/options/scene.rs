//! Which scene to read, and how.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use radiosity::scene::LoadOptions;

use super::values;

/// The scene and what its file leaves open.
#[derive(Debug, Args)]
pub(crate) struct SceneOptions {
    /// The scene: .obj (with its .mtl), .gltf or .glb
    #[arg(value_name = "SCENE")]
    pub(crate) path: PathBuf,

    /// Unit of an OBJ file's coordinates: m, cm, mm, in, ft, or metres per unit
    ///
    /// glTF is in metres always. `radiosity info` prints the size in metres, which shows a wrong guess.
    #[arg(long, value_name = "UNIT", default_value = "m", value_parser = values::units)]
    #[arg(help_heading = "Reading")]
    units: f64,

    /// Whether surfaces reflect and emit from both sides
    ///
    /// `auto` does what the file says (glTF `doubleSided`; OBJ: front sides only, with black backs).
    #[arg(long, value_name = "WHEN", value_enum, default_value_t = TwoSided::Auto)]
    #[arg(help_heading = "Reading")]
    two_sided: TwoSided,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum TwoSided {
    Auto,
    On,
    Off,
}

impl SceneOptions {
    pub(crate) fn load_options(&self) -> LoadOptions {
        let two_sided = match self.two_sided {
            TwoSided::Auto => None,
            TwoSided::On => Some(true),
            TwoSided::Off => Some(false),
        };
        LoadOptions { metres_per_unit: self.units, two_sided }
    }
}
