//! What a picture should hold.

use super::view::View;
use crate::colour::Rgb;
use crate::scene::NamedLight;

/// What a picture should hold.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// What to show, default the light.
    pub view: View,
    /// Pixels a row, default 800.
    pub width: u32,
    /// Rows, default 600.
    pub height: u32,
    /// Rays a pixel along each axis, at least 1, default 4. From 3 on, pixels that look smooth, with
    /// those beside them, after the first few rays, one a row and column of the grid, get no more.
    pub samples: u32,
    /// Whether to evaluate direct light anew at every sample, or at one in smooth pixels, instead of
    /// interpolating it, which needs a [`Solved`](super::Solved); default no.
    pub final_gather: bool,
    /// Radiance where there is no mesh, W/(m² sr), default 0; not in views of other quantities.
    pub background: Rgb,
    /// Skies and suns seen where there is no mesh, over the background, default none; as that, in views of radiance
    /// other than that of radiosity.
    pub sky: Vec<NamedLight>,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            view: View::Light,
            width: 800,
            height: 600,
            samples: 4,
            final_gather: false,
            background: Rgb::ZERO,
            sky: Vec::new(),
        }
    }
}
