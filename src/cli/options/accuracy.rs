//! How finely and how long to compute.

use clap::{Args, ValueEnum};
use radiosity::settings::Method;
use radiosity::{Length, Settings};

use super::values;

/// The knobs of a solution; what is not given comes from the quality.
#[derive(Debug, Args)]
#[command(next_help_heading = "Accuracy")]
pub(crate) struct AccuracyOptions {
    /// Error allowed across an element, as a share of the radiosity around it: 0.02 or 2%
    ///
    /// Smaller gives more elements, and more time (0.001 to 1). Light straight from emitters is held to 1/3 of it,
    /// reflected light to 1.5 times it; larger elements more strictly and smaller ones less.
    #[arg(long, value_name = "SHARE", value_parser = values::share)]
    tolerance: Option<f64>,

    /// No adaptive refinement: every element at most this long, in metres
    ///
    /// For comparison with the adaptive mesh; the number of elements grows with its inverse square.
    #[arg(long, value_name = "METRES", value_parser = values::number)]
    #[arg(conflicts_with_all = ["max_level", "no_discontinuity_lines"])]
    uniform: Option<f64>,

    /// Stop after this many shots, and estimate the rest as ambient light
    #[arg(long, value_name = "N")]
    max_shots: Option<usize>,

    #[command(flatten)]
    method: MethodOptions,
}

/// The knobs that solutions which are compared have in common.
#[derive(Debug, Args)]
#[command(next_help_heading = "Accuracy")]
pub(crate) struct MethodOptions {
    /// Sets tolerance, smallest element and deepest level together
    ///
    /// draft: 8 %, 1/300 of the scene, level 5. medium: 2 %, 1/800, level 7. high: 1 %, 1/2000, level 9.
    /// Each may be overridden on its own.
    #[arg(long, value_enum, default_value_t = Quality::Medium)]
    quality: Quality,

    /// Shortest side of an element, in metres; shadows finer than this blur
    #[arg(long, value_name = "METRES", value_parser = values::number)]
    min_element: Option<f64>,

    /// How often a patch may be divided in a row (0 to 16)
    #[arg(long, value_name = "N")]
    max_level: Option<u32>,

    /// Divide elements in halves and quarters only, not along the borders of penumbrae
    ///
    /// For comparison.
    #[arg(long)]
    no_discontinuity_lines: bool,

    /// See lamps by about so many rays to each of their triangles, not exactly (1 to 4096)
    ///
    /// For comparison: exact light has no noise.
    #[arg(long, value_name = "N")]
    shadow_rays: Option<u32>,

    /// Longest side of a patch, in metres (default: 1/14 of the scene)
    ///
    /// Reflected light is carried between patches: smaller is more accurate and slower.
    #[arg(long, value_name = "METRES", value_parser = values::number)]
    patch_size: Option<f64>,

    /// Stop when this share of the emitted power is left unshot: 0.001 or 0.1% (the default)
    #[arg(long, value_name = "SHARE", value_parser = values::share)]
    stop: Option<f64>,

    /// Which patch sends its reflected light on next
    ///
    /// All end with the same light; progressive and southwell leave little unshot soonest.
    #[arg(long, value_enum, default_value_t = Solver::Progressive)]
    solver: Solver,

    /// Factor on the light that a patch sends at a time; above 1 over-relaxes (0 to 2; default: 1)
    ///
    /// 1.2 saves a third of the shots in bright rooms. jacobi may grow without end above 1.
    #[arg(long, value_name = "FACTOR", value_parser = values::number)]
    omega: Option<f64>,

    /// Most cells along a hemicube's edge: even, 32 to 1024 (default: 128, of drafts 64)
    ///
    /// More sees smaller things between patches; time grows with its square. Where patches outnumber cells, there
    /// are fewer if the tolerance admits it.
    #[arg(long, value_name = "CELLS")]
    hemicube_resolution: Option<u32>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Quality {
    /// Seconds, for a first look
    Draft,
    /// Right to about one per cent
    Medium,
    /// For final pictures
    High,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Solver {
    /// All in turn, each what it held when the turn began
    Jacobi,
    /// All in turn, each what it holds by then
    GaussSeidel,
    /// The one with the most unshot radiosity, W/m²
    Southwell,
    /// The one with the most unshot power, W
    Progressive,
}

impl From<Solver> for Method {
    fn from(solver: Solver) -> Self {
        match solver {
            Solver::Jacobi => Self::Jacobi,
            Solver::GaussSeidel => Self::GaussSeidel,
            Solver::Southwell => Self::Southwell,
            Solver::Progressive => Self::Progressive,
        }
    }
}

impl AccuracyOptions {
    pub(crate) fn settings(&self) -> Settings {
        let method = self.method.settings();
        Settings {
            tolerance: self.tolerance.unwrap_or(method.tolerance),
            uniform: self.uniform,
            max_shots: self.max_shots,
            ..method
        }
    }
}

impl MethodOptions {
    pub(crate) fn settings(&self) -> Settings {
        let preset = match self.quality {
            Quality::Draft => Settings::draft(),
            Quality::Medium => Settings::medium(),
            Quality::High => Settings::high(),
        };
        let or_preset = |metres: Option<f64>, preset| metres.map_or(preset, Length::Metres);
        Settings {
            min_element: or_preset(self.min_element, preset.min_element),
            max_level: self.max_level.unwrap_or(preset.max_level),
            patch_size: or_preset(self.patch_size, preset.patch_size),
            discontinuity_lines: !self.no_discontinuity_lines,
            shadow_rays: self.shadow_rays,
            unshot_limit: self.stop.unwrap_or(preset.unshot_limit),
            method: self.solver.into(),
            omega: self.omega.unwrap_or(preset.omega),
            hemicube_resolution: self.hemicube_resolution.unwrap_or(preset.hemicube_resolution),
            ..preset
        }
    }
}
