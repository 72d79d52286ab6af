//! What to compare.

use std::path::PathBuf;

use super::estimate::Effort;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::settings::Settings;
use crate::surface::Surfaces;

/// Fewest elements of the coarsest uniform mesh whose size is not given, unless an adaptive one has fewer.
const COARSEST: usize = 200;

/// Elements of the finest uniform mesh whose size is not given, over those of the finest adaptive one.
const FINEST: usize = 4;

/// Fewest and most uniform meshes whose sizes are not given.
const COUNT: [usize; 2] = [3, 6];

/// Most elements of a uniform mesh whose size is not given.
const BEARABLE: usize = 1_000_000;

/// Where the truth is from.
#[derive(Clone, Debug, PartialEq)]
pub enum ReferenceSource {
    /// Found by paths.
    Traced(Effort),
    /// A file, see [`Reference::load`](super::Reference::load).
    File(PathBuf),
}

/// What to compare, and by what.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparisonPlan {
    /// All but the tolerance of adaptive and the size of uniform meshes.
    ///
    /// Uniform meshes gather reflected light to the finest tolerance.
    pub settings: Settings,
    /// Sizes of uniform elements, m; `None` chooses some that fit the adaptive meshes.
    pub uniform: Option<Vec<f64>>,
    /// Tolerances of adaptive meshes.
    pub adaptive: Vec<f64>,
    /// The truth.
    pub reference: ReferenceSource,
    /// The error at which costs are compared, as a share of the mean; `None`: the smallest that both reach.
    pub error: Option<f64>,
    /// Paths from each place of the profile across a shadow edge; 0 for none.
    pub profile_paths: usize,
}

impl Default for ComparisonPlan {
    fn default() -> Self {
        Self {
            settings: Settings::medium(),
            uniform: None,
            adaptive: vec![0.2, 0.1, 0.05, 0.02],
            reference: ReferenceSource::Traced(Effort::default()),
            error: None,
            profile_paths: 4096,
        }
    }
}

impl ComparisonPlan {
    /// Settings of an adaptive mesh.
    pub fn adaptive_settings(&self, tolerance: f64) -> Settings {
        Settings { tolerance, uniform: None, ..self.settings.clone() }
    }

    /// Settings of a uniform mesh with elements at most so long, m.
    pub fn uniform_settings(&self, size: f64) -> Settings {
        let finest = self.adaptive.iter().copied().min_by(f64::total_cmp);
        let tolerance = finest.unwrap_or(self.settings.tolerance);
        Settings { tolerance, uniform: Some(size), ..self.settings.clone() }
    }

    /// The sizes of uniform meshes, from coarse to fine, beside adaptive ones of so many elements: the fewest
    /// and the most. No finer ones are tried once it `is_over`.
    pub fn sizes(
        &self,
        surfaces: &Surfaces,
        [fewest, most]: [usize; 2],
        is_over: &mut dyn FnMut() -> bool,
    ) -> Vec<f64> {
        if let Some(sizes) = &self.uniform {
            return sizes.clone();
        }
        let count = |size: f64| {
            let mesh = Mesh::new(surfaces, &self.uniform_settings(size));
            let reflects = |&leaf: &_| surfaces[mesh.surface_of(leaf)].reflects();
            mesh.leaves().filter(reflects).count()
        };
        let (coarsest, goal) = (COARSEST.min(fewest), (FINEST * most).min(BEARABLE));
        // Elements are divided in quarters: halving the size is the least that makes a difference.
        let mut size = surfaces.extent / 4.0;
        let mut sizes = Vec::new();
        loop {
            let elements = count(size);
            if elements >= coarsest {
                sizes.push(size);
            }
            // The next would have about four times as many: nearer to the goal, by ratio, if below half of it.
            let is_fine = 2 * elements > goal && sizes.len() >= COUNT[0];
            if is_fine || size < 1e-6 * surfaces.extent || is_over() {
                break;
            }
            size /= 2.0;
        }
        sizes.split_off(sizes.len().saturating_sub(COUNT[1]))
    }
}

impl ComparisonPlan {
    /// Whether every setting is in its range.
    ///
    /// # Errors
    /// [`Error::Setting`] about the first that is not.
    pub fn validate(&self) -> Result<()> {
        let setting = |name, message: &str| Error::Setting { name, message: message.to_owned() };
        if self.adaptive.is_empty() {
            return Err(setting("adaptive", "there must be one tolerance at least"));
        }
        if self.uniform.as_ref().is_some_and(Vec::is_empty) {
            return Err(setting("uniform", "there must be one size at least"));
        }
        if !self.error.is_none_or(|error| error > 0.0 && error.is_finite()) {
            return Err(setting("error", "the error to compare at must be above zero"));
        }
        if let ReferenceSource::Traced(Effort { noise, area_points, .. }) = self.reference
            && !(noise.is_none_or(|noise| noise > 0.0) && area_points > 0)
        {
            return Err(setting("noise", "noise and number of places must be above zero"));
        }
        self.all_settings().try_for_each(|settings| settings.validate())
    }

    /// Whether all meshes of surfaces will be of a bearable size.
    ///
    /// # Errors
    /// [`Error::Setting`] about the size that is too small.
    pub fn validate_for(&self, surfaces: &Surfaces) -> Result<()> {
        let (area, extent) = (surfaces.area(), surfaces.extent);
        self.all_settings().try_for_each(|settings| settings.validate_for(area, extent))
    }

    fn all_settings(&self) -> impl Iterator<Item = Settings> + '_ {
        let adaptive = self.adaptive.iter().map(|&tolerance| self.adaptive_settings(tolerance));
        let uniform = self.uniform.iter().flatten().map(|&size| self.uniform_settings(size));
        adaptive.chain(uniform)
    }
}
