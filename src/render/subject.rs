//! What pictures are taken of: a mesh, and what it was made from.

use crate::reconstruct::TriMesh;
use crate::settings::Settings;
use crate::solver::{Solution, Stop};
use crate::surface::Surfaces;

/// What a triangle mesh was made from.
#[derive(Clone, Copy, Debug)]
pub struct Solved<'a> {
    /// The scene's surfaces.
    pub surfaces: &'a Surfaces,
    /// What the solution was held to.
    pub settings: &'a Settings,
    /// Their light.
    pub solution: &'a Solution,
}

/// What a picture is taken of.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// What is seen.
    pub mesh: &'a TriMesh,
    /// What it was made from, for views that need it and for final gathering.
    pub solved: Option<Solved<'a>>,
}

impl Subject<'_> {
    /// Whether its solution was stopped before it was done.
    pub(super) fn is_unfinished(&self) -> bool {
        self.solved.is_some_and(|solved| solved.solution.stop != Stop::Converged)
    }
}
