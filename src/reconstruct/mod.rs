//! Radiosity at vertices, on a triangulation without T-junctions.
//!
//! Every leaf is outlined with all the places that lie on its edges, its own or another's; so
//! neighbours agree on their border, within a surface and where surfaces meet. Light is shared by
//! leaves that share a vertex of the mesh, which those on two sides of a contact line do not.

mod angles;
mod by_light;
mod dimming;
mod fit;
mod glow;
mod normal;
mod sheet;
mod smooth;
mod stitch;
mod triangulate;
mod trimesh;

use rayon::prelude::*;

use crate::mesh::{ElementId, Mesh, VertexId};
use crate::solver::Solution;
use crate::surface::{Surfaces, Weld};

pub use angles::Angles;
pub use by_light::{LightShare, reconstruct_by_light};
pub use dimming::Dimming;
pub use glow::mesh_pictures;
pub use trimesh::{Irradiance, Part, TriMesh};

pub(crate) use normal::normal_at;
pub(crate) use stitch::Places;
pub(crate) use triangulate::triangulate;

use glow::Glow;
use sheet::Sheet;

/// What is nearer than so many tolerances is one place: no two vertices of a mesh are, but those of one place.
pub(crate) const ONE_PLACE: f64 = 10.0;

/// Places less than so many tolerances from an edge are on it: more than vertices are moved to meet others.
pub(crate) const ON_EDGE: f64 = 30.0;

/// The triangle mesh of a solution.
pub fn reconstruct(surfaces: &Surfaces, solution: &Solution) -> TriMesh {
    reconstruct_for(Lamps::Fixed, surfaces, solution)
}

/// Whether the lamps of a mesh may be dimmed afterwards: their light must not be part of a picture then.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lamps {
    Fixed,
    Dimmable,
}

fn reconstruct_for(lamps: Lamps, surfaces: &Surfaces, solution: &Solution) -> TriMesh {
    let mesh = &solution.mesh;
    let leaves = leaves_by_surface(surfaces, mesh);
    let mut weld = Weld::new(ONE_PLACE * surfaces.tolerance);
    let outlines: Vec<Vec<Vec<u32>>> = leaves
        .iter()
        .enumerate()
        .map(|(surface, leaves)| {
            let plane = &surfaces.list[surface].plane;
            let place = |v: VertexId| plane.lift(mesh[v].position);
            let outline = |&leaf: &ElementId| {
                mesh[leaf].corners.iter().map(|v| weld.number(place(*v))).collect()
            };
            leaves.iter().map(outline).collect()
        })
        .collect();
    let places = Places::new(&weld, surfaces.extent, ON_EDGE * surfaces.tolerance);
    let mut sheets: Vec<Sheet> = (0..leaves.len())
        .into_par_iter()
        .map(|surface| {
            Sheet::new(
                (surfaces, solution),
                &places,
                surface,
                (&leaves[surface], &outlines[surface]),
            )
        })
        .collect();
    smooth::average_across_smooth_edges(&mut sheets);
    assemble(surfaces, &places, &sheets, lamps)
}

fn leaves_by_surface(surfaces: &Surfaces, mesh: &Mesh) -> Vec<Vec<ElementId>> {
    let mut leaves = vec![Vec::new(); surfaces.list.len()];
    for leaf in mesh.leaves() {
        leaves[mesh.surface_of(leaf)].push(leaf);
    }
    leaves
}

/// Joins the sheets, material by material.
fn assemble(surfaces: &Surfaces, places: &Places, sheets: &[Sheet], lamps: Lamps) -> TriMesh {
    let mut hanging: Vec<u32> = sheets.iter().flat_map(|sheet| &sheet.hanging).copied().collect();
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
    for (number, material) in surfaces.materials.iter().enumerate() {
        let first = mesh.parts.len();
        let fixed = (lamps == Lamps::Fixed).then_some(number as u32);
        let glow = fixed.and_then(|number| Glow::of_material(surfaces, number, sheets));
        let texture = match &glow {
            Some(glow) => Some(glow.added_to(&mut mesh.textures)),
            None => material.texture,
        };
        for (surface, sheet) in surfaces.list.iter().zip(sheets) {
            if surface.material as usize == number {
                let start = mesh.triangles.len();
                append(&mut mesh, places, sheet, glow.as_ref());
                let (object, end) = (Some(surface.object), mesh.triangles.len());
                match mesh.parts[first..].last_mut().filter(|part| part.object == object) {
                    Some(part) => part.triangles.end = end,
                    None => mesh.parts.push(Part {
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

/// Adds the corners and triangles of a sheet.
fn append(mesh: &mut TriMesh, places: &Places, sheet: &Sheet, glow: Option<&Glow>) {
    let base = mesh.positions.len() as u32;
    for corner in &sheet.corners {
        mesh.positions.push(places.at(corner.place));
        mesh.normals.push(corner.normal.as_vec3());
        mesh.uvs.push(corner.uv.as_vec2());
        mesh.radiosity.push(corner.radiosity);
        mesh.texture_mean.push(glow.map_or(corner.texture_mean, |glow| glow.mean(corner)));
        mesh.irradiance.push(corner.irradiance);
    }
    mesh.triangles.extend(sheet.triangles.iter().map(|t| t.map(|corner| base + corner)));
    mesh.leaves.extend_from_slice(&sheet.leaves);
}
