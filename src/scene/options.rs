//! How to read a file that leaves something open: its unit, its axes, what its emission means.

use super::orientation::Sides;
use super::up::Up;

/// How to read a file that leaves something open.
#[derive(Clone, Debug)]
pub struct LoadOptions {
    /// Metres per unit of the file's coordinates, default 1.
    pub metres_per_unit: f64,
    /// Which axis of the file is up, default Y.
    pub up: Up,
    /// What the numbers of emission are, default radiance.
    pub emission: EmissionUnit,
    /// Which sides of faces reflect and emit.
    pub two_sided: Sides,
}

/// The unit in which a file gives what its materials emit, be it `Ke` or glTF emission.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EmissionUnit {
    /// Radiance, W/(m² sr), as most exporters write.
    #[default]
    Radiance,
    /// Luminance, cd/m², as the text of glTF wants; 683 lm/W.
    Nits,
}

impl Default for LoadOptions {
    fn default() -> Self {
        let emission = EmissionUnit::Radiance;
        Self { metres_per_unit: 1.0, up: Up::Y, emission, two_sided: Sides::Auto }
    }
}
