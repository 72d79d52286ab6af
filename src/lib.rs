//! Adaptive radiosity: a scene of diffuse surfaces in, a crack-free mesh that carries its light out.
//!
//! ```text
//! file → Scene → Surfaces → Mesh ⇄ direct light, transport ⇄ solver → TriMesh → GLB · picture · page
//! ```
//!
//! The [`guide`] has a page for each task: commands first, what they write, and what to expect. Below is the map of the library.
//!
//! | step | what it promises |
//! |---|---|
//! | [`load`], or [`Scene::build`] → [`Scene`] | what the file or the code says, every default settled, every repair told in a note |
//! | [`surfaces_of`] → [`Surfaces`] | planar polygons, holes allowed, of one material, and their contact lines |
//! | [`mesh::Mesh::new`] | patches, cut along contact lines, and under each a tree of elements |
//! | [`solve`] → [`Solution`] | light on the mesh, the mesh refined where the light asks for it, and why it stopped |
//! | [`reconstruct()`] → [`TriMesh`] | radiosity at the vertices of a conforming triangulation |
//! | [`solver::read`] → [`solver::Reading`]s | illuminance at any places, on a [`solver::WorkPlane`] for one |
//! | [`form_factor::assemble`] → [`form_factor::FormFactors`] | beside all that: the matrix itself, of patches by whole faces ([`faces_of`]) or surfaces |
//! | [`lightmap::Atlas`] → [`lightmap::bake()`] | the same light as a picture, on a mesh as coarse as the surfaces |
//! | [`export::save`], [`render::render`] | files for others, pictures |
//! | [`page::viewer()`] and others, [`page::document()`] | pages to share, with the mesh to turn in them |
//! | [`compare::compare`] → [`compare::Comparison`] | errors and costs of uniform and adaptive meshes, and a verdict |
//!
//! The modules, in the order in which data moves; one may use those to its left, never those to its right:
//!
//! geometry → scene → surface → mesh → light → visibility → `form_factor` → direct → refine → solver →
//! reconstruct → lightmap → tone → export, render → page → compare
//!
//! Features, all of them on unless left out: `pages` brings [`mod@page`], `compare` brings `pages` and [`mod@compare`], and
//! `cli` both and the command.
//!
//! # Words and units
//!
//! A *surface* is a planar polygon of one material; a *patch*, a coarse piece of it, shoots; an
//! *element*, a node of the tree under a patch, receives; a *leaf* is an element without children;
//! a *vertex* is a corner of the output. B is radiosity and E exitance, W/m² per channel of linear
//! RGB; L is radiance, W/(m² sr), and what files call emission, so E = πL; ρ is diffuse
//! reflectance, 0..=0.99. Metres, and Y is up.
//!
//! # Example
//!
//! ```
//! use std::ops::ControlFlow;
//! use std::path::Path;
//! use radiosity::export::{self, Stamp};
//! use radiosity::{Settings, load, reconstruct, solve, surfaces_of};
//!
//! # fn main() -> radiosity::Result<()> {
//! # let directory = tempfile::tempdir().expect("a place for files");
//! # let output = directory.path().join("cornell.glb");
//! let scene = load(Path::new("scenes/cornell-box.obj"), &Default::default())?;
//! let surfaces = surfaces_of(&scene);
//! # let settings = Settings { max_level: 2, ..Settings::draft() };
//! # #[cfg(any())]
//! let settings = Settings::medium();
//! let solution = solve(&surfaces, &settings, |progress| {
//!     println!("{:?} {:.0} %", progress.phase, 100.0 * progress.done);
//!     ControlFlow::Continue(())
//! })?;
//! assert!(solution.energy.imbalance().abs() < 0.005, "light was lost");
//! let mesh = reconstruct(&surfaces, &solution);
//! export::save(&mesh, &output, &Stamp::default())?;
//! # Ok(())
//! # }
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(
    not(feature = "compare"),
    allow(
        dead_code,
        unused_imports,
        reason = "some of what rooms share is for pages and reports alone"
    )
)]
#![warn(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

pub mod colour;
pub mod error;
mod file;
mod ids;
pub mod settings;
mod watch;

pub mod geometry;

pub mod scene;
pub mod surface;

pub mod mesh;

pub mod light;

pub mod visibility;

pub mod form_factor;

pub mod direct;

pub mod refine;

pub mod solver;

pub mod reconstruct;

pub mod lightmap;

pub mod tone;

pub mod export;
pub mod render;

#[cfg(feature = "pages")]
pub mod page;

#[cfg(feature = "compare")]
pub mod compare;

pub mod guide;

pub use error::{Error, Result};
/// The crate of vectors and matrices that positions, colours and transforms are made of, in the version used here.
pub use glam;
pub use reconstruct::{TriMesh, reconstruct};
pub use scene::{Scene, load};
pub use settings::{Length, Settings};
pub use solver::{Plan, ScaledLight, Solution, solve, solve_by_light, solve_with};
pub use surface::{Surfaces, faces_of, surfaces_of};
