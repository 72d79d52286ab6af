//! Adaptive radiosity: a scene of diffuse surfaces in, a crack-free mesh that carries its light out.
//!
//! scene → surface → mesh → visibility → `form_factor` → refine → solver → reconstruct → tone → export, render
//!
//! Data moves left to right. A module may use those to its left, never those to its right.
//!
//! Units: metres, linear RGB, W/m² for radiosity, W/(m² sr) for radiance. Y is up.

#![warn(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

pub mod colour;
pub mod error;
mod file;
pub mod settings;

pub mod scene;
pub mod surface;

pub mod mesh;

pub mod visibility;

pub mod form_factor;

pub mod direct;

pub mod refine;

pub mod solver;

pub mod reconstruct;

pub mod tone;

pub mod export;
pub mod render;

pub use error::{Error, Result};
pub use reconstruct::{TriMesh, reconstruct};
pub use scene::{Scene, load};
pub use settings::{Length, Settings};
pub use solver::{Solution, solve};
pub use surface::{Surfaces, surfaces_of};
