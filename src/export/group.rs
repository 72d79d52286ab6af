//! A mesh sorted by object and material, each with only the vertices it uses.

use std::collections::BTreeMap;

use crate::reconstruct::{MeshPart, TriMesh};

/// What tells materials from each other: name, texture, and the bits of the cutoff.
pub(crate) type MaterialKey<'a> = (&'a str, Option<u32>, Option<u64>);

/// The triangles of one material and object and their vertices, numbered on their own.
#[derive(Debug)]
pub(crate) struct Group<'a> {
    pub(crate) name: &'a str,
    /// Index into [`TriMesh::textures`].
    pub(crate) texture: Option<u32>,
    /// Alpha of the texture below which there is a hole.
    pub(crate) cutoff: Option<f64>,
    /// Index into [`TriMesh::objects`].
    pub(crate) object: Option<u32>,
    /// Indices into the mesh's lists of vertices, in order of first use.
    pub(crate) vertices: Vec<u32>,
    /// Corners, as indices into `vertices`.
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl<'a> Group<'a> {
    fn new(part: &'a MeshPart) -> Self {
        let MeshPart { name, texture, cutoff, object, .. } = part;
        let (vertices, triangles) = (Vec::new(), Vec::new());
        Self { name, texture: *texture, cutoff: *cutoff, object: *object, vertices, triangles }
    }

    pub(crate) fn key(&self) -> MaterialKey<'a> {
        (self.name, self.texture, self.cutoff.map(f64::to_bits))
    }

    /// Trades the mesh's vertex numbers for the group's own; `numbers` is scratch space.
    fn renumber(&mut self, numbers: &mut [u32]) {
        for corner in self.triangles.iter_mut().flatten() {
            let number = &mut numbers[*corner as usize];
            if *number == UNUSED {
                *number = self.vertices.len() as u32;
                self.vertices.push(*corner);
            }
            *corner = *number;
        }
        for &vertex in &self.vertices {
            numbers[vertex as usize] = UNUSED;
        }
    }
}

const UNUSED: u32 = u32::MAX;

/// One group for each material of each object that has triangles, object by object, in the order in which materials
/// first appear.
pub(crate) fn by_object(mesh: &TriMesh) -> Vec<Group<'_>> {
    let mut groups: Vec<Group> = Vec::new();
    let mut places = BTreeMap::new();
    for part in mesh.parts.iter().filter(|part| !part.triangles.is_empty()) {
        let empty = Group::new(part);
        let place = *places.entry((empty.key(), part.object)).or_insert_with(|| {
            groups.push(empty);
            groups.len() - 1
        });
        groups[place].triangles.extend_from_slice(&mesh.triangles[part.triangles.clone()]);
    }
    groups.sort_by_key(|group| group.object);
    let mut numbers = vec![UNUSED; mesh.positions.len()];
    for group in &mut groups {
        group.renumber(&mut numbers);
    }
    groups
}

/// All triangles and the vertices they use, whatever the material.
pub(crate) fn whole(mesh: &TriMesh) -> Group<'_> {
    let mut group = Group {
        name: "",
        texture: None,
        cutoff: None,
        object: None,
        vertices: Vec::new(),
        triangles: mesh.triangles.clone(),
    };
    group.renumber(&mut vec![UNUSED; mesh.positions.len()]);
    group
}
