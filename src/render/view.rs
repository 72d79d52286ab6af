//! What pictures can show.

use std::f64::consts::PI;

use crate::colour::{LUMENS_PER_WATT, Rgb, luminance};

/// What a picture shows, each but the first with a legend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum View {
    /// The light as the eye would see it.
    #[default]
    Light,
    /// The same with the mesh drawn over it.
    Wireframe,
    /// Radiosity, W/m², weighted by luminance over the channels.
    Radiosity,
    /// Irradiance straight from emitters, W/m², weighted likewise.
    Direct,
    /// Irradiance by reflected light, W/m², weighted likewise.
    Indirect,
    /// Illuminance by both, lm/m² (lux) at 683 lm/W, with lines of equal illuminance.
    Illuminance,
    /// How often patches were divided in a row.
    Level,
    /// Why elements were divided.
    Reason,
    /// The error of interpolation in the middle of leaves, as a share of what they are allowed.
    Error,
}

impl View {
    /// All views.
    pub const ALL: [Self; 9] = [
        Self::Light,
        Self::Wireframe,
        Self::Radiosity,
        Self::Direct,
        Self::Indirect,
        Self::Illuminance,
        Self::Level,
        Self::Reason,
        Self::Error,
    ];

    /// True if a mesh read from a file does not carry what it shows: only a solution does.
    pub fn needs_solution(self) -> bool {
        !matches!(self, Self::Light | Self::Wireframe | Self::Radiosity)
    }

    /// True if values are radiances, W/(m² sr).
    pub(super) fn shows_radiance(self) -> bool {
        matches!(self, Self::Light | Self::Wireframe | Self::Radiosity)
    }

    /// True if values are radiances to be seen as they are.
    pub(super) fn shows_light(self) -> bool {
        matches!(self, Self::Light | Self::Wireframe)
    }

    /// True if values are the colours to be seen, linear.
    pub(super) fn shows_colours(self) -> bool {
        matches!(self, Self::Level | Self::Reason)
    }

    /// True if the edges of the mesh belong in the picture.
    pub(super) fn shows_lines(self) -> bool {
        matches!(self, Self::Wireframe | Self::Level | Self::Reason)
    }

    /// Name and unit of what is shown, as the legend says them.
    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Wireframe => "mesh",
            Self::Radiosity => "radiosity, W/m²",
            Self::Direct => "direct irradiance, W/m²",
            Self::Indirect => "indirect irradiance, W/m²",
            Self::Illuminance => "illuminance, lx",
            Self::Level => "level of leaves",
            Self::Reason => "why leaves were made",
            Self::Error => "interpolation error / allowed error",
        }
    }

    /// The number, in the unit of the label, that a value stands for.
    pub(super) fn number(self, value: Rgb) -> f64 {
        let weighted = luminance(value).max(0.0);
        match self {
            Self::Light | Self::Wireframe | Self::Radiosity => weighted * PI,
            Self::Illuminance => weighted * LUMENS_PER_WATT,
            _ => weighted,
        }
    }
}
