//! What came of a solution, for people and for programs.

use std::fmt::{self, Display, Formatter};
use std::path::PathBuf;

use radiosity::colour::{LUMENS_PER_WATT, Rgb, luminance};
use radiosity::mesh::Divided;
use radiosity::reconstruct::{Angles, TriMesh};
use radiosity::solver::{Cancellation, PowerBalance, Stop};
use radiosity::{Solution, Surfaces};
use serde::Serialize;

use super::grid::GridFigures;
use super::meter::Timing;
use super::record::SettingsRecord;

/// Figures of a solution.
#[derive(Debug, Serialize)]
pub(crate) struct Summary {
    /// False if the solver was stopped before it was done.
    pub(crate) finished: bool,
    /// `converged`, `unchanged`, `shot limit`, `time limit`, `interrupted` or `terminated`.
    pub(crate) stop: &'static str,
    pub(crate) surfaces: usize,
    pub(crate) patches: usize,
    pub(crate) elements: usize,
    pub(crate) leaves: usize,
    pub(crate) divided: Divided,
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
    pub(crate) angles: Angles,
    pub(crate) shots: usize,
    pub(crate) hemicubes: Hemicubes,
    pub(crate) energy: Balance,
}
/// Hemicubes looked through.
#[derive(Debug, Serialize)]
pub(crate) struct Hemicubes {
    pub(crate) patches: usize,
    pub(crate) vertices: usize,
}

/// Powers, W per channel.
#[derive(Debug, Serialize)]
pub(crate) struct Balance {
    pub(crate) emitted: [f64; 3],
    pub(crate) absorbed: [f64; 3],
    pub(crate) on_backs: [f64; 3],
    pub(crate) escaped: [f64; 3],
    pub(crate) unshot: [f64; 3],
    /// Share of the emitted power.
    pub(crate) imbalance: f64,
}

/// A summary with what the command knows beside it.
#[derive(Debug, Serialize)]
pub(crate) struct Outcome {
    pub(crate) scene: PathBuf,
    /// Whether people want powers in lumens.
    #[serde(skip)]
    pub(crate) photometric: bool,
    #[serde(flatten)]
    pub(crate) summary: Summary,
    /// Of the grid, if there is one.
    pub(crate) grid: Option<GridFigures>,
    pub(crate) settings: SettingsRecord,
    pub(crate) seconds: Vec<Timing>,
    pub(crate) written: Vec<PathBuf>,
    pub(crate) notes: Vec<String>,
}

impl Summary {
    pub(crate) fn new(surfaces: &Surfaces, solution: &Solution, mesh: &TriMesh) -> Self {
        let elements = &solution.mesh.elements;
        let [patches, vertices] = solution.hemicubes;
        Self {
            finished: solution.stop == Stop::Converged,
            stop: match solution.stop {
                Stop::Converged => "converged",
                Stop::Unchanged => "unchanged",
                Stop::ShotLimit => "shot limit",
                Stop::Cancelled(Cancellation::TimeLimit) => "time limit",
                Stop::Cancelled(Cancellation::Interrupt) => "interrupted",
                Stop::Cancelled(Cancellation::Termination) => "terminated",
                Stop::Cancelled(Cancellation::Caller) => "cancelled",
                Stop::Diverged => "diverged",
            },
            surfaces: surfaces.list.len(),
            patches: solution.mesh.patches.len(),
            elements: elements.len(),
            leaves: elements.iter().filter(|element| element.is_leaf()).count(),
            divided: solution.mesh.divided(),
            vertices: mesh.positions.len(),
            triangles: mesh.triangles.len(),
            angles: mesh.angles(),
            shots: solution.shots,
            hemicubes: Hemicubes { patches, vertices },
            energy: Balance::from(&solution.energy),
        }
    }
}

impl From<&PowerBalance> for Balance {
    fn from(energy: &PowerBalance) -> Self {
        let watts = |power: Rgb| power.to_array();
        Self {
            emitted: watts(energy.emitted),
            absorbed: watts(energy.absorbed),
            on_backs: watts(energy.on_backs),
            escaped: watts(energy.escaped),
            unshot: watts(energy.unshot),
            imbalance: energy.imbalance(),
        }
    }
}

impl Display for Outcome {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Summary { hemicubes, .. } = &self.summary;
        let s = &self.summary;
        let total: f64 = self.seconds.iter().map(|timing| timing.seconds).sum();
        let state = if s.finished { "" } else { ", unfinished" };
        writeln!(f, "{}: {}{state}, {total:.1} s", self.scene.display(), s.stop)?;
        writeln!(f, "surfaces   {}, {} patches", s.surfaces, s.patches)?;
        writeln!(f, "elements   {}, {} leaves", s.elements, s.leaves)?;
        writeln!(f, "divided    {}", s.divided)?;
        writeln!(f, "mesh       {} triangles, {} vertices", s.triangles, s.vertices)?;
        let Angles { smallest, below_ten, .. } = s.angles;
        writeln!(f, "smallest angle {smallest:.1}°, {:.1} % below 10°", 100.0 * below_ten)?;
        writeln!(f, "shots      {}", s.shots)?;
        writeln!(f, "hemicubes  patches {}, vertices {}", hemicubes.patches, hemicubes.vertices)?;
        if self.photometric {
            s.energy.write_lumens(f)?;
        } else {
            write!(f, "{}", s.energy)?;
        }
        if let Some(grid) = &self.grid {
            write!(f, "\n{grid}")?;
        }
        if !self.written.is_empty() {
            let names: Vec<String> =
                self.written.iter().map(|path| path.display().to_string()).collect();
            write!(f, "\nwritten    {}", names.join(", "))?;
        }
        Ok(())
    }
}

impl Balance {
    fn rows(&self) -> [(&'static str, [f64; 3]); 5] {
        [
            ("emitted", self.emitted),
            ("= absorbed", self.absorbed),
            ("+ on backs", self.on_backs),
            ("+ escaped", self.escaped),
            ("+ unshot", self.unshot),
        ]
    }

    /// A power in lumens.
    pub(crate) fn lumens(power: [f64; 3]) -> f64 {
        luminance(power.into()) * LUMENS_PER_WATT
    }

    /// The same in lumens, for those who have given their lamps so.
    fn write_lumens(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "flux, lm")?;
        for (name, power) in self.rows() {
            writeln!(f, "{name:<10} {:>11.1}", Self::lumens(power))?;
        }
        write!(f, "imbalance  {:.3} %", 100.0 * self.imbalance)
    }
}

impl Display for Balance {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<10} {:>11} {:>11} {:>11}", "power, W", "red", "green", "blue")?;
        for (name, [red, green, blue]) in self.rows() {
            writeln!(f, "{name:<10} {red:>11.5} {green:>11.5} {blue:>11.5}")?;
        }
        write!(f, "imbalance  {:.3} %", 100.0 * self.imbalance)
    }
}
