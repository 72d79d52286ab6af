//! Pictures of a mesh that carries its light, and of how it came by it.
//!
//! Triangles are seen from their front only, so that one looks into a closed room from outside.
//!
//! - `subject`, `view`, `options`: what pictures are taken of, what they show, and how
//! - `rays`, `caster`: rays of a camera, and the triangles they meet
//! - `colours`, `leaves`, `final_gather`, `shade`: what is seen where a ray ends
//! - `lines`, `picture`, `tracer`, `draw`: the pixels of a picture
//! - `scale`, `map`, `letters`, `legend`, `display`, `save`: how a picture is shown
//! - `exposure`, `automatic_camera`: what a camera sees, and where one sees much

mod automatic_camera;
mod caster;
pub(crate) mod colours;
mod display;
mod draw;
mod exposure;
mod final_gather;
pub(crate) mod leaves;
mod legend;
mod letters;
mod lines;
pub(crate) mod map;
mod options;
mod picture;
mod rays;
mod save;
mod scale;
mod shade;
mod subject;
mod tracer;
mod view;

pub use automatic_camera::automatic_camera;
pub use display::{Display, displayed};
pub use draw::{render, render_solved};
pub use exposure::exposure_seen;
pub use letters::{Letters, fill};
pub use options::RenderOptions;
pub use picture::Picture;
pub use rays::close_up;
pub(crate) use save::smallest_png;
pub use save::{check_writable, png, save};
pub use subject::{Solved, Subject};
pub use view::View;
