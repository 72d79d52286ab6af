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
    /// (0.001..=1; default 0.02). Smaller means more elements.
    pub tolerance: f64,
    /// Shortest side that refinement may give an element (default 1/800 of the scene).
    /// Shadows finer than this blur.
    pub min_element: Length,
    /// Deepest level of the element tree under a patch (0..=16; default 7).
    pub max_level: u32,
    /// Longest side of a patch (default 1/14 of the scene).
    /// Interreflection is carried between patches: smaller is more accurate and slower.
    pub patch_size: Length,
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
        Self {
            tolerance: 0.08,
            min_element: Length::OfScene(1.0 / 300.0),
            max_level: 5,
            ..Self::medium()
        }
    }

    /// The default: right to about one per cent of a room's mean radiosity.
    pub fn medium() -> Self {
        Self {
            tolerance: 0.02,
            min_element: Length::OfScene(1.0 / 800.0),
            max_level: 7,
            patch_size: Length::OfScene(1.0 / 14.0),
            uniform: None,
            stop: 0.001,
            max_shots: None,
            hemicube_resolution: 128,
        }
    }

    /// For final pictures.
    pub fn high() -> Self {
        Self {
            tolerance: 0.01,
            min_element: Length::OfScene(1.0 / 2000.0),
            max_level: 9,
            ..Self::medium()
        }
    }
}

impl Settings {
    /// Longest side of a patch in a scene with a bounding box of this diagonal, m.
    pub fn patch_length(&self, extent: f64) -> f64 {
        self.patch_size.metres(extent).max(self.uniform.unwrap_or(0.0))
    }
}

/// A length that may depend on the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// This many metres.
    Metres(f64),
    /// This share of the diagonal of the scene's bounding box.
    OfScene(f64),
}

impl Length {
    /// The length in a scene with a bounding box of this diagonal, m.
    pub fn metres(self, extent: f64) -> f64 {
        match self {
            Self::Metres(metres) => metres,
            Self::OfScene(share) => share * extent,
        }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self::medium()
    }
}
