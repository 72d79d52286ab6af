//! Pictures of a mesh that carries its light.
//!
//! Triangles are seen from their front only, so that one looks into a closed room from outside.

mod automatic_camera;
mod caster;
mod display;
mod false_colour;
mod legend;
mod lines;
mod picture;
mod save;
mod scale;
mod texture;
mod view;

pub use automatic_camera::automatic_camera;
pub use display::Display;
pub use false_colour::{FalseColour, Quantity};
pub use picture::{Picture, RenderOptions, render};
pub use save::{check_writable, save};
