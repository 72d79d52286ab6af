//! Where to cut an element along a discontinuity line.

use glam::DVec2;
use smallvec::SmallVec;

use super::strength;
use crate::direct::Lamps;
use crate::mesh::{Crossing, ElementId, Mesh, Patch, Split};
use crate::surface::Surfaces;
use crate::surface::polygon::{self, Convex, Line, Segment};
use crate::visibility::{Facet, Occluders};

/// A discontinuity line on a patch, and what it carries.
#[derive(Clone, Copy, Debug)]
pub struct Discontinuity {
    segment: Segment,
    /// Jump of the derivative of radiosity across the line, W/m³.
    kink: f64,
    /// Jump of its second derivative, W/m⁴.
    bend: f64,
}

/// How far from a line derivatives are taken, as a share of the patch's size.
const STEP: f64 = 1.0 / 64.0;

/// Both parts of an element keep this share of it.
const LEAST_PART: f64 = 0.06;

/// A line must run through this share of its chord.
const LEAST_CHORD: f64 = 0.6;

/// Crossings nearer to a corner than this share of an edge are moved there.
const SNAP: f64 = 0.15;

/// Sine of the least angle between a cut and an edge.
const LEAST_SINE: f64 = 0.26;

/// The discontinuity lines of a patch, each with what it carries in the middle of the patch's part of it.
pub fn discontinuities(
    (surfaces, patch): (&Surfaces, &Patch),
    lamps: &Lamps,
    occluders: &Occluders,
) -> Vec<Discontinuity> {
    let plane = &surfaces.list[patch.surface as usize].plane;
    let outline: Convex = patch.corners.iter().map(|&p| plane.flatten(p)).collect();
    let tolerance = surfaces.tolerance;
    let lines = lamps.lines(occluders, Facet::new(&patch.corners, patch.normal));
    let borders: SmallVec<[Line; 8]> = polygon::edges(&outline).map(Line::through).collect();
    let clip = |segment: [glam::DVec3; 2]| {
        let segment = segment.map(|p| plane.flatten(p));
        clipped(segment, &borders, tolerance)
    };
    let mut segments: Vec<Segment> = Vec::new();
    for segment in lines.into_iter().filter_map(clip) {
        merge(&mut segments, segment, tolerance);
    }
    let step = STEP * patch.area.sqrt();
    let light = |p: DVec2| {
        strength(patch.reflectance * lamps.shine(occluders, plane.lift(p), plane.normal).irradiance)
    };
    let weigh = |segment: Segment| {
        let middle = (segment[0] + segment[1]) * 0.5;
        let across = (segment[1] - segment[0]).normalize_or_zero().perp() * step;
        let at = |k: f64| middle + across * k;
        if !borders.iter().all(|line| line.side(at(2.0), 0.0).min(line.side(at(-2.0), 0.0)) > 0.0) {
            return Discontinuity { segment, kink: 0.0, bend: 0.0 };
        }
        let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| light(at(k)));
        let before = (c - b) - 0.5 * ((c - b) - (b - a));
        let _ = before;
        // One-sided derivatives, right for parabolas.
        let (left, right) = ((3.0 * c - 4.0 * b + a) / 2.0, (4.0 * d - 3.0 * c - e) / 2.0);
        let (bend_left, bend_right) = (c - 2.0 * b + a, e - 2.0 * d + c);
        Discontinuity {
            segment,
            kink: (right - left).abs() / step,
            bend: (bend_right - bend_left).abs() / (step * step),
        }
    };
    segments.into_iter().map(weigh).collect()
}

/// The part of a segment to the left of all lines.
fn clipped(segment: Segment, borders: &[Line], tolerance: f64) -> Option<Segment> {
    let inside =
        borders.iter().try_fold(segment, |part, line| line.split_segment(part, tolerance)[0]);
    inside.filter(|[a, b]| a.distance(*b) > tolerance)
}

/// Adds a segment, joined with one that it overlaps.
fn merge(segments: &mut Vec<Segment>, mut new: Segment, tolerance: f64) {
    segments.retain(|&old| {
        let line = Line::through(new);
        if old.iter().any(|&p| line.side(p, tolerance) != 0.0) {
            return true;
        }
        let along = (new[1] - new[0]).normalize_or_zero();
        let range = |s: Segment| {
            let ends = s.map(|p| (p - new[0]).dot(along));
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        };
        let ([a, b], [c, d]) = (range(new), range(old));
        if c > b + tolerance || d < a - tolerance {
            return true;
        }
        new = [new[0] + along * a.min(c), new[0] + along * b.max(d)];
        false
    });
    segments.push(new);
}

/// The cut of an element along the line that carries most, if any carries more than `allowed`, W/m².
pub fn cut(
    (mesh, element): (&Mesh, ElementId),
    lines: &[Discontinuity],
    allowed: f64,
    tolerance: f64,
) -> Option<Split> {
    let outline = mesh.outline(element);
    let borders: SmallVec<[Line; 8]> = polygon::edges(&outline).map(Line::through).collect();
    let area = polygon::area(&outline);
    let mut best: Option<(f64, Split)> = None;
    for line in lines {
        let Some(part) = clipped(line.segment, &borders, tolerance) else { continue };
        let Some((split, chord, parts)) = chord(&outline, line.segment, tolerance) else {
            continue;
        };
        let share = part[0].distance(part[1]) / chord;
        if share < LEAST_CHORD || parts < LEAST_PART {
            continue;
        }
        let width = area / chord;
        let carried = (line.kink * width / 4.0).max(line.bend * width * width / 16.0) * share;
        if carried > allowed && best.is_none_or(|(most, _)| carried > most) {
            best = Some((carried, split));
        }
    }
    best.map(|(_, split)| split)
}

/// Where a line cuts a convex polygon, how long the cut is, and the smaller part's share of the area.
fn chord(outline: &Convex, segment: Segment, tolerance: f64) -> Option<(Split, f64, f64)> {
    let line = Line::through(segment);
    let n = outline.len();
    let side = |k: usize| line.side(outline[k % n], tolerance);
    let mut crossings: SmallVec<[Crossing; 4]> = SmallVec::new();
    for edge in 0..n {
        let (from, to) = (side(edge), side(edge + 1));
        let share = match (from, to) {
            (0.0, _) => 0.0,
            (_, 0.0) => continue,
            _ if from * to < 0.0 => from / (from - to),
            _ => continue,
        };
        let crossing = match share {
            share if share < SNAP => Crossing { edge, share: 0.0 },
            share if share > 1.0 - SNAP => Crossing { edge: (edge + 1) % n, share: 0.0 },
            share => Crossing { edge, share },
        };
        if !crossings.contains(&crossing) {
            crossings.push(crossing);
        }
    }
    let &[from, to] = crossings.as_slice() else { return None };
    let at = |c: Crossing| outline[c.edge].lerp(outline[(c.edge + 1) % n], c.share);
    let along = at(to) - at(from);
    let is_blunt = |c: Crossing| {
        let edge = |k: usize| outline[(k + 1) % n] - outline[k % n];
        let sine =
            |edge: DVec2| (edge.normalize_or_zero().perp_dot(along.normalize_or_zero())).abs();
        let before = if c.share == 0.0 { sine(edge(c.edge + n - 1)) } else { 1.0 };
        sine(edge(c.edge)).min(before) >= LEAST_SINE
    };
    if !is_blunt(from) || !is_blunt(to) {
        return None;
    }
    let cut = Line::through([at(from), at(to)]);
    let parts = cut.split(outline, tolerance);
    let areas = parts.map(|part| part.map_or(0.0, |part| polygon::area(&part)));
    let least = areas[0].min(areas[1]) / (areas[0] + areas[1]);
    Some((Split::Along([from, to]), along.length(), least))
}
