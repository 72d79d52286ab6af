//! The tree of nodes: meshes and cameras under the nodes that the scene has them under.
//!
//! Vertices are where they are in the scene, so nodes move nothing, but for cameras and, far from the origin, one
//! above all others: single precision holds small distances from a place nearby only.

use std::collections::BTreeMap;

use glam::{DMat3, DQuat, DVec3};
use gltf_json::camera::{Perspective, Type};
use gltf_json::mesh::Primitive;
use gltf_json::scene::{Scene, UnitQuaternion};
use gltf_json::validation::Checked;
use gltf_json::{Index, Mesh, Node, Root};

use crate::export::exposed::singles;
use crate::scene::{self, Camera};

/// Name of what has none of its own: the file's scene, the mesh of no object, and the node above all others.
pub(super) const NAME: &str = "radiosity";

/// Nearest distance that a camera is said to see, as a share of the mesh's extent.
const NEAR: f64 = 1e-3;

/// What is to be hung up, and where.
#[derive(Debug)]
pub(super) struct NodeTree<'a> {
    /// Names of the objects.
    pub(super) objects: &'a [String],
    pub(super) nodes: &'a [scene::Node],
    pub(super) cameras: &'a [Camera],
    /// Where the file's coordinates begin, m.
    pub(super) origin: DVec3,
    /// Size of the whole, m.
    pub(super) extent: f64,
}

impl NodeTree<'_> {
    /// Adds the scene with its meshes, which come by object.
    pub(super) fn add(&self, root: &mut Root, meshes: BTreeMap<Option<u32>, Vec<Primitive>>) {
        let mut meshes: BTreeMap<Option<u32>, Index<Mesh>> = meshes
            .into_iter()
            .map(|(object, list)| (object, self.mesh(root, object, list)))
            .collect();
        let mut cameras: Vec<Option<&Camera>> = self.cameras.iter().map(Some).collect();
        let first = root.nodes.len() as u32;
        let mut roots = Vec::new();
        for node in self.nodes {
            let mesh = node.object.and_then(|object| meshes.remove(&Some(object)));
            let index = root.push(Node { name: named(&node.name), mesh, ..Node::default() });
            match node.parent {
                Some(parent) => adopt(root, Index::new(first + parent), index),
                None => roots.push(index),
            }
        }
        for (number, node) in self.nodes.iter().enumerate() {
            let camera = node.camera.and_then(|camera| cameras.get_mut(camera as usize)?.take());
            let Some(camera) = camera else { continue };
            let index = Index::new(first + number as u32);
            let is_alone = root.nodes[index.value()].children.is_none() && node.object.is_none();
            let seat = if is_alone { index } else { root.push(Node::default()) };
            self.seat(root, seat, camera);
            if !is_alone {
                adopt(root, index, seat);
            }
        }
        for (object, mesh) in meshes {
            let name = Some(self.name(object));
            roots.push(root.push(Node { name, mesh: Some(mesh), ..Node::default() }));
        }
        for camera in cameras.into_iter().flatten() {
            let seat = root.push(Node::default());
            self.seat(root, seat, camera);
            roots.push(seat);
        }
        self.finish(root, roots);
    }

    /// Adds the scene of these roots, moved to where they belong.
    fn finish(&self, root: &mut Root, mut roots: Vec<Index<Node>>) {
        let name = Some(NAME.to_owned());
        if self.origin != DVec3::ZERO {
            let translation = Some(singles(self.origin));
            let (name, children) = (name.clone(), Some(roots));
            roots = vec![root.push(Node { name, translation, children, ..Node::default() })];
        }
        root.scene = Some(root.push(Scene { name, nodes: roots, extensions: None, extras: None }));
    }

    fn mesh(
        &self,
        root: &mut Root,
        object: Option<u32>,
        primitives: Vec<Primitive>,
    ) -> Index<Mesh> {
        let name = Some(self.name(object));
        root.push(Mesh { name, primitives, weights: None, extensions: None, extras: None })
    }

    fn name(&self, object: Option<u32>) -> String {
        let name = object.and_then(|object| self.objects.get(object as usize));
        name.map_or(NAME, String::as_str).to_owned()
    }

    /// Makes a node the place of a camera, which looks along -Z.
    fn seat(&self, root: &mut Root, seat: Index<Node>, camera: &Camera) {
        let back = (camera.eye - camera.target).normalize_or(DVec3::Z);
        let right = camera.up.cross(back).normalize_or(back.any_orthonormal_vector());
        let turn = DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back));
        let view = root.push(gltf_json::Camera {
            name: named(&camera.name),
            orthographic: None,
            perspective: Some(Perspective {
                aspect_ratio: None,
                yfov: camera.vertical_fov as f32,
                zfar: None,
                znear: (NEAR * self.extent).max(f64::from(f32::MIN_POSITIVE)) as f32,
                extensions: None,
                extras: None,
            }),
            type_: Checked::Valid(Type::Perspective),
            extensions: None,
            extras: None,
        });
        let node = &mut root.nodes[seat.value()];
        node.name = node.name.take().or_else(|| named(&camera.name));
        node.camera = Some(view);
        node.translation = Some(singles(camera.eye - self.origin));
        node.rotation = Some(UnitQuaternion(turn.normalize().as_quat().to_array()));
    }
}

fn named(name: &str) -> Option<String> {
    (!name.is_empty()).then(|| name.to_owned())
}

fn adopt(root: &mut Root, parent: Index<Node>, child: Index<Node>) {
    root.nodes[parent.value()].children.get_or_insert_default().push(child);
}
