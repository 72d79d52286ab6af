//! The triangles of all surfaces, joined where surfaces meet and sorted by material.

use rayon::prelude::*;

use super::edge_vertices::Places;
use super::glow::Glow;
use super::smooth;
use super::surface_triangles::{OutlinedLeaves, SurfaceTriangles};
use super::trimesh::{MeshPart, TriMesh};
use crate::geometry::Weld;
use crate::mesh::{ElementId, Mesh, VertexId};
use crate::scene::MaterialId;
use crate::solver::Solution;
use crate::surface::Surfaces;

/// What is nearer than so many tolerances is one place: no two vertices of a mesh are, but those of one place.
const ONE_PLACE: f64 = 10.0;

/// Places less than so many tolerances from an edge are on it: more than vertices are moved to meet others.
const ON_EDGE: f64 = 30.0;

/// Whether the lamps of a mesh may be dimmed afterwards: their light must not be part of a picture then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum EmitterStrength {
    Fixed,
    Dimmable,
}

/// The triangle mesh of a solution, its lamps used like that.
pub(super) fn reconstruct_for(
    lamps: EmitterStrength,
    surfaces: &Surfaces,
    solution: &Solution,
) -> TriMesh {
    let mesh = &solution.mesh;
    let mut weld = Weld::new(ONE_PLACE * surfaces.epsilon);
    let outlined = outlined_leaves(surfaces, mesh, &mut weld);
    let places = Places::new(&weld, surfaces.extent, ON_EDGE * surfaces.epsilon);
    let mut all: Vec<SurfaceTriangles> = outlined
        .par_iter()
        .zip(&surfaces.list)
        .map(|(leaves, surface)| {
            SurfaceTriangles::new(surfaces, surface, solution, &places, leaves)
        })
        .collect();
    smooth::average_across_smooth_edges(&mut all);
    assemble(surfaces, &places, &all, lamps)
}

/// Surface by surface, the leaves with their outlines.
fn outlined_leaves(surfaces: &Surfaces, mesh: &Mesh, weld: &mut Weld) -> Vec<OutlinedLeaves> {
    let by_surface = leaves_by_surface(surfaces, mesh).into_iter().zip(&surfaces.list);
    let outlined = by_surface.map(|(leaves, surface)| {
        let place = |v: VertexId| surface.plane.lift(mesh[v].position);
        let outline =
            |&leaf: &ElementId| mesh[leaf].corners.iter().map(|v| weld.number(place(*v))).collect();
        let outlines = leaves.iter().map(outline).collect();
        OutlinedLeaves { leaves, outlines }
    });
    outlined.collect()
}

fn leaves_by_surface(surfaces: &Surfaces, mesh: &Mesh) -> Vec<Vec<ElementId>> {
    let mut leaves = vec![Vec::new(); surfaces.list.len()];
    for leaf in mesh.leaves() {
        leaves[mesh.surface_of(leaf).index()].push(leaf);
    }
    leaves
}

/// Joins the triangles of the surfaces, material by material.
fn assemble(
    surfaces: &Surfaces,
    places: &Places,
    all: &[SurfaceTriangles],
    lamps: EmitterStrength,
) -> TriMesh {
    let mut hanging: Vec<u32> = all.iter().flat_map(|own| &own.hanging).copied().collect();
    hanging.sort_unstable();
    hanging.dedup();
    let mut mesh = TriMesh {
        hanging: hanging.len(),
        textures: surfaces.textures.clone(),
        objects: surfaces.objects.clone(),
        nodes: surfaces.nodes.clone(),
        cameras: surfaces.cameras.clone(),
        ..TriMesh::default()
    };
    for (id, material) in (0..).map(MaterialId).zip(&surfaces.materials) {
        let first = mesh.parts.len();
        let fixed = (lamps == EmitterStrength::Fixed).then_some(id);
        let glow = fixed.and_then(|id| Glow::of_material(surfaces, id, all));
        let texture = match &glow {
            Some(glow) => Some(glow.added_to(&mut mesh.textures)),
            None => material.texture,
        };
        for (surface, own) in surfaces.list.iter().zip(all) {
            if surface.material == id {
                let start = mesh.triangles.len();
                append(&mut mesh, places, own, glow.as_ref());
                let (object, end) = (Some(surface.object), mesh.triangles.len());
                match mesh.parts[first..].last_mut().filter(|part| part.object == object) {
                    Some(part) => part.triangles.end = end,
                    None => mesh.parts.push(MeshPart {
                        name: material.name.clone(),
                        triangles: start..end,
                        texture,
                        cutoff: material.cutoff,
                        object,
                    }),
                }
            }
        }
    }
    mesh.parts.retain(|part| !part.triangles.is_empty());
    mesh
}

/// Adds the corners and triangles of a surface.
fn append(mesh: &mut TriMesh, places: &Places, own: &SurfaceTriangles, glow: Option<&Glow>) {
    let base = mesh.positions.len() as u32;
    for corner in &own.corners {
        mesh.positions.push(places.at(corner.place));
        mesh.normals.push(corner.normal.as_vec3());
        mesh.uvs.push(corner.uv.as_vec2());
        mesh.radiosity.push(corner.radiosity);
        mesh.texture_mean.push(glow.map_or(corner.texture_mean, |glow| glow.mean(corner)));
        mesh.irradiance.push(corner.irradiance);
    }
    mesh.triangles.extend(own.triangles.iter().map(|t| t.map(|corner| base + corner)));
    mesh.leaves.extend_from_slice(&own.leaves);
}
