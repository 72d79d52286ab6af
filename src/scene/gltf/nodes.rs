//! The node tree: where meshes, cameras and lights stand.

use ::gltf::json::scene::Node;
use ::gltf::json::{self, Index};
use glam::{DMat4, DQuat, DVec3, Mat4, Quat, Vec3};

use super::import::GltfImport;
use super::pose::Placement;
use crate::error::Result;
use crate::scene::Node as SceneNode;

/// A node, its transform to the world, and which of those placed is its parent.
type PlacedNode = (Index<Node>, DMat4, Option<u32>);

impl GltfImport<'_> {
    /// Adds what stands at the nodes of the chosen scene, parents before children, in the file's order.
    pub(super) fn add_nodes(&mut self) -> Result<()> {
        let placed = self.placed()?;
        let mut transforms = vec![None; self.file.root.nodes.len()];
        for (index, transform, _) in &placed {
            transforms[index.value()] = Some(*transform);
        }
        for (index, transform, parent) in placed {
            let name = self.file.get(index, "node")?.name.clone().unwrap_or_default();
            self.scene.nodes.push(SceneNode { name, parent, ..SceneNode::default() });
            self.add_node(index, transform, &transforms)?;
        }
        Ok(())
    }

    /// Every node of the chosen scene, once, parents before children.
    fn placed(&self) -> Result<Vec<PlacedNode>> {
        let file = self.file;
        let mut placed = Vec::new();
        let mut visited = vec![false; file.root.nodes.len()];
        let mut stack: Vec<PlacedNode> =
            self.roots()?.into_iter().rev().map(|root| (root, DMat4::IDENTITY, None)).collect();
        while let Some((index, above, parent)) = stack.pop() {
            let node = file.get(index, "node")?;
            if std::mem::replace(&mut visited[index.value()], true) {
                let message = format!("node {index} has several parents or is its own descendant");
                return Err(file.fail(message));
            }
            let transform = above * local(node);
            if !transform.is_finite() {
                return Err(file.fail(format!("node {index} has a transform that is not finite")));
            }
            let number = placed.len() as u32;
            placed.push((index, transform, parent));
            let children = node.children.as_deref().unwrap_or_default();
            stack.extend(children.iter().rev().map(|&child| (child, transform, Some(number))));
        }
        Ok(placed)
    }

    /// Roots of the default scene, else of the first, else all nodes that are no one's child.
    fn roots(&self) -> Result<Vec<Index<Node>>> {
        let root = &self.file.root;
        if let Some(index) = root.scene {
            return Ok(self.file.get(index, "scene")?.nodes.clone());
        }
        if let Some(scene) = root.scenes.first() {
            return Ok(scene.nodes.clone());
        }
        let mut is_child = vec![false; root.nodes.len()];
        for child in root.nodes.iter().filter_map(|node| node.children.as_ref()).flatten() {
            if let Some(mark) = is_child.get_mut(child.value()) {
                *mark = true;
            }
        }
        let free = (0..root.nodes.len()).filter(|&node| !is_child[node]);
        Ok(free.map(|node| Index::new(node as u32)).collect())
    }

    fn add_node(
        &mut self,
        index: Index<Node>,
        transform: DMat4,
        transforms: &[Option<DMat4>],
    ) -> Result<()> {
        let node = self.file.get(index, "node")?;
        if let Some(mesh) = node.mesh {
            let mesh = self.file.get(mesh, "mesh")?;
            let name = node.name.clone().or_else(|| mesh.name.clone());
            self.scene.objects.push(name.unwrap_or_else(|| format!("node {index}")));
            let object = self.scene.objects.len() as u32 - 1;
            if let Some(own) = self.scene.nodes.last_mut() {
                own.object = Some(object);
            }
            let joints = node.skin.map(|skin| self.file.joints(skin, transforms)).transpose()?;
            let joints = joints.as_deref();
            let weights = node.weights.as_ref().or(mesh.weights.as_ref());
            let weights = weights.map_or(&[][..], Vec::as_slice);
            for primitive in &mesh.primitives {
                let placement = Placement { transform, joints, weights, object };
                self.add_primitive(primitive, placement)?;
            }
        }
        if let Some(camera) = node.camera {
            let camera = self.file.get(camera, "camera")?;
            let before = self.scene.cameras.len();
            self.add_camera(camera, node, transform);
            if self.scene.cameras.len() > before
                && let Some(own) = self.scene.nodes.last_mut()
            {
                own.camera = Some(before as u32);
            }
        }
        let lights = node.extensions.as_ref().and_then(|all| all.khr_lights_punctual.as_ref());
        if let Some(light) = lights {
            let light: &json::extensions::scene::khr_lights_punctual::Light =
                self.file.get(light.light, "light")?;
            self.add_light(light, node, transform)?;
        }
        Ok(())
    }
}

fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return Mat4::from_cols_array(&matrix).as_dmat4();
    }
    let rotation = node.rotation.map_or(Quat::IDENTITY, |rotation| Quat::from_array(rotation.0));
    // Normalised in double precision, as the file holds it only in single.
    let rotation = rotation.as_dquat();
    let length = rotation.length();
    let rotation = if length > 0.0 { rotation / length } else { DQuat::IDENTITY };
    let scale = node.scale.map_or(DVec3::ONE, |scale| Vec3::from(scale).as_dvec3());
    let translation = node.translation.map_or(DVec3::ZERO, |t| Vec3::from(t).as_dvec3());
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}
