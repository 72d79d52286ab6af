//! Which surfaces share a chart: facets of a curved one, as far as they can be flattened.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::coarse::TriangulatedSurface;
use super::overlap::{FlatTriangle, overlap};
use crate::geometry::Plane;
use crate::reconstruct::normal_at;
use crate::surface::{Surface, Surfaces};

/// Least cosine between the normals of a chart and of its facets: a facet loses at most a third of its texels
/// by projection, and a sphere takes about a dozen charts.
const CONE: f64 = 0.67;

/// Unit normals whose difference is no longer than this are one, as where facets share their light.
const SAME: f64 = 1e-2;

/// A facet's edge.
struct FacetEdge {
    /// From place to place.
    ends: [u32; 2],
    /// The facet's unit normals there.
    normals: [DVec3; 2],
}

/// All surfaces in groups, each of which can be laid flat on the plane of its first.
pub(super) fn groups(surfaces: &Surfaces, triangulated: &[TriangulatedSurface]) -> Vec<Vec<u32>> {
    let facets =
        FacetGraph { surfaces, triangulated, neighbours: neighbours(surfaces, triangulated) };
    let mut is_taken = vec![false; surfaces.list.len()];
    let mut groups = Vec::new();
    for seed in 0..surfaces.list.len() {
        if !is_taken[seed] {
            let group = facets.grow(&is_taken, seed);
            group.iter().for_each(|&surface| is_taken[surface as usize] = true);
            groups.push(group);
        }
    }
    groups
}

/// All surfaces, and which of them each joins smoothly.
struct FacetGraph<'a> {
    surfaces: &'a Surfaces,
    triangulated: &'a [TriangulatedSurface],
    neighbours: Vec<Vec<u32>>,
}

impl FacetGraph<'_> {
    /// The facets around `seed` that are still free, nearest first, as long as they look its way and do not
    /// cover each other.
    fn grow(&self, is_taken: &[bool], seed: usize) -> Vec<u32> {
        let Self { surfaces, triangulated, neighbours } = self;
        let plane = surfaces.list[seed].plane;
        let mut group = vec![seed as u32];
        let mut laid = flattened(&plane, &triangulated[seed]);
        let mut seen = HashSet::from([seed as u32]);
        let mut next = 0;
        while let Some(&facet) = group.get(next) {
            next += 1;
            for &other in &neighbours[facet as usize] {
                if is_taken[other as usize] || !seen.insert(other) {
                    continue;
                }
                let normal = surfaces.list[other as usize].plane.normal;
                let triangles = flattened(&plane, &triangulated[other as usize]);
                let covers = |laid: &FlatTriangle| {
                    triangles.iter().any(|triangle| overlap(triangle, laid, surfaces.epsilon))
                };
                if normal.dot(plane.normal) >= CONE && !laid.iter().any(covers) {
                    laid.extend(triangles);
                    group.push(other);
                }
            }
        }
        group
    }
}

fn flattened(plane: &Plane, triangulated_surface: &TriangulatedSurface) -> Vec<FlatTriangle> {
    triangulated_surface
        .triangles
        .iter()
        .map(|corners| corners.map(|corner| plane.flatten(corner.position)))
        .collect()
}

/// The curved facets that each joins smoothly along an edge.
fn neighbours(surfaces: &Surfaces, triangulated: &[TriangulatedSurface]) -> Vec<Vec<u32>> {
    let facets: Vec<(u32, Vec<FacetEdge>)> = surfaces
        .list
        .iter()
        .zip(triangulated)
        .enumerate()
        .filter(|(_, (surface, triangulated_surface))| {
            !surface.normals.is_empty() && triangulated_surface.rings.len() == 1
        })
        .map(|(number, (surface, triangulated_surface))| {
            (number as u32, edges(surface, triangulated_surface))
        })
        .collect();
    let mut owners: HashMap<[u32; 2], Vec<(u32, [DVec3; 2])>> = HashMap::new();
    for (facet, edges) in &facets {
        for edge in edges {
            owners.entry(edge.ends).or_default().push((*facet, edge.normals));
        }
    }
    let mut neighbours = vec![Vec::new(); surfaces.list.len()];
    for (facet, edges) in &facets {
        for FacetEdge { ends: [from, to], normals: [at_from, at_to] } in edges {
            let others = owners.get(&[*to, *from]).into_iter().flatten();
            let joins = |[to, from]: [DVec3; 2]| {
                from.distance(*at_from) <= SAME && to.distance(*at_to) <= SAME
            };
            let alike = others.filter(|(_, normals)| joins(*normals)).map(|&(other, _)| other);
            neighbours[*facet as usize].extend(alike);
        }
    }
    neighbours
}

/// A facet's edges, with its normals at their ends.
fn edges(surface: &Surface, triangulated_surface: &TriangulatedSurface) -> Vec<FacetEdge> {
    let normal = |place: DVec3| normal_at(surface, surface.plane.flatten(place));
    let ring = &triangulated_surface.rings[0];
    let ends = ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&from, &to)| [from, to]);
    ends.zip(triangulated_surface.edges())
        .map(|(ends, places)| FacetEdge { ends, normals: places.map(normal) })
        .collect()
}
