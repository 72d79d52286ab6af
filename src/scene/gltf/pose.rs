//! How vertices get to where a viewer shows them: morphed, then placed by their node or by the joints of a skin.

use ::gltf::json::mesh::{Primitive, Semantic};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, skin::Skin};
use glam::{DMat3, DMat4, DVec3, Vec3};

use super::accessors::Purpose;
use super::file::GltfFile;
use crate::error::Result;

/// Where and as what a primitive stands in the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement<'a> {
    /// Mesh to world, unless joints pose it.
    pub(super) transform: DMat4,
    /// Mesh to world of each joint of a skin.
    pub(super) joints: Option<&'a [DMat4]>,
    /// By how much each morph target is added.
    pub(super) weights: &'a [f32],
    /// Index into the scene's objects.
    pub(super) object: u32,
}

/// From a mesh to the world.
pub(super) enum Pose {
    /// All vertices alike.
    Whole(DMat4),
    /// Each vertex by the joints it hangs on.
    Each(Vec<DMat4>),
}

impl Pose {
    /// That of so many vertices. The transform of a node with a skin counts for nothing, as the format wants.
    pub(super) fn of(
        file: &GltfFile,
        primitive: &Primitive,
        count: usize,
        placement: Placement<'_>,
    ) -> Result<Self> {
        let has = |semantic| primitive.attributes.contains_key(&Checked::Valid(semantic));
        match placement.joints {
            Some(joints) if has(Semantic::Joints(0)) && has(Semantic::Weights(0)) => {
                Ok(Self::Each(skinned(file, primitive, count, joints)?))
            }
            _ => Ok(Self::Whole(placement.transform)),
        }
    }

    fn of_vertex(&self, vertex: usize) -> DMat4 {
        match self {
            Self::Whole(transform) => *transform,
            Self::Each(transforms) => transforms[vertex],
        }
    }

    /// Whether it turns counter-clockwise into clockwise at a vertex.
    pub(super) fn mirrors(&self, vertex: u32) -> bool {
        DMat3::from_mat4(self.of_vertex(vertex as usize)).determinant() < 0.0
    }

    /// Points in the world.
    pub(super) fn placed(&self, points: Vec<DVec3>) -> Vec<DVec3> {
        let point = |(vertex, point)| self.of_vertex(vertex).transform_point3(point);
        points.into_iter().enumerate().map(point).collect()
    }

    /// Unit normals in the world. Multiplying by the cofactors keeps them right under any scale, even a flat one.
    pub(super) fn turned(&self, normals: Vec<DVec3>) -> Vec<Vec3> {
        let turned = |(vertex, normal): (usize, DVec3)| {
            let across = cofactors(DMat3::from_mat4(self.of_vertex(vertex)));
            (across * normal).normalize_or_zero().as_vec3()
        };
        normals.into_iter().enumerate().map(turned).collect()
    }
}

impl GltfFile {
    /// The matrix of each joint of a skin, from the mesh to the world; `transforms` are those of the scene's nodes.
    pub(super) fn joints(
        &self,
        index: Index<Skin>,
        transforms: &[Option<DMat4>],
    ) -> Result<Vec<DMat4>> {
        let skin = self.get(index, "skin")?;
        let inverses: Option<Vec<[f64; 16]>> = skin
            .inverse_bind_matrices
            .map(|matrices| self.floats(matrices, Purpose::InverseBind))
            .transpose()?;
        if let Some(inverses) = inverses.as_ref().filter(|all| all.len() < skin.joints.len()) {
            let (found, needed) = (inverses.len(), skin.joints.len());
            return Err(self.fail(format!(
                "skin {index} has {found} inverse bind matrices for {needed} joints"
            )));
        }
        let joint = |(number, node): (usize, &Index<_>)| {
            let transform = transforms.get(node.value()).copied().flatten().ok_or_else(|| {
                self.fail(format!("skin {index}: its joint, node {node}, is not in the scene"))
            })?;
            let inverse = inverses.as_ref().map(|all| DMat4::from_cols_array(&all[number]));
            Ok(transform * inverse.unwrap_or(DMat4::IDENTITY))
        };
        skin.joints.iter().enumerate().map(joint).collect()
    }

    /// Adds the morph targets of a primitive to positions and normals, by their weights.
    pub(super) fn morph(
        &self,
        primitive: &Primitive,
        weights: &[f32],
        [points, normals]: [&mut Vec<DVec3>; 2],
    ) -> Result<()> {
        let targets = primitive.targets.as_deref().unwrap_or_default();
        for (target, &weight) in targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            if !weight.is_finite() {
                return Err(self.fail("a weight of a morph target is not finite"));
            }
            for (index, purpose, values) in [
                (target.positions, Purpose::Position, &mut *points),
                (target.normals, Purpose::Normal, &mut *normals),
            ] {
                let index = index.filter(|_| !values.is_empty());
                let moves: Vec<[f64; 3]> = self.attribute(index, purpose, values.len())?;
                for (value, by) in values.iter_mut().zip(moves) {
                    *value += DVec3::from(by) * f64::from(weight);
                }
            }
        }
        Ok(())
    }
}

/// The matrix of each vertex: that of its joints, weighted.
fn skinned(
    file: &GltfFile,
    primitive: &Primitive,
    count: usize,
    joints: &[DMat4],
) -> Result<Vec<DMat4>> {
    let attribute =
        |semantic: Semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
    let mut sums = vec![(DMat4::ZERO, 0.0); count];
    for set in 0.. {
        let (Some(numbers), Some(weights)) =
            (attribute(Semantic::Joints(set)), attribute(Semantic::Weights(set)))
        else {
            break;
        };
        let numbers: Vec<[f64; 4]> = file.attribute(Some(numbers), Purpose::Joints, count)?;
        let weights: Vec<[f64; 4]> = file.attribute(Some(weights), Purpose::Weights, count)?;
        let pairs = numbers.as_flattened().iter().zip(weights.as_flattened());
        for (place, (&number, &weight)) in
            pairs.enumerate().filter(|(_, (_, weight))| **weight > 0.0)
        {
            let joint = joints.get(number as usize).ok_or_else(|| {
                let there = joints.len();
                file.fail(format!("vertices hang on joint {number} of a skin of {there}"))
            })?;
            let (sum, whole) = &mut sums[place / 4];
            (*sum, *whole) = (*sum + *joint * weight, *whole + weight);
        }
    }
    if sums.iter().any(|(_, whole)| *whole <= 0.0) {
        return Err(file.fail("a vertex of a skinned mesh hangs on no joint: its weights are 0"));
    }
    Ok(sums.into_iter().map(|(sum, whole)| sum * (1.0 / whole)).collect())
}

/// The matrix that carries cross products along with `matrix`, up to the sign of its determinant.
fn cofactors(matrix: DMat3) -> DMat3 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let sign = if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
    sign * DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_stay_across_their_plane_under_any_scale() {
        let matrix = DMat3::from_diagonal(DVec3::new(-1.0, 4.0, 0.5));
        let (u, v) = (DVec3::new(1.0, 2.0, 0.0), DVec3::new(0.0, 1.0, 3.0));
        let placed = cofactors(matrix) * u.cross(v);
        assert!(placed.dot(matrix * u).abs() < 1e-12 && placed.dot(matrix * v).abs() < 1e-12);
    }
}
