//! What a solution is, and what it tells on the way.

use super::power_balance::PowerBalance;
use super::relaxation::RelaxationStep;
use super::stop::Stop;
use super::work::Work;
use crate::colour::Rgb;
use crate::light::{ElementLight, Optics, VertexLight};
use crate::mesh::Mesh;

/// A lit mesh, and how it came to be.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The mesh.
    pub mesh: Mesh,
    /// How its patches reflect and emit.
    pub optics: Optics,
    /// Light at its vertices.
    pub vertex_light: VertexLight,
    /// Mean light on all elements, from that at the vertices.
    pub light: ElementLight,
    /// Where the emitted power has gone.
    pub energy: PowerBalance,
    /// Why the solver stopped.
    pub stop: Stop,
    /// Patches that have shot, emitters included and each time counted.
    pub shots: usize,
    /// Hemicubes looked through: over patches, and over vertices.
    pub hemicubes: [usize; 2],
    /// What was evaluated.
    pub work: Work,
    /// Irradiance added for the light still unshot, W/m²; zero when converged.
    pub ambient: Rgb,
    /// How the exchange of reflected light converged, patch by patch.
    pub history: Vec<RelaxationStep>,
}

impl Solution {
    /// Shots of reflected light, those of emitters not counted.
    pub fn reflected_shots(&self) -> usize {
        self.history.last().map_or(0, |step| step.shots)
    }
}

/// A step of the work, told to the observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub phase: Phase,
    /// How much of the phase is done, 0..=1.
    pub done: f64,
}

/// The passes of a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Phase {
    /// What each patch sees of the emitters.
    Emitters,
    /// Direct light, refining the mesh.
    Direct,
    /// Lines on which direct light has a kink or a bend.
    Lines,
    /// Exchange of reflected light.
    Shooting,
    /// Indirect light at vertices.
    Gathering,
}
