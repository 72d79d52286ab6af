//! What a user may choose about a solution, the presets that choose it, and what is out of range.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// How finely and how long to compute; every field has a default that works on a room.
///
/// ```
/// use radiosity::Settings;
/// let settings = Settings { tolerance: 0.02, ..Settings::high() };
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Largest error of interpolation across an element, as a share of the radiosity around it
    /// (0.001..=1; default 0.02). Smaller means more elements.
    ///
    /// "Around it" is the geometric mean of the radiosity of the element and that of the whole scene. Light straight
    /// from emitters is held to 1/3 of this, reflected light to 1.5 times this (1/3 beside what hovers closely over a
    /// surface), and gathering resolves differences of 0.13 times this and of the scene's mean radiosity. Elements of
    /// 1/50 of the scene's extent are held to just that, and others by as much less as they are smaller (to 5 times
    /// this) or more as they are larger (to 1/10).
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
    /// Whether elements are cut along the lines on which direct light has a kink or a bend
    /// (default true), or only divided in halves and quarters.
    pub discontinuity_lines: bool,
    /// `None`, the default: what hides a lamp is cut out of it exactly. Some(n): by about n rays
    /// (1..=4096) to each triangle of a lamp, for comparison.
    pub shadow_rays: Option<u32>,
    /// Share of all emitted power that may be left unshot when the solver stops
    /// (1e-9..=1; default 0.001).
    pub unshot_limit: f64,
    /// Most shots to fire, emitters included; `None` goes on until `unshot_limit` is reached.
    pub max_shots: Option<usize>,
    /// Most elements: refinement ends before there are more (default `None`: it does not matter). Patches come
    /// first, however many they are.
    pub max_elements: Option<usize>,
    /// Which patch sends its reflected light on next (default [`Method::Progressive`]). All end with
    /// the same light, some sooner.
    pub method: Method,
    /// Factor on the light that a patch sends at a time (above 0, below 2; default 1): less is
    /// under-, more over-relaxation.
    pub omega: f64,
    /// Most cells along the edge of a shooter's hemicube (32..=1024, even; default 128, of drafts 64); where patches
    /// outnumber them, fewer if the tolerance admits it.
    pub hemicube_resolution: u32,
}

/// The classic relaxations: who is next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Method {
    /// All in turn, each sending what it held when the turn began: simultaneous displacement.
    Jacobi,
    /// All in turn, each sending what it holds by then: successive displacement.
    GaussSeidel,
    /// The one that lacks most, W/m².
    Southwell,
    /// The one that lacks most power, W: progressive refinement, Southwell's method scaled by area.
    #[default]
    Progressive,
}

impl Method {
    /// The name, as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Jacobi => "jacobi",
            Self::GaussSeidel => "gauss-seidel",
            Self::Southwell => "southwell",
            Self::Progressive => "progressive",
        }
    }
}

impl Settings {
    /// Seconds, for a first look.
    pub fn draft() -> Self {
        Self {
            tolerance: 0.08,
            min_element: Length::OfScene(1.0 / 300.0),
            max_level: 5,
            hemicube_resolution: 64,
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
            discontinuity_lines: true,
            shadow_rays: None,
            unshot_limit: 0.001,
            max_shots: None,
            max_elements: None,
            method: Method::Progressive,
            omega: 1.0,
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

/// Patches beyond this number would take hours, and more memory than there is.
const MOST_PATCHES: f64 = 2e5;

/// Elements of a uniform mesh beyond this number would take more memory than there is.
const MOST_UNIFORM_ELEMENTS: f64 = 1e7;

impl Settings {
    /// Longest side of a patch in a scene with a bounding box of this diagonal, m.
    pub fn patch_length(&self, extent: f64) -> f64 {
        self.patch_size.metres(extent).max(self.uniform.unwrap_or(0.0))
    }

    /// Whether every setting is in its range.
    ///
    /// # Errors
    /// [`Error::Setting`] about the first that is not.
    pub fn validate(&self) -> Result<()> {
        in_range("tolerance", self.tolerance, 0.001, 1.0)?;
        positive("min-element", self.min_element.number())?;
        in_range("max-level", f64::from(self.max_level), 0.0, 16.0)?;
        positive("patch-size", self.patch_size.number())?;
        positive("uniform", self.uniform.unwrap_or(1.0))?;
        in_range("shadow-rays", f64::from(self.shadow_rays.unwrap_or(1)), 1.0, 4096.0)?;
        in_range("stop", self.unshot_limit, 1e-9, 1.0)?;
        check_omega(self.omega)?;
        let cells = self.hemicube_resolution;
        in_range("hemicube-resolution", f64::from(cells), 32.0, 1024.0)?;
        if cells % 2 == 1 {
            return Err(setting(
                "hemicube-resolution",
                format!("{cells} is odd; use an even number"),
            ));
        }
        Ok(())
    }

    /// Whether a mesh of surfaces of this area, m², in a bounding box of this diagonal, m, will be
    /// of a bearable size.
    ///
    /// # Errors
    /// [`Error::Setting`] about the size that is too small.
    pub fn validate_for(&self, area: f64, extent: f64) -> Result<()> {
        bearable("patch-size", area, self.patch_length(extent), MOST_PATCHES)?;
        let uniform = self.uniform.unwrap_or(f64::INFINITY);
        let most = self.max_elements.map_or(f64::INFINITY, |most| most as f64);
        // With all their ancestors, elements are a third more.
        bearable("uniform", area, uniform, MOST_UNIFORM_ELEMENTS.min(0.75 * most))
    }
}

fn setting(name: &'static str, message: String) -> Error {
    Error::Setting { name, message }
}

fn in_range(name: &'static str, value: f64, low: f64, high: f64) -> Result<()> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(setting(name, format!("{value} is out of range; use {low} to {high}")))
}

/// Whether a relaxation with this factor can converge at all.
pub(crate) fn check_omega(omega: f64) -> Result<()> {
    if omega > 0.0 && omega < 2.0 {
        return Ok(());
    }
    Err(setting("omega", format!("{omega} is out of range; use more than 0 and less than 2")))
}

fn positive(name: &'static str, value: f64) -> Result<()> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(setting(name, format!("{value} is no length; use a number above 0")))
}

fn bearable(name: &'static str, area: f64, size: f64, most: f64) -> Result<()> {
    let count = area / (size * size);
    if count <= most {
        return Ok(());
    }
    let enough = (area / most).sqrt();
    let message =
        format!("{size} m would make some {count:.0e} pieces; use {enough:.2e} m or more");
    Err(setting(name, message))
}

/// A length that may depend on the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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

    fn number(self) -> f64 {
        let (Self::Metres(number) | Self::OfScene(number)) = self;
        number
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self::medium()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(settings: &Settings) -> String {
        settings.validate().map_err(|error| error.to_string()).expect_err("out of range")
    }

    #[test]
    fn presets_are_in_range() {
        for settings in [Settings::draft(), Settings::medium(), Settings::high()] {
            assert!(settings.validate().is_ok(), "{settings:?}");
            assert!(settings.validate_for(100.0, 10.0).is_ok(), "{settings:?}");
        }
    }

    #[test]
    fn what_is_out_of_range_is_named() {
        let medium = Settings::medium();
        let wrong = [
            ("tolerance", Settings { tolerance: f64::NAN, ..medium.clone() }),
            ("min-element", Settings { min_element: Length::Metres(-1.0), ..medium.clone() }),
            ("max-level", Settings { max_level: 17, ..medium.clone() }),
            (
                "patch-size",
                Settings { patch_size: Length::Metres(f64::INFINITY), ..medium.clone() },
            ),
            ("uniform", Settings { uniform: Some(0.0), ..medium.clone() }),
            ("shadow-rays", Settings { shadow_rays: Some(0), ..medium.clone() }),
            ("stop", Settings { unshot_limit: 0.0, ..medium.clone() }),
            ("omega", Settings { omega: 2.0, ..medium.clone() }),
            ("omega", Settings { omega: f64::NAN, ..medium.clone() }),
            ("hemicube-resolution", Settings { hemicube_resolution: 33, ..medium.clone() }),
        ];
        for (name, settings) in wrong {
            assert!(refused(&settings).starts_with(name), "{}", refused(&settings));
        }
    }

    #[test]
    fn sizes_that_no_memory_holds_are_refused() {
        let fine = Settings { uniform: Some(1e-4), ..Settings::medium() };
        assert!(fine.validate_for(100.0, 10.0).is_err());
        let fine = Settings { patch_size: Length::Metres(1e-3), ..Settings::medium() };
        assert!(fine.validate_for(100.0, 10.0).is_err());
    }
}
