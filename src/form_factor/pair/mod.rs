//! Exact form factors between two polygons, with nothing between them or with occluders.
//!
//! All values are *exchanges* A₁F₁₂ = A₂F₂₁, m²: symmetric, and so reciprocal by construction.
//!
//! - `edges`, `cubature`: integrals along two edges and over polygons
//! - `unoccluded`: the exchange with nothing between
//! - `view`, `cell`, `occluded`: with occluders, points of one polygon see parts of the other

mod cell;
mod cubature;
mod edges;
mod occluded;
mod unoccluded;
mod view;

pub(super) use cubature::{at as place_in, quadrilaterals};
pub use occluded::visible_exchange;
pub(super) use unoccluded::is_level;
pub use unoccluded::{by_contours, exchange};
