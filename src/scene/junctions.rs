//! T-junctions: corners inside an edge of a neighbour, where a mesh would crack.

use std::collections::{HashMap, HashSet};

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use smallvec::SmallVec;

use super::notes::note_count;
use super::{Face, Scene};
use crate::geometry::boxes::{self, Tree, are_close};

/// Corners lie in an edge if they are no further from it than this share of its length: coordinates to the
/// millimetre are off by as much.
const ON_EDGE: f64 = 1e-4;

/// And than this share of the shortest edge that ends at the corner, so that thin things stay what they are.
const SHORTEST_EDGE: f64 = 1e-2;

/// What is nearer, as a share of the edge's length, need not be moved.
const EXACT: f64 = 1e-9;

/// Corners are moved onto edges whose ends may be moved, too.
const PASSES: usize = 3;

/// The edge that begins at a corner of a face.
#[derive(Clone, Copy, Debug)]
struct FaceEdge {
    face: usize,
    corner: usize,
}

impl FaceEdge {
    fn ends(self, scene: &Scene) -> [u32; 2] {
        let vertices = &scene.faces[self.face].vertices;
        [vertices[self.corner], vertices[(self.corner + 1) % vertices.len()]]
    }
}

/// A vertex in an edge.
#[derive(Clone, Copy, Debug)]
struct Junction {
    edge: FaceEdge,
    vertex: u32,
    /// How far along the edge, 0..1.
    share: f64,
    /// Distance from the edge, as a share of its length.
    apart: f64,
}

/// Moves corners that lie nearly in an open edge of a neighbour onto it, and makes them corners of the
/// neighbour, too.
///
/// An edge is open if no other face has it the other way round. A corner at which no open edge runs along
/// such an edge only touches it and is left alone.
pub(super) fn join(scene: &mut Scene) {
    let mut moved = HashSet::new();
    let mut found = find(scene);
    for _ in 0..PASSES {
        let off = found.iter().filter(|junction| junction.apart > EXACT);
        let off: Vec<Junction> = off.copied().collect();
        if off.is_empty() {
            break;
        }
        straighten(scene, off, &mut moved);
        found = find(scene);
    }
    found.retain(|junction| junction.apart <= EXACT);
    let vertices: HashSet<u32> = found.iter().map(|junction| junction.vertex).collect();
    insert(scene, found);
    let notes = &mut scene.notes;
    note_count(notes, moved.len(), "corner", "beside an edge of a neighbour moved onto it");
    note_count(notes, vertices.len(), "T-junction", "closed: the edge got the corner inside it");
}

/// Moves each vertex onto the nearest of its edges, unless an end of that has been moved before.
fn straighten(scene: &mut Scene, mut off: Vec<Junction>, moved: &mut HashSet<u32>) {
    off.sort_by(|a, b| (a.vertex, a.apart).partial_cmp(&(b.vertex, b.apart)).unwrap_or(EQUAL));
    off.dedup_by_key(|junction| junction.vertex);
    let mut now = HashSet::new();
    for junction in off {
        let ends = junction.edge.ends(scene);
        if ends.iter().all(|end| !now.contains(end)) {
            let [a, b] = ends.map(|end| scene.positions[end as usize]);
            scene.positions[junction.vertex as usize] = a.lerp(b, junction.share);
            now.insert(junction.vertex);
        }
    }
    moved.extend(now);
}

const EQUAL: std::cmp::Ordering = std::cmp::Ordering::Equal;

/// All junctions, those of a face in the order of its outline.
fn find(scene: &Scene) -> Vec<Junction> {
    let open = OpenEdges::new(scene);
    let of_edge = |near: &mut Vec<u32>, &edge: &FaceEdge| open.inside(scene, edge, near);
    open.edges.par_iter().map_init(Vec::new, of_edge).flatten_iter().collect()
}

/// The open edges of a scene.
struct OpenEdges {
    edges: Vec<FaceEdge>,
    /// What each vertex is joined to by open edges.
    joined: HashMap<u32, SmallVec<[u32; 4]>>,
    /// Length of the shortest of all edges at a vertex, m.
    shortest: Vec<f64>,
    /// The ends of open edges, and a tree over them.
    ends: Vec<u32>,
    tree: Tree,
}

impl OpenEdges {
    fn new(scene: &Scene) -> Self {
        let all_edges = || {
            let counts = scene.faces.iter().map(|face| face.vertices.len()).enumerate();
            counts.flat_map(|(face, n)| (0..n).map(move |corner| FaceEdge { face, corner }))
        };
        let all: HashSet<[u32; 2]> = all_edges().map(|edge| edge.ends(scene)).collect();
        let mut shortest = vec![f64::INFINITY; scene.positions.len()];
        let mut joined: HashMap<u32, SmallVec<[u32; 4]>> = HashMap::new();
        let mut edges = Vec::new();
        for edge in all_edges() {
            let [a, b] = edge.ends(scene);
            let length = scene.positions[a as usize].distance(scene.positions[b as usize]);
            for (one, other) in [(a, b), (b, a)] {
                shortest[one as usize] = shortest[one as usize].min(length);
                if !all.contains(&[b, a]) {
                    joined.entry(one).or_default().push(other);
                }
            }
            if !all.contains(&[b, a]) {
                edges.push(edge);
            }
        }
        let mut ends: Vec<u32> = joined.keys().copied().collect();
        ends.sort_unstable();
        let of_point = |&vertex: &u32| boxes::around([scene.positions[vertex as usize]]);
        let tree = Tree::new(ends.iter().map(of_point).collect());
        Self { edges, joined, shortest, ends, tree }
    }

    /// The vertices in an edge, in their order along it.
    fn inside(&self, scene: &Scene, edge: FaceEdge, near: &mut Vec<u32>) -> Vec<Junction> {
        let own = &scene.faces[edge.face];
        let at = |vertex: u32| scene.positions[vertex as usize];
        let [a, b] = edge.ends(scene).map(at);
        let length = a.distance(b);
        let around = boxes::around([a, b]).grown(ON_EDGE * length);
        self.tree.find(|bounds| are_close(around, bounds, 0.0), near);
        let junction = |&number: &u32| {
            let vertex = self.ends[number as usize];
            let p = at(vertex);
            if own.vertices.contains(&vertex) {
                return None;
            }
            let reach = (ON_EDGE * length).min(SHORTEST_EDGE * self.shortest[vertex as usize]);
            let direction = (b - a) / length;
            let (way, apart) = measured(p - a, direction);
            let runs_along =
                |&other: &u32| other != vertex && measured(at(other) - a, direction).1 <= reach;
            let inside = apart <= reach && way > reach && way < length - reach;
            let is_junction = inside && self.joined[&vertex].iter().any(runs_along);
            let (share, apart) = (way / length, apart / length);
            is_junction.then_some(Junction { edge, vertex, share, apart })
        };
        let mut found: Vec<Junction> = near.iter().filter_map(junction).collect();
        found.sort_by(|a, b| a.share.total_cmp(&b.share));
        found
    }
}

/// How far something is along a unit direction, and how far aside.
fn measured(offset: DVec3, direction: DVec3) -> (f64, f64) {
    let way = offset.dot(direction);
    (way, (offset - direction * way).length())
}

/// Makes vertices corners of the faces in whose edges they lie.
fn insert(scene: &mut Scene, found: Vec<Junction>) {
    let mut of_face: HashMap<usize, Vec<Junction>> = HashMap::new();
    for junction in found {
        of_face.entry(junction.edge.face).or_default().push(junction);
    }
    for (face, junctions) in of_face {
        scene.faces[face] = with_corners(&scene.faces[face], &junctions);
    }
}

/// A face with more corners, what they carry interpolated along its edges.
fn with_corners(face: &Face, junctions: &[Junction]) -> Face {
    let mut grown = Face { vertices: SmallVec::new(), ..face.clone() };
    grown.normals.clear();
    grown.uvs.clear();
    grown.tints.clear();
    let count = face.vertices.len();
    for corner in 0..count {
        let next = (corner + 1) % count;
        let here = junctions.iter().filter(|junction| junction.edge.corner == corner);
        let places = here.map(|junction| (junction.vertex, junction.share));
        for (vertex, share) in std::iter::once((face.vertices[corner], 0.0)).chain(places) {
            grown.vertices.push(vertex);
            if let (Some(a), Some(b)) = (face.normals.get(corner), face.normals.get(next)) {
                grown.normals.push(Vec3::lerp(*a, *b, share as f32));
            }
            if let (Some(a), Some(b)) = (face.uvs.get(corner), face.uvs.get(next)) {
                grown.uvs.push(DVec2::lerp(*a, *b, share));
            }
            if let (Some(a), Some(b)) = (face.tints.get(corner), face.tints.get(next)) {
                grown.tints.push(Vec3::lerp(*a, *b, share as f32));
            }
        }
    }
    grown
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle, and two squares that meet in the middle of its edge, one of their corners moved by so much;
    /// they go on in its plane or stand on it.
    fn joined(moved: DVec3, up: DVec3) -> Scene {
        let places = [
            DVec3::ZERO,
            2.0 * DVec3::X,
            2.0 * DVec3::X - DVec3::Y,
            -DVec3::Y,
            DVec3::X + moved,
            up,
            DVec3::X + up,
            2.0 * DVec3::X + up,
        ];
        let faces: [[u32; 4]; 3] = [[3, 2, 1, 0], [0, 4, 6, 5], [4, 1, 7, 6]];
        let face = |v: [u32; 4]| Face { vertices: v.as_slice().into(), ..Face::default() };
        let mut scene =
            Scene { positions: places.into(), faces: faces.map(face).into(), ..Scene::default() };
        join(&mut scene);
        scene
    }

    #[test]
    fn corners_in_an_edge_become_corners_of_its_face() {
        for up in [DVec3::Y, DVec3::Z, -DVec3::Z] {
            let scene = joined(DVec3::ZERO, up);
            assert_eq!(scene.faces[0].vertices[..], [3, 2, 1, 4, 0]);
            assert_eq!(scene.notes, ["1 T-junction closed: the edge got the corner inside it"]);
            for moved in [DVec3::Y, DVec3::Z, DVec3::new(1.0, -0.5, 0.5)] {
                let scene = joined(1e-4 * moved, up);
                assert_eq!(scene.faces[0].vertices.len(), 5, "{up} {moved}");
                assert!(scene.positions[4].with_x(0.0).length() < 1e-12, "{}", scene.positions[4]);
                assert_eq!(scene.notes.len(), 2, "{:?}", scene.notes);
            }
        }
    }

    #[test]
    fn gaps_and_mere_touches_are_left_alone() {
        let gap = joined(1e-2 * DVec3::Y, DVec3::Y);
        assert!(gap.notes.is_empty() && gap.positions[4].y == 1e-2, "{:?}", gap.notes);
        let triangle = |v: [u32; 3]| Face { vertices: v.as_slice().into(), ..Face::default() };
        let mut touching = Scene {
            positions: vec![
                DVec3::ZERO,
                DVec3::X,
                -DVec3::Y,
                0.5 * DVec3::X,
                DVec3::Y,
                DVec3::new(1.0, 1.0, 0.5),
            ],
            faces: vec![triangle([0, 2, 1]), triangle([3, 5, 4])],
            ..Scene::default()
        };
        join(&mut touching);
        assert_eq!(touching.faces[0].vertices.len(), 3);
    }

    #[test]
    fn new_corners_carry_what_lies_between_their_neighbours() {
        let face = Face {
            vertices: [7, 8, 9].as_slice().into(),
            uvs: [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(DVec2::from).as_slice().into(),
            ..Face::default()
        };
        let junction =
            Junction { edge: FaceEdge { face: 0, corner: 1 }, vertex: 3, share: 0.25, apart: 0.0 };
        let grown = with_corners(&face, &[junction]);
        assert_eq!(grown.vertices[..], [7, 8, 3, 9]);
        assert_eq!(grown.uvs[2], DVec2::new(0.75, 0.25));
    }
}
