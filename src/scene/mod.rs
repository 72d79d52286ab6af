//! What a file says, every default settled, every repair reported.
//!
//! Nothing downstream asks where a value came from: positions are metres with Y up, colours are
//! linear, emission is radiance, lights are in watts, texture coordinates have their transforms applied.
//!
//! | what | where |
//! |---|---|
//! | the scene itself | `model`; `material` with `texels`, `light` with `photometry`, `camera` |
//! | read from a file | `load` by `options`: `obj`, `gltf`, `stl`, `ply`; their lines are `text`, files that they name are `named` |
//! | pictures | `texture`, and between texels `mixed` |
//! | laid in metres, Y up | `up` |
//! | repaired | `repair`: `weld`, `junctions`, `corners`; of single polygons `polygon`, of many `boxes`; `limits` |
//! | its sides settled | `orientation`, `daylight`, by `ray_casting` along the directions of a `sequence` |
//! | made in code | `build` |
//! | changed by its user | `names`, `adding`, `overrides`, `ies` |
//! | told of | `notes`, `backdrop` |

mod notes;
mod sequence;
mod text;

mod camera;
mod ids;
mod light;
mod material;
mod mixed;
mod model;
mod photometry;
mod texels;

mod limits;
mod named;
mod ray_casting;
mod texture;
mod up;

mod corners;
mod daylight;
mod junctions;
mod orientation;
mod repair;
mod weld;

mod options;

mod gltf;
mod obj;
mod ply;
mod stl;

mod load;

mod adding;
mod backdrop;
mod build;
mod ies;
mod names;
mod overrides;

pub(crate) use self::gltf::sampler_of;
pub use adding::{Amount, AreaLight};
pub use camera::Camera;
pub use ids::MaterialId;
pub(crate) use light::SUN_RADIUS;
pub use light::{DESIGN_SKY, Light, NamedLight, Sky, clear_sun};
pub use load::load;
pub use material::{MAX_REFLECTANCE, Material, Sampler, Texture, Wrap};
pub use model::{Face, Node, Scene};
pub(crate) use names::{matches, named};
pub(crate) use notes::{counted, note_count};
pub use options::{EmissionUnit, LoadOptions};
pub use orientation::{Sides, settle_sides};
pub use photometry::Photometry;
pub use texels::Texels;
pub(crate) use texture::{decode, mean};
pub use up::Up;
