//! Triangles of a mesh, placed in the world.

use ::gltf::json::accessor::Type;
use ::gltf::json::material::AlphaMode;
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, accessor::Accessor};
use glam::{DVec2, DVec3, Vec3};
use smallvec::SmallVec;

use super::accessors::Purpose;
use super::import::GltfImport;
use super::pose::{Placement, Pose};
use crate::error::Result;
use crate::scene::limits::tamed;
use crate::scene::{Face, MaterialId};

/// A primitive's vertices in the world; lists other than `positions` may be empty.
struct Vertices {
    positions: Vec<DVec3>,
    normals: Vec<Vec3>,
    uvs: Vec<DVec2>,
    colours: Vec<Vec3>,
    pose: Pose,
}

impl GltfImport<'_> {
    /// Adds the triangles of `primitive`.
    pub(super) fn add_primitive(
        &mut self,
        primitive: &Primitive,
        placement: Placement<'_>,
    ) -> Result<()> {
        let mode = match &primitive.mode {
            Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => {
                *mode
            }
            Checked::Valid(_) => {
                self.skipped.loose += 1;
                return Ok(());
            }
            Checked::Invalid => return Err(self.file.fail("a primitive of unknown mode")),
        };
        let material = self.material(primitive)?;
        let vertices = self.vertices(primitive, material, placement)?;
        let count = vertices.positions.len();
        let indices = match primitive.indices {
            Some(index) => self.file.indices(index)?,
            None => (0..count as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|&&index| index as usize >= count) {
            return Err(self
                .file
                .fail(format!("vertex {index} is used, but there are only {count}")));
        }
        let base = self.scene.positions.len();
        if base + count > u32::MAX as usize {
            return Err(self.file.fail("more vertices than 32 bits can count"));
        }
        self.scene.positions.extend(&vertices.positions);
        for mut triangle in triangles(&indices, mode) {
            if vertices.pose.mirrors(triangle[0]) {
                triangle.swap(1, 2);
            }
            let mut face = vertices.face(triangle, base as u32);
            (face.material, face.object) = (material, placement.object);
            self.scene.faces.push(face);
        }
        Ok(())
    }

    fn material(&mut self, primitive: &Primitive) -> Result<MaterialId> {
        match primitive.material {
            Some(index) => {
                self.file.get(index, "material")?;
                Ok(MaterialId(index.value() as u32))
            }
            None => Ok(self.fallback_material()),
        }
    }

    /// Whether the colours of a primitive's vertices say that light comes through, and are meant to.
    fn lets_through(
        &self,
        primitive: &Primitive,
        colours: Option<Index<Accessor>>,
    ) -> Result<bool> {
        let material = primitive.material.and_then(|index| self.file.root.get(index));
        let (Some(material), Some(colours)) = (material, colours) else { return Ok(false) };
        let has_alpha = self.file.get(colours, "accessor")?.type_ == Checked::Valid(Type::Vec4);
        if material.alpha_mode == Checked::Valid(AlphaMode::Opaque) || !has_alpha {
            return Ok(false);
        }
        let colours = self.file.floats(colours, Purpose::Colour)?;
        Ok(colours.iter().any(|&[_, _, _, alpha]| alpha < 1.0))
    }

    fn vertices(
        &mut self,
        primitive: &Primitive,
        material: MaterialId,
        placement: Placement<'_>,
    ) -> Result<Vertices> {
        let attribute =
            |semantic: Semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let mapping = self.mappings[material.index()];
        let points: Vec<[f64; 3]> = match attribute(Semantic::Positions) {
            Some(index) => self.file.floats(index, Purpose::Position)?,
            None => return Err(self.file.fail("a primitive without POSITION")),
        };
        let expected = points.len();
        let normals = attribute(Semantic::Normals);
        let normals = self.file.attribute(normals, Purpose::Normal, expected)?;
        let [mut points, mut normals] =
            [points, normals].map(|list| list.into_iter().map(DVec3::from).collect::<Vec<_>>());
        self.file.morph(primitive, placement.weights, [&mut points, &mut normals])?;
        let pose = Pose::of(self.file, primitive, expected, placement)?;
        let uvs = attribute(Semantic::TexCoords(mapping.set));
        let uvs = self.file.attribute(uvs, Purpose::TexCoord, expected)?;
        let colours = attribute(Semantic::Colors(0));
        self.skipped.alphas += usize::from(self.lets_through(primitive, colours)?);
        let colours = self.file.attribute(colours, Purpose::Colour, expected)?;
        let tint = |colour: [f64; 3]| tamed(colour.into(), 1.0).as_vec3();
        Ok(Vertices {
            positions: pose.placed(points),
            normals: pose.turned(normals),
            uvs: uvs.into_iter().map(|uv: [f64; 2]| mapping.apply(uv.into())).collect(),
            colours: colours.into_iter().map(tint).collect(),
            pose,
        })
    }
}

impl Vertices {
    fn face(&self, triangle: [u32; 3], base: u32) -> Face {
        let corners = triangle.map(|corner| corner as usize);
        Face {
            vertices: triangle.iter().map(|corner| base + corner).collect(),
            normals: picked(&self.normals, corners),
            uvs: picked(&self.uvs, corners),
            tints: picked(&self.colours, corners),
            ..Face::default()
        }
    }
}

fn picked<T: Copy>(list: &[T], corners: [usize; 3]) -> SmallVec<[T; 4]> {
    corners.iter().filter_map(|&corner| list.get(corner).copied()).collect()
}

/// Index triples of the triangles, counter-clockwise; left-over indices are ignored as the format wants.
fn triangles(indices: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => (indices.windows(3).enumerate())
            .map(|(at, w)| if at % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] })
            .collect(),
        Mode::TriangleFan => match indices {
            [hub, rim @ ..] => rim.windows(2).map(|w| [*hub, w[0], w[1]]).collect(),
            [] => Vec::new(),
        },
        _ => indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_the_winding_of_their_first_triangle() {
        let indices = [0, 1, 2, 3, 4];
        assert_eq!(triangles(&indices, Mode::TriangleStrip), [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
        assert_eq!(triangles(&indices, Mode::TriangleFan), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        assert_eq!(triangles(&indices, Mode::Triangles), [[0, 1, 2]]);
        assert!(triangles(&[], Mode::TriangleFan).is_empty());
    }
}
