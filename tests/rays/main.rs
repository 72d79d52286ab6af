//! Rays: the hierarchy they walk through, the patches they meet, and what a sphere of them sees.

#[path = "../common/mod.rs"]
mod common;

mod hierarchy;
mod occluders;
mod patches;
mod sphere;
