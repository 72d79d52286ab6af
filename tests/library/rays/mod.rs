//! Rays: the hierarchy they walk through, the patches they meet, and what a sphere of them sees.

mod hierarchy;
mod occluders;
mod patches;
mod sphere;
