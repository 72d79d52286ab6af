//! Laws of lightmaps: where surfaces are in an atlas, and that the light in it is theirs.

mod atlas;
mod files;
mod light;
mod scenes;
