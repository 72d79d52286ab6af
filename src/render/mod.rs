//! Pictures of a mesh that carries its light, and of how it came by it.
//!
//! Triangles are seen from their front only, so that one looks into a closed room from outside.

mod automatic_camera;
mod caster;
pub(crate) mod colours;
mod display;
mod exposure;
mod final_gather;
pub(crate) mod leaves;
mod legend;
mod letters;
mod lines;
pub(crate) mod map;
mod picture;
mod rays;
mod save;
mod scale;
mod shade;
mod tracer;
mod view;

pub use automatic_camera::automatic_camera;
pub use display::{Display, displayed};
pub use exposure::exposure_seen;
pub use picture::{Picture, RenderOptions, Subject, render, render_solved};
pub use rays::close_up;
pub(crate) use save::smallest_png;
pub use save::{check_writable, png, save};
pub use shade::Solved;
pub use view::View;
