//! Segments on which the view of emitters changes, those in one line joined.

use std::collections::HashMap;
use std::f64::consts::PI;

use smallvec::SmallVec;

use crate::direct::EmitterId;
use crate::geometry::polygon::{self, Segment};

/// Width of the bins that lines are sorted in by their angle, radians, and by their offset, as a share of the patch's
/// size: lines that could be one are in neighbouring bins.
const BIN: f64 = 2e-3;

/// A segment on which the views of some emitters change.
pub(super) struct Event {
    pub(super) segment: Segment,
    pub(super) emitters: SmallVec<[EmitterId; 2]>,
    /// What it may carry, at most, W/m².
    pub(super) bound: f64,
}

/// Events with those that overlap on one line joined, on a patch of this size, m.
pub(super) fn joined(events: impl Iterator<Item = Event>, size: f64, epsilon: f64) -> Vec<Event> {
    let mut all: Vec<Option<Event>> = Vec::new();
    let mut bins: HashMap<[i64; 2], SmallVec<[u32; 4]>> = HashMap::new();
    for mut new in events {
        let bin = bin_of(new.segment, size);
        for key in around(bin) {
            let Some(indices) = bins.get_mut(&key) else { continue };
            indices.retain(|&mut index| {
                let old = &mut all[index as usize];
                let union = old.as_ref().and_then(|old| union(new.segment, old.segment, epsilon));
                if let Some((union, old)) = union.zip(old.take_if(|_| union.is_some())) {
                    new.segment = union;
                    new.bound = new.bound.max(old.bound);
                    new.emitters.extend_from_slice(&old.emitters);
                }
                union.is_none()
            });
        }
        new.emitters.sort_unstable();
        new.emitters.dedup();
        bins.entry(bin).or_default().push(all.len() as u32);
        all.push(Some(new));
    }
    all.into_iter().flatten().collect()
}

/// The bin of the line through a segment: its angle and its distance from the origin.
fn bin_of([a, b]: Segment, size: f64) -> [i64; 2] {
    let along = (b - a).normalize_or_zero();
    let along = if along.y < 0.0 || (along.y == 0.0 && along.x < 0.0) { -along } else { along };
    let offset = along.perp_dot(a);
    [along.to_angle() / BIN, offset / (BIN * size)].map(|share| share.floor() as i64)
}

/// A bin and its neighbours; beyond half a turn, lines come again from their other side.
fn around([angle, offset]: [i64; 2]) -> impl Iterator<Item = [i64; 2]> {
    let last = (PI / BIN).floor() as i64;
    let aside = move |angle: i64, offset: i64| {
        if angle < 0 {
            [last, -1 - offset]
        } else if angle > last {
            [0, -1 - offset]
        } else {
            [angle, offset]
        }
    };
    (-1..=1).flat_map(move |i| (-1..=1).map(move |j| aside(angle + i, offset + j)))
}

/// Two segments as one, if they overlap on one line.
fn union(a: Segment, b: Segment, epsilon: f64) -> Option<Segment> {
    let line = polygon::Line::through(a);
    if b.iter().any(|&p| line.side(p, epsilon) != 0.0) {
        return None;
    }
    let along = (a[1] - a[0]).normalize_or_zero();
    let [from, to] = b.map(|p| (p - a[0]).dot(along));
    let ([low, high], length) = ([from.min(to), from.max(to)], a[0].distance(a[1]));
    let overlap = low <= length + epsilon && high >= -epsilon;
    overlap.then(|| [a[0] + along * low.min(0.0), a[0] + along * high.max(length)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use proptest::prelude::*;
    use smallvec::smallvec;

    const TOLERANCE: f64 = 1e-6;

    /// Looks at all pairs.
    fn joined_one_by_one(events: Vec<Event>) -> Vec<Event> {
        let mut all: Vec<Event> = Vec::new();
        for mut new in events {
            all.retain(|old| {
                let union = union(new.segment, old.segment, TOLERANCE);
                new.segment = union.unwrap_or(new.segment);
                union.is_none()
            });
            all.push(new);
        }
        all
    }

    /// Segments on few lines, so that many overlap.
    fn segments() -> impl Strategy<Value = Vec<Segment>> {
        let one = (0..12u32, -2..3i32, 0.0..4.0f64, 0.1..2.0f64, any::<bool>());
        let segment = |(turn, offset, start, length, swap): (u32, i32, f64, f64, bool)| {
            let along = DVec2::from_angle(f64::from(turn) * PI / 12.0);
            let from = along.perp() * f64::from(offset) + along * start;
            let ends = [from, from + along * length];
            if swap { [ends[1], ends[0]] } else { ends }
        };
        prop::collection::vec(one.prop_map(segment), 0..80)
    }

    proptest! {
        #[test]
        fn bins_join_what_a_look_at_all_pairs_does(segments in segments()) {
            let event = |&segment: &Segment| Event { segment, emitters: smallvec![EmitterId(0)], bound: 1.0 };
            let events = || segments.iter().map(event);
            let binned = joined(events(), 4.0, TOLERANCE);
            let all = joined_one_by_one(events().collect());
            prop_assert_eq!(binned.len(), all.len());
            for (a, b) in binned.iter().zip(&all) {
                prop_assert!(a.segment[0].distance(b.segment[0]) < 1e-9);
                prop_assert!(a.segment[1].distance(b.segment[1]) < 1e-9);
            }
        }
    }
}
