//! Outlines with fewer corners around the same area.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec2;

use crate::geometry::polygon::{Ring, area, bounds, centroid};

/// How far rings are simplified.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Changes that move less area than this are made.
    pub(super) area: f64,
    /// Further ones are made as long as there are more corners than this; coarse grain has up to half as many again.
    pub(super) corners: usize,
}

/// Rings with fewer corners, and the same area in sum.
///
/// The edge between two corners becomes one corner on the line of the edge before or after it, placed so that no area is
/// gained or lost ([Kronenfeld et al. 2020]); that which moves least area first. Rings that come to nothing leave their
/// area to others near them: fine grain becomes coarse grain that covers as much.
///
/// [Kronenfeld et al. 2020]: https://doi.org/10.1080/15230406.2019.1631736
pub(super) fn simplified(rings: &[Ring], limits: Limits) -> Vec<Ring> {
    let mut chain = Chain::new(rings);
    let mut waiting: BinaryHeap<Reverse<Change>> = BinaryHeap::new();
    for corner in 0..chain.corners.len() {
        waiting.push(Reverse(chain.change(corner)));
    }
    let span = bounds(rings.iter().flatten());
    let (mut left, mut largest) = (chain.corners.len(), limits.area);
    let mut dropped = Vec::new();
    while let Some(Reverse(change)) = waiting.pop() {
        let Change { corner, moved, .. } = change;
        if chain.corners[corner].version != change.version {
            continue;
        }
        let moved = f64::from_bits(moved);
        if moved > limits.area && left <= limits.corners {
            break;
        }
        largest = largest.max(moved);
        let ring = chain.corners[corner].ring;
        if chain.counts[ring] <= 3 {
            left -= chain.counts[ring];
            dropped.push((ring, chain.take(corner)));
            continue;
        }
        left -= 1;
        for touched in chain.collapse(corner) {
            waiting.push(Reverse(chain.change(touched)));
        }
    }
    let mut rings = chain.rings();
    dropped.sort_by_key(|(number, ring)| (along_curve(centroid(ring), span), *number));
    let dropped: Vec<Ring> = dropped.into_iter().map(|(_, ring)| ring).collect();
    let sums = sums(&dropped);
    let coarse = largest.max(8.0 * (sums[0] + sums[1]) / limits.corners as f64);
    // Of what is worth a ring, there is one at least.
    let least = sums.map(|sum| if sum < largest { coarse } else { coarse.min(0.999 * sum) });
    rings.extend(gathered(&dropped, least));
    rings
}

/// How far along Morton's curve a place in a box is: what follows each other there lies together.
fn along_curve(place: DVec2, [low, high]: [DVec2; 2]) -> u64 {
    let share = (place - low) / (high - low).max_element().max(f64::MIN_POSITIVE);
    let [x, y] = share.to_array().map(|share| (share.clamp(0.0, 1.0) * 65_535.0) as u64);
    (0..16).fold(0, |sum, bit| sum | (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1))
}

/// Area of islands and of holes.
fn sums(rings: &[Ring]) -> [f64; 2] {
    let areas = || rings.iter().map(|ring| area(ring));
    [areas().map(|area| area.max(0.0)).sum(), areas().map(|area| (-area).max(0.0)).sum()]
}

/// Of small rings as many as have the area of all, each at least `least`; islands and holes for themselves.
fn gathered(rings: &[Ring], least: [f64; 2]) -> Vec<Ring> {
    let (mut carried, mut moments) = ([0.0; 2], [DVec2::ZERO; 2]);
    let mut kept = Vec::new();
    for ring in rings {
        let own = area(ring).abs();
        let kind = usize::from(area(ring) < 0.0);
        let sum = &mut carried[kind];
        *sum += own;
        moments[kind] += centroid(ring) * own;
        if *sum >= least[kind] && own > 0.0 {
            let (from, to, scale) = (centroid(ring), moments[kind] / *sum, (*sum / own).sqrt());
            kept.push(ring.iter().map(|&p| to + (p - from) * scale).collect());
            (*sum, moments[kind]) = (0.0, DVec2::ZERO);
        }
    }
    kept
}

/// What could be made of the edge that begins at a corner; least area first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Change {
    /// Area that it moves: bits of a number that is not negative, which sort as it does.
    moved: u64,
    corner: usize,
    version: u32,
}

#[derive(Clone, Copy, Debug)]
struct RingCorner {
    place: DVec2,
    before: usize,
    after: usize,
    ring: usize,
    /// Changes worked out for an older one are void; `GONE` of a corner that is no more.
    version: u32,
}

const GONE: u32 = u32::MAX;

/// All corners, linked along their rings.
struct Chain {
    corners: Vec<RingCorner>,
    /// Corners by ring.
    counts: Vec<usize>,
}

impl Chain {
    fn new(rings: &[Ring]) -> Self {
        let mut corners = Vec::new();
        for (number, ring) in rings.iter().enumerate() {
            let (first, count) = (corners.len(), ring.len());
            corners.extend(ring.iter().enumerate().map(|(k, &place)| RingCorner {
                place,
                before: first + (k + count - 1) % count,
                after: first + (k + 1) % count,
                ring: number,
                version: 0,
            }));
        }
        Self { corners, counts: rings.iter().map(Vec::len).collect() }
    }

    /// The corners before an edge, at its ends and after it.
    fn around(&self, corner: usize) -> [usize; 4] {
        let end = self.corners[corner].after;
        [self.corners[corner].before, corner, end, self.corners[end].after]
    }

    fn change(&self, corner: usize) -> Change {
        let RingCorner { ring, version, .. } = self.corners[corner];
        let places = self.around(corner).map(|k| self.corners[k].place);
        let moved = match self.counts[ring] {
            0..=3 => area(&places[..3]).abs(),
            _ => joined(places).1,
        };
        Change { moved: moved.to_bits(), corner, version }
    }

    /// Makes one corner of an edge's two; those whose edges have other changes now.
    fn collapse(&mut self, corner: usize) -> [usize; 4] {
        let around = self.around(corner);
        let [before, _, end, after] = around;
        self.corners[corner].place = joined(around.map(|k| self.corners[k].place)).0;
        self.corners[corner].after = after;
        self.corners[after].before = corner;
        self.corners[end].version = GONE;
        self.counts[self.corners[corner].ring] -= 1;
        let touched = [self.corners[before].before, before, corner, after];
        // Of three corners, two of these are one.
        for (k, &number) in touched.iter().enumerate() {
            if !touched[..k].contains(&number) {
                self.corners[number].version += 1;
            }
        }
        touched
    }

    /// Takes a ring away.
    fn take(&mut self, corner: usize) -> Ring {
        let mut ring = Ring::new();
        let mut at = corner;
        while self.corners[at].version != GONE {
            ring.push(self.corners[at].place);
            self.corners[at].version = GONE;
            at = self.corners[at].after;
        }
        ring
    }

    /// What is left, ring by ring.
    fn rings(mut self) -> Vec<Ring> {
        let all = 0..self.corners.len();
        all.map(|corner| self.take(corner)).filter(|ring| ring.len() > 2).collect()
    }
}

/// Where one corner stands for the two in the middle of four, and how much area is moved by that.
fn joined([a, b, c, d]: [DVec2; 4]) -> (DVec2, f64) {
    let base = d - a;
    let doubled = (b - a).perp_dot(c - a) + (c - a).perp_dot(base);
    let (first, second) = (base.perp_dot(b - a), base.perp_dot(c - a));
    let size = base.length_squared().max(c.distance_squared(a)).max(d.distance_squared(b));
    // The corner lies on the line of the edge whose end is further from that between the outer two.
    let place = if first.abs().max(second.abs()) <= 1e-12 * size {
        b.midpoint(c)
    } else if first.abs() > second.abs() {
        a + (b - a) * (-doubled / first)
    } else {
        d + (c - d) * (-doubled / second)
    };
    (place, (b - place).perp_dot(c - place).abs() / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(corners: usize, radius: f64) -> Ring {
        let turn = std::f64::consts::TAU / corners as f64;
        (0..corners).map(|k| DVec2::from_angle(turn * k as f64) * radius).collect()
    }

    #[test]
    fn corners_on_straight_edges_go_and_others_stay() {
        let square = [[0., 0.], [1., 0.], [2., 0.], [2., 2.], [1.5, 2.], [0., 2.], [0., 1.]];
        let ring: Ring = square.iter().map(|&p| p.into()).collect();
        let found = simplified(&[ring], Limits { area: 1e-9, corners: 100 });
        assert_eq!(found[0].len(), 4, "{found:?}");
        assert!((area(&found[0]) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn area_stays_whatever_the_number_of_corners() {
        let hole: Ring = circle(300, 0.4).into_iter().rev().collect();
        let rings = [circle(1000, 1.0), hole];
        let exact: f64 = rings.iter().map(|ring| area(ring)).sum();
        for most in [500, 60, 12] {
            let found = simplified(&rings, Limits { area: 0.0, corners: most });
            let sum: f64 = found.iter().map(|ring| area(ring)).sum();
            assert!((sum / exact - 1.0).abs() < 1e-9, "{most}: {sum} of {exact}");
            assert!(found.iter().map(Vec::len).sum::<usize>() <= most);
            // No corner strays: a polygon of n corners and a circle's area reaches 1.6 / n² beyond it.
            let furthest = found[0].iter().map(|p| p.length()).fold(0.0, f64::max);
            assert!(furthest < 1.0 + 20.0 / (most * most) as f64, "{most}: {furthest}");
        }
    }

    #[test]
    fn grain_becomes_coarse_grain_of_as_much_area() {
        let at = |k: usize| DVec2::new((k % 40) as f64, (k / 40) as f64);
        let grain = |k| circle(4, 0.3).into_iter().map(|p| p + at(k)).collect();
        let rings: Vec<Ring> = (0..1600).map(grain).collect();
        let sum = |rings: &[Ring]| rings.iter().map(|ring| area(ring)).sum::<f64>();
        let found = simplified(&rings, Limits { area: 0.01, corners: 400 });
        assert!((sum(&found) / sum(&rings) - 1.0).abs() < 0.02);
        assert!(found.iter().any(|ring| area(ring) > 10.0 * area(&rings[0])), "no coarse grain");
        assert!(found.iter().map(Vec::len).sum::<usize>() <= 600);
    }
}
