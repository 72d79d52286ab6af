//! Surfaces triangulated as coarsely as their outlines allow, without T-junctions.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::geometry::Weld;
use crate::reconstruct::{Places, normal_at, triangulate};
use crate::scene::MaterialId;
use crate::surface::{Surface, Surfaces};

/// A triangle mesh that has its light in a picture; all per-vertex lists are as long as `positions`.
#[derive(Clone, Debug, Default)]
pub struct CoarseMesh {
    /// Vertex positions, m.
    pub positions: Vec<DVec3>,
    /// Unit normals: of the surface, or of the curved surface it approximates.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, zero where a part has no texture.
    pub uvs: Vec<Vec2>,
    /// Factors on the material's reflectance by the colours of vertices, 0..=1.
    pub tints: Vec<Vec3>,
    /// Coordinates in the atlas, 0..=1 from the left and the top.
    pub light_uvs: Vec<Vec2>,
    /// Corners, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Consecutive runs of triangles; together they are all triangles.
    pub parts: Vec<CoarsePart>,
}

/// A run of triangles of one material.
#[derive(Clone, Debug)]
pub struct CoarsePart {
    /// Its material.
    pub material: MaterialId,
    /// Range of indices into [`CoarseMesh::triangles`].
    pub triangles: Range<usize>,
}

/// A triangulated surface.
#[derive(Debug)]
pub(super) struct TriangulatedSurface {
    /// Numbers of places around the outer ring and the holes, those that others have on it included.
    pub(super) rings: Vec<Vec<u32>>,
    /// The places of the rings, m, in the same order.
    at: Vec<Vec<DVec3>>,
    /// Counter-clockwise.
    pub(super) triangles: Vec<[SurfaceCorner; 3]>,
}

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceCorner {
    /// The number of its place.
    place: u32,
    /// m.
    pub(super) position: DVec3,
}

impl TriangulatedSurface {
    /// The edges of its rings, m.
    pub(super) fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        self.at.iter().flat_map(|ring| {
            ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&from, &to)| [from, to])
        })
    }
}

/// Triangulates every surface; neighbours agree on their border.
pub(super) fn triangulated(surfaces: &Surfaces) -> Vec<TriangulatedSurface> {
    let mut weld = Weld::new(surfaces.epsilon);
    let number = |surface: &Surface| -> Vec<Vec<u32>> {
        let ring = |ring: &Vec<DVec2>| {
            let mut numbers: Vec<u32> =
                ring.iter().map(|&p| weld.number(surface.plane.lift(p))).collect();
            numbers.dedup();
            while numbers.len() > 1 && numbers.first() == numbers.last() {
                numbers.pop();
            }
            numbers
        };
        surface.rings.iter().map(ring).filter(|ring| ring.len() > 2).collect()
    };
    let rings: Vec<Vec<Vec<u32>>> = surfaces.list.iter().map(number).collect();
    let places = Places::new(&weld, surfaces.extent, surfaces.epsilon);
    surfaces
        .list
        .iter()
        .zip(rings)
        .map(|(surface, rings)| triangulated_surface(surface, &places, rings))
        .collect()
}

fn triangulated_surface(
    surface: &Surface,
    places: &Places,
    rings: Vec<Vec<u32>>,
) -> TriangulatedSurface {
    let stitched = |ring: Vec<u32>| -> Vec<u32> {
        let next = ring.iter().cycle().skip(1);
        let edges = ring.iter().zip(next);
        edges
            .flat_map(|(&from, &to)| {
                [from].into_iter().chain(places.between(from, to)).collect::<Vec<u32>>()
            })
            .collect()
    };
    let rings: Vec<Vec<u32>> = rings.into_iter().map(stitched).collect();
    let tiles = triangulate(&rings, |place| surface.plane.flatten(places.at(place)));
    let at = |&place: &u32| places.at(place);
    let corner = |place: u32| SurfaceCorner { place, position: places.at(place) };
    TriangulatedSurface {
        triangles: tiles.iter().map(|tile| tile.corners.map(corner)).collect(),
        at: rings.iter().map(|ring| ring.iter().map(at).collect()).collect(),
        rings,
    }
}

/// Bits by which equal numbers are known.
type Bits<const N: usize> = [u32; N];

impl CoarseMesh {
    /// Joins sheets, material by material; `light_uv` says where in the atlas a place of a surface is.
    pub(super) fn new(
        surfaces: &Surfaces,
        triangulated: &[TriangulatedSurface],
        light_uv: impl Fn(usize, DVec3) -> DVec2,
    ) -> Self {
        let mut mesh = Self::default();
        for (material, members) in by_material(surfaces) {
            let first = mesh.triangles.len();
            let mut known: BTreeMap<(u32, Bits<10>), u32> = BTreeMap::new();
            for number in members {
                let surface = &surfaces.list[number];
                for triangle in &triangulated[number].triangles {
                    let corners = triangle.map(|corner| {
                        let light_uv = light_uv(number, corner.position).as_vec2();
                        mesh.vertex(&mut known, surface, corner, light_uv)
                    });
                    mesh.triangles.push(corners);
                }
            }
            let triangles = first..mesh.triangles.len();
            if !triangles.is_empty() {
                mesh.parts.push(CoarsePart { material, triangles });
            }
        }
        mesh
    }

    /// The vertex of a surface at a place, a new one unless facets that join smoothly there have made it.
    fn vertex(
        &mut self,
        known: &mut BTreeMap<(u32, Bits<10>), u32>,
        surface: &Surface,
        SurfaceCorner { place, position }: SurfaceCorner,
        light_uv: Vec2,
    ) -> u32 {
        let on_plane = surface.plane.flatten(position);
        let normal = normal_at(surface, on_plane).as_vec3();
        let uv = surface.uv.map_or(DVec2::ZERO, |uv| uv.transform_point2(on_plane)).as_vec2();
        let tint = surface.tint.at(on_plane).as_vec3();
        let ([a, b, c], [d, e], [f, g]) = (normal.to_array(), uv.to_array(), light_uv.to_array());
        let bits = [a, b, c, d, e, f, g, tint.x, tint.y, tint.z].map(f32::to_bits);
        *known.entry((place, bits)).or_insert_with(|| {
            self.positions.push(position);
            self.normals.push(normal);
            self.uvs.push(uv);
            self.tints.push(tint);
            self.light_uvs.push(light_uv);
            self.positions.len() as u32 - 1
        })
    }
}

/// Surfaces by material, in the order in which these are first seen.
fn by_material(surfaces: &Surfaces) -> Vec<(MaterialId, Vec<usize>)> {
    let mut found: Vec<(MaterialId, Vec<usize>)> = Vec::new();
    let mut places = BTreeMap::new();
    for (number, surface) in surfaces.list.iter().enumerate() {
        let place = *places.entry(surface.material).or_insert_with(|| {
            found.push((surface.material, Vec::new()));
            found.len() - 1
        });
        found[place].1.push(number);
    }
    found
}
