//! Contact lines: where another surface stands on, touches or pierces a surface.
//!
//! Light jumps across such a line, so no element may lie on both sides of it. What hovers close over a
//! surface counts as touching it: there, light falls nearly as steeply.
//!
//! What is close depends on the two surfaces, and what is too small for a mesh to show is left out: a surface has a
//! few neighbours to look at, however large the scene and however fine its facets. Nothing is kept for a pair of
//! them but its lines.

use rayon::prelude::*;
use smallvec::SmallVec;

use super::polygon::{Line, Ring, Segment, contains, distance, edges};
use super::{Plane, Surface};
use crate::scene::boxes::{Bounds, Tree, are_close};

/// What faces a surface from less than this share of the scene's extent hovers close over it: a wider gap is wide
/// enough for elements of its own.
const CLOSE: f64 = 2e-3;

/// And than this share of the size of either: light falls gently beside what is far off for its size.
const CLOSE_FOR_SIZE: f64 = 0.1;

/// Cosine of the greatest angle at which that faces it: 5°.
const PARALLEL: f64 = 0.996;

/// What is smaller than this share of the scene's extent draws no lines: it is smaller than the smallest element of
/// [`Settings::high`](crate::Settings::high).
const SMALLEST: f64 = 1.0 / 2000.0;

/// Surfaces smaller than so many of the smallest elements cannot be divided, and get no lines.
const DIVISIBLE: f64 = 2.0;

/// Distances, m.
#[derive(Clone, Copy, Debug)]
struct Near {
    /// This far from a plane is in it.
    tolerance: f64,
    /// This far from a surface may be close to it.
    close: f64,
    /// What is smaller is not shown.
    smallest: f64,
}

/// Finds the contact lines of every surface with every other, in a scene of this extent, m, and stores
/// them in both.
pub(super) fn find_contacts(surfaces: &mut [Surface], extent: f64, tolerance: f64) {
    let near = Near::new(extent, tolerance);
    let all = &*surfaces;
    let tree = Tree::new(all.par_iter().map(Surface::bounds).collect());
    let lines_of = |found: &mut Vec<u32>, receiver: usize| {
        near.find_neighbours(&tree, &all[receiver].plane, receiver, found);
        let others = found.iter().map(|&other| other as usize).filter(|&other| other != receiver);
        others.flat_map(|other| near.lines(all, tree.boxes(), [receiver, other])).collect()
    };
    let lines: Vec<Vec<Segment>> =
        (0..all.len()).into_par_iter().map_init(Vec::new, lines_of).collect();
    surfaces.iter_mut().zip(lines).for_each(|(surface, lines)| surface.contacts = lines);
}

fn size((low, high): Bounds) -> f64 {
    low.distance(high)
}

impl Near {
    fn new(extent: f64, tolerance: f64) -> Self {
        Self { tolerance, close: CLOSE * extent, smallest: SMALLEST * extent }
    }

    /// How far what hovers close over a surface may be, m; over two of them, the smaller counts.
    fn reach(&self, bounds: Bounds) -> f64 {
        self.close.min(CLOSE_FOR_SIZE * size(bounds)).max(2.0 * self.tolerance)
    }

    /// The surfaces that may have lines on one: those with a part close over it or in its plane.
    fn find_neighbours(&self, tree: &Tree, plane: &Plane, receiver: usize, found: &mut Vec<u32>) {
        found.clear();
        let bounds = tree.boxes()[receiver];
        if size(bounds) < DIVISIBLE * self.smallest {
            return;
        }
        let reach = self.reach(bounds);
        let meets = |(low, high): Bounds| {
            let middle = plane.height(low.midpoint(high));
            let around = (high - low).dot(plane.normal.abs()) / 2.0;
            // Twice the tolerance, so that rounding loses nothing.
            size((low, high)) >= self.smallest
                && are_close(bounds, (low, high), reach)
                && middle - around <= reach + self.tolerance
                && middle + around >= -2.0 * self.tolerance
        };
        tree.find(meets, found);
    }

    /// The lines of the second surface on the first.
    fn lines(
        &self,
        surfaces: &[Surface],
        bounds: &[Bounds],
        [receiver, other]: [usize; 2],
    ) -> Vec<Segment> {
        let close = self.reach(bounds[receiver]).min(self.reach(bounds[other]));
        if !are_close(bounds[receiver], bounds[other], close) {
            return Vec::new();
        }
        contacts(&surfaces[receiver], &surfaces[other], [self.tolerance, close])
    }
}

/// Of the corners of each ring, m.
type Heights = SmallVec<[SmallVec<[f64; 4]>; 1]>;

/// The lines along which `other` meets the front or the plane of `receiver`, inside of it.
fn contacts(receiver: &Surface, other: &Surface, [tolerance, close]: [f64; 2]) -> Vec<Segment> {
    let height = |&p: &_| {
        let height = receiver.plane.height(other.plane.lift(p));
        if height.abs() <= tolerance { 0.0 } else { height }
    };
    let rings = other.rings.iter();
    let heights: Heights = rings.map(|ring| ring.iter().map(height).collect()).collect();
    let all = || heights.iter().flatten().copied();
    let (lowest, highest) = (all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max));
    let (behind, above) = (highest <= 0.0 && lowest < 0.0, lowest > 0.0);
    let hovers =
        above && highest <= close && other.plane.normal.dot(receiver.plane.normal) < -PARALLEL;
    if behind || (above && !hovers) {
        return Vec::new();
    }
    let lies = |h: f64| h == 0.0 || hovers;
    let mut segments = edges_where(lies, receiver, other, &heights);
    segments.extend(piercing_line(receiver, other, &heights));
    segments.into_iter().flat_map(|segment| inside(&receiver.rings, segment, tolerance)).collect()
}

/// Edges of `other`, seen along the receiver's normal, whose ends are at certain heights.
fn edges_where(
    lies: impl Fn(f64) -> bool,
    receiver: &Surface,
    other: &Surface,
    heights: &Heights,
) -> Vec<Segment> {
    let mut segments = Vec::new();
    for (ring, heights) in other.rings.iter().zip(heights) {
        for (k, edge) in edges(ring).enumerate() {
            if lies(heights[k]) && lies(heights[(k + 1) % heights.len()]) {
                segments.push(edge.map(|p| receiver.plane.flatten(other.plane.lift(p))));
            }
        }
    }
    segments
}

/// The pieces of the line in which `other` crosses the receiver's plane, in pairs of crossings along it.
fn piercing_line(receiver: &Surface, other: &Surface, heights: &Heights) -> Vec<Segment> {
    let mut crossings = Vec::new();
    for (ring, heights) in other.rings.iter().zip(heights) {
        for (k, [a, b]) in edges(ring).enumerate() {
            let (from, to) = (heights[k], heights[(k + 1) % heights.len()]);
            if (from < 0.0) != (to < 0.0) {
                let point = other.plane.lift(a.lerp(b, from / (from - to)));
                crossings.push(receiver.plane.flatten(point));
            }
        }
    }
    let along = receiver.plane.normal.cross(other.plane.normal);
    let along = receiver.plane.flatten(receiver.plane.origin + along);
    crossings.sort_by(|a, b| a.dot(along).total_cmp(&b.dot(along)));
    crossings.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// The parts of a segment inside rings and not on its outline.
pub(super) fn inside(rings: &[Ring], segment: Segment, tolerance: f64) -> Vec<Segment> {
    let outline = || rings.iter().flat_map(|ring| edges(ring));
    let mut parts = vec![segment];
    for edge in outline() {
        let line = Line::through(edge);
        for k in (0..parts.len()).rev() {
            if let [Some(left), Some(right)] = line.split_segment(parts[k], tolerance) {
                parts[k] = left;
                parts.insert(k + 1, right);
            }
        }
    }
    let is_inside = |&[a, b]: &Segment| {
        let middle = a.midpoint(b);
        a.distance(b) > tolerance
            && contains(rings, middle)
            && outline().all(|edge| distance(edge, middle) > tolerance)
    };
    parts.retain(is_inside);
    parts
}
