//! Reading the tree of nodes again.

use glam::{DVec3, Quat, Vec3};
use gltf_json::{Node, Root};

use super::tree::NAME;
use crate::reconstruct::TriMesh;
use crate::scene::{self, Camera};

/// Where the meshes of a file are hung up, and as what.
#[derive(Debug)]
pub(super) struct Hung<'a> {
    root: &'a Root,
    parents: Vec<Option<usize>>,
}

impl<'a> Hung<'a> {
    pub(super) fn new(root: &'a Root) -> Self {
        let mut parents = vec![None; root.nodes.len()];
        for (parent, node) in root.nodes.iter().enumerate() {
            for child in node.children.iter().flatten() {
                if let Some(known) = parents.get_mut(child.value()) {
                    *known = Some(parent);
                }
            }
        }
        Self { root, parents }
    }

    /// By how much a mesh is moved, m; nothing of one that is turned or scaled, which we write none of.
    pub(super) fn offset(&self, mesh: usize) -> Option<DVec3> {
        let is_it = |node: &Node| node.mesh.is_some_and(|index| index.value() == mesh);
        let mut next = self.root.nodes.iter().position(is_it);
        let mut offset = DVec3::ZERO;
        // No more steps than there are nodes, should they be in a ring.
        for _ in 0..self.root.nodes.len() {
            let Some(index) = next else { break };
            let node = &self.root.nodes[index];
            if node.matrix.is_some() || node.rotation.is_some() || node.scale.is_some() {
                return None;
            }
            offset += Vec3::from(node.translation.unwrap_or_default()).as_dvec3();
            next = self.parents[index];
        }
        offset.is_finite().then_some(offset)
    }

    /// The object that a mesh is, if it is one; added to the mesh's names.
    pub(super) fn object(&self, into: &mut TriMesh, mesh: usize) -> Option<u32> {
        let name = self.root.meshes[mesh].name.as_deref().unwrap_or_default();
        (name != NAME).then(|| {
            into.objects.push(name.to_owned());
            into.objects.len() as u32 - 1
        })
    }

    /// Adds the nodes and cameras; `objects` has what each mesh is.
    pub(super) fn read(&self, into: &mut TriMesh, objects: &[Option<u32>]) {
        let mut numbers = vec![None; self.root.nodes.len()];
        let is_ours = |node: &Node, parent: Option<usize>| {
            let moves_all = node.translation.is_some() && node.camera.is_none() && parent.is_none();
            let mesh = node.mesh.map(|mesh| mesh.value());
            moves_all || mesh.is_some_and(|mesh| objects.get(mesh) == Some(&None))
        };
        let ours = self.root.nodes.iter().zip(&self.parents).map(|(node, &p)| is_ours(node, p));
        let kept: Vec<usize> = ours.enumerate().filter(|(_, ours)| !ours).map(|(i, _)| i).collect();
        for (number, &index) in kept.iter().enumerate() {
            numbers[index] = Some(number as u32);
        }
        for index in kept {
            let node = &self.root.nodes[index];
            let camera = self.camera(node, self.parents[index]);
            into.nodes.push(scene::Node {
                name: node.name.clone().unwrap_or_default(),
                parent: self.parents[index].and_then(|parent| numbers[parent]),
                object: node.mesh.and_then(|mesh| *objects.get(mesh.value())?),
                camera: camera.is_some().then_some(into.cameras.len() as u32),
            });
            into.cameras.extend(camera);
        }
    }

    /// The camera of a node that only what is above all moves.
    fn camera(&self, node: &Node, parent: Option<usize>) -> Option<Camera> {
        let camera = self.root.cameras.get(node.camera?.value())?;
        let view = camera.perspective.as_ref()?;
        let place = |node: &Node| Vec3::from(node.translation.unwrap_or_default()).as_dvec3();
        let mut eye = place(node);
        let mut above = parent;
        for _ in 0..self.root.nodes.len() {
            let Some(index) = above else { break };
            eye += place(&self.root.nodes[index]);
            above = self.parents[index];
        }
        let turn = Quat::from_array(node.rotation.unwrap_or_default().0).as_dquat().normalize();
        let vertical_fov = f64::from(view.yfov);
        let is_view = eye.is_finite() && turn.is_finite() && vertical_fov > 0.0;
        is_view.then(|| Camera {
            name: camera.name.clone().unwrap_or_default(),
            eye,
            target: eye - turn * DVec3::Z,
            up: turn * DVec3::Y,
            vertical_fov,
        })
    }
}
