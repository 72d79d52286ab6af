//! Light as a picture laid on a coarse mesh: for engines that want maps rather than many vertices.
//!
//! [`Atlas::new`] cuts the surfaces into *charts*, each a part of a square picture, and triangulates them
//! as coarsely as their outlines allow; that needs no light yet. [`bake()`] fills the picture.
//!
//! A texel holds E/π, W/(m² sr): the radiance that a white diffuse surface there would send on. So
//! what is seen of a surface is albedo × texel + emission, whatever its albedo's picture.
//!
//! | what | where |
//! |---|---|
//! | coarse triangles | `coarse` |
//! | which surfaces share a chart | `grow`, unless they `overlap` |
//! | charts in a square | `chart`, `pack` |
//! | both together | `atlas` |
//! | its light | `bake`, beyond borders `dilate` |

mod atlas;
mod bake;
mod chart;
mod coarse;
mod dilate;
mod grow;
mod overlap;
mod pack;

pub use atlas::{Atlas, SIZES};
pub use bake::{Lightmap, bake};
pub use chart::{BLOCK, Chart, PADDING};
pub use coarse::{CoarseMesh, CoarsePart};
