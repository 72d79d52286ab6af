//! What names a material.

use crate::ids::id;

id! {
    /// Names a [`Material`](super::Material) of one scene, and of its surfaces.
    MaterialId: super::Material, super::Scene, materials
}
