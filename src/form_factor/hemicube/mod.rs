//! The hemicube: which patches a point sees, and how much of each.
//!
//! Based on: Cohen and Greenberg 1985, *The hemi-cube*. Patches are projected on the five faces
//! with a z-buffer; a cell keeps the nearest. The *form factor* of what is seen is then not the sum
//! of its cells' delta factors but the exact one of the polygon times the share of its cells that
//! it kept: the cells only measure visibility, which takes most of the aliasing away.
//!
//! Only whole patches are drawn. What element a cell sees follows from where on the patch its ray
//! ends, so that a look costs patches and cells, never elements. The loops are written in registers'
//! widths and compiled twice; which of both runs is found out when it runs, and changes no bit.
//!
//! - `frame`, `delta`, `resolution`: where a hemicube is, what its cells weigh, and how many are enough
//! - `clip`, `cells`, `raster`: what of a polygon each face sees, where cells are, and which of them a polygon covers
//! - `item_buffer`: what each cell sees
//! - `scene`: the patches, laid out to be drawn
//! - `ray_fill`: rays instead of drawing
//! - `coverage`, `look`, `probe`, `seen`: a look, and what it says of patches
//! - `chart`, `element_map`, `elements`: what it says of elements

mod cells;
mod chart;
mod clip;
mod coverage;
mod delta;
mod element_map;
mod elements;
mod frame;
mod item_buffer;
mod look;
mod probe;
mod raster;
mod ray_fill;
mod resolution;
mod scene;
mod seen;

pub use cells::CellLayout;
pub use coverage::{PatchCoverage, VisiblePatch};
pub use delta::DeltaFactors;
pub use element_map::ElementMap;
pub use elements::{ElementSums, LeafSum};
pub(super) use frame::axes;
pub(crate) use frame::turn;
pub use look::Hemicube;
pub(crate) use resolution::enough_cells;
pub use scene::HemicubeScene;
