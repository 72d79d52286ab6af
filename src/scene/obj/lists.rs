//! The flat lists that the parser makes of an OBJ file, read face by face.

use std::ops::Range;

use glam::{DVec2, DVec3, Vec3};
use smallvec::SmallVec;

use super::library::Use;
use super::scan::FaceLine;
use crate::scene::Face;

/// The parser's flat lists, read face by face.
pub(super) struct MeshLists {
    vertices: Vec<u32>,
    uvs: Vec<DVec2>,
    normals: Vec<Vec3>,
}

impl MeshLists {
    pub(super) fn new(mesh: &tobj::Mesh) -> Self {
        let uv = |&index: &u32| mesh.texcoords.get(2 * index as usize..).and_then(|uv| uv.get(..2));
        let normal = |&index: &u32| mesh.normals.get(3 * index as usize..).and_then(|n| n.get(..3));
        Self {
            vertices: mesh.indices.clone(),
            uvs: mesh.texcoord_indices.iter().filter_map(uv).map(DVec2::from_slice).collect(),
            normals: (mesh.normal_indices.iter().filter_map(normal))
                .map(|normal| DVec3::from_slice(normal).normalize_or_zero().as_vec3())
                .collect(),
        }
    }

    /// The face at `range` of the lists; `None` if they are shorter.
    ///
    /// Where a corner lacks a texture coordinate or a normal the parser makes one up, so these
    /// are only taken when the line has all of them.
    pub(super) fn face(&self, range: Range<usize>, line: &FaceLine, used: &Use) -> Option<Face> {
        let mut face = Face {
            vertices: self.vertices.get(range.clone())?.into(),
            material: used.material,
            object: line.object,
            ..Face::default()
        };
        if line.has_uvs {
            let uvs: &[DVec2] = self.uvs.get(range.clone())?;
            face.uvs = uvs.iter().map(|&uv| used.mapping.apply(uv)).collect::<SmallVec<_>>();
        }
        if line.has_normals {
            face.normals = self.normals.get(range)?.into();
        }
        Some(face)
    }
}
