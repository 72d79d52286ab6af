//! What names a surface.

use crate::ids::id;
use crate::scene::{Material, MaterialId};

id! {
    /// Names a [`Surface`](super::Surface) of one scene's [`Surfaces`](super::Surfaces).
    SurfaceId: super::Surface, super::Surfaces, list
}

impl std::ops::Index<MaterialId> for super::Surfaces {
    type Output = Material;

    fn index(&self, id: MaterialId) -> &Material {
        &self.materials[id.index()]
    }
}
