//! Joins coplanar neighbours of one look into planar polygons, holes and all.

use std::collections::{HashMap, HashSet};

use glam::{DAffine2, DMat2, DVec2, DVec3};
use rayon::prelude::*;

use super::tint::{Tint, Widest};
use crate::geometry::Plane;
use crate::geometry::polygon::{Ring, area};
use crate::scene::{Face, Scene};

/// A planar region: the faces it was joined from and its outline.
pub(super) struct PlanarRegion {
    pub(super) plane: Plane,
    /// Indices into [`Scene::faces`].
    pub(super) faces: Vec<usize>,
    /// Outer ring first, counter-clockwise; holes clockwise.
    pub(super) rings: Vec<Ring>,
    pub(super) attributes: Attributes,
    /// Unit normals of the curved surface that it stands for, one a corner of the outer ring; empty if flat.
    pub(super) normals: Vec<DVec3>,
}

/// How what the corners of faces carry continues over their plane.
#[derive(Clone, Copy)]
pub(super) struct Attributes {
    /// From plane coordinates to texture coordinates.
    pub(super) uv: Option<DAffine2>,
    pub(super) tint: Tint,
}

impl Attributes {
    fn of(scene: &Scene, plane: &Plane, face: &Face) -> Self {
        let corners = face.corners(&scene.positions);
        let places: Vec<DVec2> = corners.into_iter().map(|p| plane.flatten(p)).collect();
        let widest = Widest::of(&places);
        Self {
            uv: widest.and_then(|corner| uv_map(&corner, &places, face)),
            tint: Tint::of(face, widest.as_ref(), &places),
        }
    }

    /// True if others say the same at a place of the plane.
    fn are_like(&self, others: &Self, place: DVec2) -> bool {
        let same_picture = match (self.uv, others.uv) {
            (None, None) => true,
            (Some(a), Some(b)) => {
                (a.matrix2 - b.matrix2).abs_diff_eq(DMat2::ZERO, 1e-4)
                    && a.transform_point2(place).distance(b.transform_point2(place)) < 1e-4
            }
            _ => false,
        };
        same_picture && self.tint.is_like(&others.tint, place)
    }
}

/// The face that a region grows from.
struct Seed<'a> {
    face: &'a Face,
    plane: Plane,
    attributes: Attributes,
}

impl<'a> Seed<'a> {
    fn new(scene: &'a Scene, index: usize) -> Self {
        let face = &scene.faces[index];
        let plane = plane_of(scene, face);
        Self { face, plane, attributes: Attributes::of(scene, &plane, face) }
    }

    /// True if another face may be of its region. Facets of a curved surface stay apart: each has
    /// its own light.
    fn continues_in(&self, scene: &Scene, other: &Face, epsilon: f64) -> bool {
        let corners = other.corners(&scene.positions);
        self.face.material == other.material
            && self.face.normals.is_empty()
            && other.normals.is_empty()
            && plane_of(scene, other).normal.dot(self.plane.normal) > 0.5
            && corners.iter().all(|&p| self.plane.height(p).abs() <= epsilon)
            && self.goes_on_over(scene, other)
    }

    /// True if what its corners carry goes on over another face.
    fn goes_on_over(&self, scene: &Scene, other: &Face) -> bool {
        let theirs = Attributes::of(scene, &self.plane, other);
        let mut corners = other.corners(&scene.positions).into_iter();
        corners.all(|p| self.attributes.are_like(&theirs, self.plane.flatten(p)))
    }
}

/// The regions of a scene, in the order of their first faces.
pub(super) fn regions(scene: &Scene, epsilon: f64) -> Vec<PlanarRegion> {
    let neighbours = Neighbours::new(scene);
    let mut taken = vec![false; scene.faces.len()];
    let mut regions = Vec::new();
    for first in 0..scene.faces.len() {
        if taken[first] {
            continue;
        }
        let seed = Seed::new(scene, first);
        let mut faces = vec![first];
        taken[first] = true;
        let mut next = 0;
        while next < faces.len() {
            for other in neighbours.of(scene, faces[next]) {
                if !taken[other] && seed.continues_in(scene, &scene.faces[other], epsilon) {
                    taken[other] = true;
                    faces.push(other);
                }
            }
            next += 1;
        }
        let mut rings = outline(scene, &seed.plane, &faces);
        let Seed { face, mut plane, mut attributes } = seed;
        if faces.len() > 1 {
            plane = aligned(&plane, &rings);
            attributes = Attributes::of(scene, &plane, face);
            rings = outline(scene, &plane, &faces);
        }
        let normals = normals_of(face);
        regions.push(PlanarRegion { plane, faces, rings, attributes, normals });
    }
    regions
}

/// Every face of a scene as a region of its own.
pub(super) fn single_faces(scene: &Scene) -> Vec<PlanarRegion> {
    let region = |(index, face): (usize, &Face)| {
        let plane = plane_of(scene, face);
        let attributes = Attributes::of(scene, &plane, face);
        let rings = outline(scene, &plane, &[index]);
        PlanarRegion { plane, faces: vec![index], rings, attributes, normals: normals_of(face) }
    };
    scene.faces.iter().enumerate().map(region).collect()
}

fn normals_of(face: &Face) -> Vec<DVec3> {
    face.normals.iter().map(|normal| normal.as_dvec3()).collect()
}

/// Directed edges and the faces that have them, in order.
struct Neighbours(Vec<([u32; 2], u32)>);

impl Neighbours {
    fn new(scene: &Scene) -> Self {
        let faces = scene.faces.iter().enumerate();
        let mut all: Vec<([u32; 2], u32)> = faces
            .flat_map(|(index, face)| edges(face).map(move |edge| (edge, index as u32)))
            .collect();
        all.par_sort_unstable();
        Self(all)
    }

    /// Faces that share an edge with this one, running along it the other way.
    fn of<'a>(&'a self, scene: &'a Scene, face: usize) -> impl Iterator<Item = usize> + 'a {
        edges(&scene.faces[face]).flat_map(|[a, b]| {
            let first = self.0.partition_point(|(edge, _)| *edge < [b, a]);
            let same = self.0[first..].iter().take_while(move |(edge, _)| *edge == [b, a]);
            same.map(|(_, face)| *face as usize)
        })
    }
}

fn edges(face: &Face) -> impl Iterator<Item = [u32; 2]> + '_ {
    let next = face.vertices.iter().cycle().skip(1);
    face.vertices.iter().zip(next).map(|(&a, &b)| [a, b])
}

/// Best plane of a face (Newell's normal), its first axis along the longest edge.
fn plane_of(scene: &Scene, face: &Face) -> Plane {
    let at = |v: u32| scene.positions[v as usize];
    let origin = at(face.vertices[0]);
    let normal: DVec3 = edges(face).map(|[a, b]| (at(a) - origin).cross(at(b) - origin)).sum();
    let along = || edges(face).map(|[a, b]| at(b) - at(a));
    let longest = along().map(DVec3::length).fold(0.0, f64::max);
    // Rounding must not decide between edges of equal length.
    let first = along().find(|edge| edge.length() >= longest * (1.0 - 1e-6));
    Plane::new(origin, normal.normalize_or(DVec3::Y), first.unwrap_or(DVec3::X))
}

/// A plane with its first axis along the edge of an outline that most of the outline runs along or across: elements
/// are to follow it, and of a wall of two triangles the longest edge is the diagonal.
fn aligned(plane: &Plane, rings: &[Ring]) -> Plane {
    const DEGREES: usize = 90;
    let along = rings
        .iter()
        .flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| b - a));
    let longest = |edges: &mut dyn Iterator<Item = DVec2>| {
        // Rounding must not decide between edges of equal length.
        let longer = |best: DVec2, edge: DVec2| {
            if edge.length() > best.length() * (1.0 + 1e-6) { edge } else { best }
        };
        edges.fold(DVec2::ZERO, longer)
    };
    let reference = longest(&mut along.clone());
    let bin = |edge: DVec2| {
        let quarter = reference.angle_to(edge).to_degrees().rem_euclid(DEGREES as f64);
        (quarter + 0.5) as usize % DEGREES
    };
    let mut lengths = [0.0; DEGREES];
    along.clone().for_each(|edge| lengths[bin(edge)] += edge.length());
    let most = (0..DEGREES).rev().max_by(|&a, &b| lengths[a].total_cmp(&lengths[b])).unwrap_or(0);
    let first = longest(&mut along.filter(|&edge| bin(edge) == most));
    Plane::new(plane.origin, plane.normal, plane.lift(first) - plane.origin)
}

/// The affine map from plane to texture coordinates, by the widest corner of the face.
fn uv_map(widest: &Widest, places: &[DVec2], face: &Face) -> Option<DAffine2> {
    let (at, [next, last]) = (*face.uvs.get(widest.corner)?, widest.neighbours(face.uvs.len()));
    let matrix = DMat2::from_cols(face.uvs[next] - at, face.uvs[last] - at) * widest.inverse;
    let map = DAffine2::from_mat2_translation(matrix, at - matrix * places[widest.corner]);
    map.is_finite().then_some(map)
}

/// Rings of the edges that only one of the faces has.
fn outline(scene: &Scene, plane: &Plane, faces: &[usize]) -> Vec<Ring> {
    if let &[face] = faces
        && scene.faces[face].vertices.len() == 3
    {
        // Most faces of large scenes are facets by themselves.
        let corners = scene.faces[face].corners(&scene.positions);
        return vec![corners.into_iter().map(|p| plane.flatten(p)).collect()];
    }
    let mut follow: HashMap<u32, Vec<u32>> = HashMap::new();
    let mut starts = Vec::new();
    let all: HashSet<[u32; 2]> = faces.iter().flat_map(|&f| edges(&scene.faces[f])).collect();
    for [a, b] in faces.iter().flat_map(|&f| edges(&scene.faces[f])) {
        if !all.contains(&[b, a]) {
            follow.entry(a).or_default().push(b);
            starts.push(a);
        }
    }
    let mut rings = Vec::new();
    for start in starts {
        let mut ring = Ring::new();
        let mut at = start;
        while let Some(next) = follow.get_mut(&at).and_then(Vec::pop) {
            ring.push(plane.flatten(scene.positions[at as usize]));
            at = next;
        }
        if ring.len() >= 3 {
            rings.push(ring);
        }
    }
    rings.iter_mut().for_each(Ring::shrink_to_fit);
    rings.shrink_to_fit();
    rings.sort_by(|a, b| area(b).total_cmp(&area(a)));
    rings
}
