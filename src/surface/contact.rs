//! Contact lines: where another surface stands on, touches or pierces a surface.
//!
//! Light jumps across such a line, so no element may lie on both sides of it. What hovers close over a
//! surface counts as touching it: there, light falls nearly as steeply.

use rayon::prelude::*;

use super::Surface;
use super::boxes::close_pairs;
use super::polygon::{Line, Ring, Segment, contains, distance, edges};

/// What faces a surface from less than this share of the scene's extent hovers close over it.
const CLOSE: f64 = 2e-3;

/// Cosine of the greatest angle at which that faces it: 5°.
const PARALLEL: f64 = 0.996;

/// Distances, m.
#[derive(Clone, Copy)]
struct Near {
    /// This far from a plane is in it.
    tolerance: f64,
    /// This far from a surface is close to it.
    close: f64,
}

/// Finds the contact lines of every surface with every other, in a scene of this extent, m, and stores
/// them in both.
pub(super) fn find_contacts(surfaces: &mut [Surface], extent: f64, tolerance: f64) {
    let near = Near { tolerance, close: CLOSE * extent };
    let bounds: Vec<_> = surfaces.iter().map(Surface::bounds).collect();
    let pairs = close_pairs(&bounds, near.close);
    let found: Vec<Vec<Segment>> = pairs
        .par_iter()
        .map(|&(receiver, other)| contacts(&surfaces[receiver], &surfaces[other], near))
        .collect();
    for ((receiver, _), contacts) in pairs.into_iter().zip(found) {
        surfaces[receiver].contacts.extend(contacts);
    }
}

/// The lines along which `other` meets the front or the plane of `receiver`, inside of it.
fn contacts(receiver: &Surface, other: &Surface, near: Near) -> Vec<Segment> {
    let Near { tolerance, close } = near;
    let heights = |ring: &[_]| -> Vec<f64> {
        let height = |&p: &_| receiver.plane.height(other.plane.lift(p));
        ring.iter().map(height).map(|h: f64| if h.abs() <= tolerance { 0.0 } else { h }).collect()
    };
    let heights: Vec<Vec<f64>> = other.rings.iter().map(|ring| heights(ring)).collect();
    let all = || heights.iter().flatten();
    let behind = all().all(|&h| h <= 0.0) && all().any(|&h| h < 0.0);
    let above = all().all(|&h| h > 0.0);
    let hovers = above
        && all().all(|&h| h <= close)
        && other.plane.normal.dot(receiver.plane.normal) < -PARALLEL;
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
    heights: &[Vec<f64>],
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
fn piercing_line(receiver: &Surface, other: &Surface, heights: &[Vec<f64>]) -> Vec<Segment> {
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
        let cut = |part: Segment| match line.split_segment(part, tolerance) {
            [None, None] => [Some(part), None],
            halves => halves,
        };
        parts = parts.into_iter().flat_map(cut).flatten().collect();
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
