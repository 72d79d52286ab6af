//! What a user may choose about a solution, and the presets that choose it.

/// How finely and how long to compute; every field has a default that works on a room.
///
/// ```
/// use radiosity::Settings;
/// let settings = Settings { tolerance: 0.02, ..Settings::high() };
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Largest error of interpolation across an element, as a share of the radiosity around it
    /// (0.001..=1; default 0.03). Smaller means more elements.
    pub tolerance: f64,
    /// Shortest side an element may be given by refinement, m; `None` takes a share of the scene's
    /// size that the preset fixes. Shadows finer than this blur.
    pub min_element: Option<f64>,
    /// Deepest level of the element tree under a patch (0..=16; default 7).
    pub max_level: u32,
    /// Longest side of a patch, m; `None` takes a share of the scene's size.
    /// Interreflection is carried between patches: smaller is more accurate and slower.
    pub patch_size: Option<f64>,
    /// Some(size): no refinement where the light asks for it; every element is split until its
    /// longest side is at most `size`, m.
    pub uniform: Option<f64>,
    /// Share of all emitted power that may be left unshot when the solver stops (default 0.001).
    pub stop: f64,
    /// Most shots to fire, emitters included; `None` goes on until `stop` is reached.
    pub max_shots: Option<usize>,
    /// Cells along the edge of a hemicube's top face (32..=1024, even; default 128).
    pub hemicube_resolution: u32,
}

impl Settings {
    /// Seconds, for a first look.
    pub fn draft() -> Self {
        Self { tolerance: 0.08, max_level: 4, hemicube_resolution: 64, ..Self::medium() }
    }

    /// The default: right to about one per cent of a room's mean radiosity.
    pub fn medium() -> Self {
        Self {
            tolerance: 0.03,
            min_element: None,
            max_level: 7,
            patch_size: None,
            uniform: None,
            stop: 0.001,
            max_shots: None,
            hemicube_resolution: 128,
        }
    }

    /// For final pictures.
    pub fn high() -> Self {
        Self { tolerance: 0.01, max_level: 9, hemicube_resolution: 256, ..Self::medium() }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self::medium()
    }
}
