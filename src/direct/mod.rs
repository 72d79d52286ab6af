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

mod emitter;

mod sky;

mod emitters;

mod rough;
mod sent;
mod unbiased;

mod candidates;
mod lines;
mod pool;

mod evaluation;

mod direct_light;

pub use direct_light::{DirectLight, PotentialEmitters};
pub use emitters::Emitters;
pub use ids::EmitterId;
pub use lines::EventLine;
pub(crate) use sent::Sent;
pub use work::{Evaluated, WorkCounters};
