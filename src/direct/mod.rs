//! Light straight from emitters: exact where a light is a polygon, by rays where it is a point.
//!
//! It carries the hard edges, so it is never carried by the hemicube.

mod ids;
mod profile;
mod work;

mod view;

mod sampling;

mod globe;
mod glow;
mod punctual;

mod lamp;

mod sky;

mod lamps;

mod rough;
mod sent;
mod unbiased;

mod candidates;
mod lines;
mod pool;

mod evaluation;

mod patch_light;

pub use ids::EmitterId;
pub use lamps::Lamps;
pub use lines::EventLine;
pub use patch_light::{Outlook, PatchLight};
pub(crate) use sent::Sent;
pub use work::{Evaluated, WorkCounters};
