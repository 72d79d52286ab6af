//! Where to cut an element along a discontinuity line.

use glam::DVec2;
use smallvec::{SmallVec, smallvec};

use super::events::{Event, joined};
use super::oracle::Oracle;
use crate::colour::strength;
use crate::direct::{DirectLight, EventLine};
use crate::geometry::polygon::{self, Convex, Segment};
use crate::light::Optics;
use crate::mesh::{Crossing, Mesh, Patch, PatchId, Split};

/// How far from a line derivatives are taken, as a share of the patch's size.
///
/// At 1/128 and at 1/32, shadows in two rooms joined by a door (medium) err by 0.98 % and 0.84 % for 0.78 %.
const STEP: f64 = 1.0 / 64.0;

/// Both parts of an element keep at least this share of it.
///
/// At 0.03 and at 0.12, shadows in two rooms (medium) err by 0.94 % and 0.86 % for 0.78 %.
const LEAST_PART: f64 = 0.06;

/// A line must run through this share of the cut.
///
/// At 0.3, the Cornell box (medium) errs along shadows by 0.55 % as before; at 0.9 it takes
/// 14 362 triangles for 14 024.
const LEAST_SHARE: f64 = 0.6;

/// Ends of a cut nearer to a corner than this share of an edge are moved there.
///
/// At 0.05, the blocker scene (medium) takes 3 892 triangles for 3 729; at 0.3, two rooms take 8 904 for 8 498.
const SNAP: f64 = 0.15;

/// Numbers of equal parts of an edge between which neighbours, dividing it again and again, may have
/// vertices. Ends of cuts nearer to one than an eighth of a part are moved there: less would be slivers.
const HALVINGS: [f64; 5] = [2.0, 4.0, 8.0, 16.0, 32.0];

/// All other cuts end at multiples of this share of an edge, so that those of neighbours meet or keep apart.
const NOTCHES: f64 = 256.0;

/// Most lines of a patch that are weighed.
const MOST_LINES: usize = 128;

/// Sine of the least angle between a cut and an edge: 15°.
///
/// At 0.13 and at 0.52, shadows in two rooms (medium) err by 1.10 % and 1.03 % for 0.78 %.
const LEAST_SINE: f64 = 0.26;

/// A discontinuity line on a patch, and what it carries.
#[derive(Clone, Copy, Debug)]
pub struct Discontinuity {
    segment: Segment,
    /// Jump of the derivative of radiosity across the line, W/m³.
    kink: f64,
    /// Jump of the second derivative, W/m⁴.
    bend: f64,
}

/// A cut through a convex polygon.
struct Chord {
    ends: [Crossing; 2],
    length: f64,
    /// The smaller part's share of the area.
    least_part: f64,
}

/// Looks for discontinuity lines of direct light.
#[derive(Clone, Copy, Debug)]
pub struct LineSearch<'a> {
    /// The mesh whose patches are looked at.
    pub mesh: &'a Mesh,
    /// How they reflect.
    pub optics: &'a Optics,
    /// The emitters, as they are seen from them.
    pub light: &'a DirectLight,
    /// What says how much matters.
    pub oracle: &'a Oracle,
}

impl LineSearch<'_> {
    /// The lines of a patch, as far as they carry more than the oracle allows; those found by then, once there has been
    /// `enough`.
    pub fn on(&self, patch: PatchId, enough: impl Fn() -> bool) -> Vec<Discontinuity> {
        let Self { mesh, optics, light, oracle } = *self;
        let (Patch { corners, area, root, .. }, reflectance) =
            (&mesh[patch], optics.reflectance[patch.index()]);
        if reflectance.max_element() <= 0.0 {
            return Vec::new();
        }
        let (plane, epsilon) = (mesh.plane(patch), mesh.epsilon());
        let outline: Convex = corners.iter().map(|&p| plane.flatten(p)).collect();
        let borders = polygon::borders(&outline);
        let allowed = oracle.allowed_in_the_dark(mesh, *root);
        let lines = light.lines(mesh, patch, allowed / strength(reflectance));
        let inside = lines.into_iter().filter_map(|EventLine { ends, emitter, bound }| {
            let segment = ends.map(|p| plane.flatten(p));
            let segment = polygon::clip(segment, &borders, epsilon)?;
            let is_long = segment[0].distance(segment[1]) >= 2.0 * oracle.min_element();
            is_long.then(|| Event { segment, emitters: smallvec![emitter], bound })
        });
        let mut events = joined(inside, area.sqrt(), epsilon);
        strongest(&mut events);
        let step = STEP * area.sqrt();
        let weighed = |event: Event| {
            // All other light is smooth there, or has a line of its own.
            let by = |place: DVec2| {
                let chosen = |emitter| event.emitters.contains(&emitter);
                Some(strength(reflectance * light.exactly(patch, plane.lift(place), chosen)?))
            };
            weigh(event.segment, &borders, step, by)
        };
        let matters = |line: &Discontinuity| line.error(area.sqrt()) > allowed;
        let going_on = events.into_iter().take_while(|_| !enough());
        going_on.filter_map(weighed).filter(matters).collect()
    }
}

/// Leaves those events that may carry most, in their order.
fn strongest(events: &mut Vec<Event>) {
    if events.len() > MOST_LINES {
        let mut bounds: Vec<f64> = events.iter().map(|event| event.bound).collect();
        let (_, &mut least, _) = bounds.select_nth_unstable_by(MOST_LINES, |a, b| b.total_cmp(a));
        events.retain(|event| event.bound > least);
    }
}

/// What a line carries, from light at five places across its middle; nothing is known where these are
/// not all inside the borders, or light is not known exactly.
fn weigh(
    segment: Segment,
    borders: &[polygon::Line],
    step: f64,
    light: impl Fn(DVec2) -> Option<f64>,
) -> Option<Discontinuity> {
    let middle = (segment[0] + segment[1]) * 0.5;
    let across = (segment[1] - segment[0]).normalize_or_zero().perp() * step;
    let places = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| middle + across * k);
    let is_inside = |place: &DVec2| borders.iter().all(|line| line.side(*place, 0.0) > 0.0);
    if !places.iter().all(is_inside) {
        return None;
    }
    let mut known = [0.0; 5];
    for (known, place) in known.iter_mut().zip(places) {
        *known = light(place)?;
    }
    let [a, b, c, d, e] = known;
    // Derivatives on each side, exact for parabolas.
    let slopes = [(3.0 * c - 4.0 * b + a) / 2.0, (4.0 * d - 3.0 * c - e) / 2.0];
    let bends = [c - 2.0 * b + a, e - 2.0 * d + c];
    Some(Discontinuity {
        segment,
        kink: (slopes[1] - slopes[0]).abs() / step,
        bend: (bends[1] - bends[0]).abs() / (step * step),
    })
}

/// The cut of an element with this outline along the line that carries most, if that is more than is `allowed`, W/m².
pub fn cut(outline: &Convex, lines: &[Discontinuity], allowed: f64, epsilon: f64) -> Option<Split> {
    let (borders, area) = (polygon::borders(outline), polygon::area(outline));
    let carried = |line: &Discontinuity| {
        let [from, to] = polygon::clip(line.segment, &borders, epsilon)?;
        let chord = Chord::new(outline, &polygon::Line::through(line.segment), epsilon)?;
        let share = from.distance(to) / chord.length;
        if share < LEAST_SHARE || chord.least_part < LEAST_PART {
            return None;
        }
        Some((line.error(area / chord.length) * share, chord.ends))
    };
    let most = lines.iter().filter_map(carried).max_by(|(a, _), (b, _)| a.total_cmp(b));
    most.filter(|(error, _)| *error > allowed).map(|(_, ends)| Split::Along(ends))
}

impl Discontinuity {
    /// What interpolation across an element of this width, m, makes of the jumps in its middle, W/m².
    fn error(&self, width: f64) -> f64 {
        (self.kink * width / 4.0).max(self.bend * width * width / 16.0)
    }
}

impl Chord {
    /// Along a line, its ends moved to corners that are near; none where its parts would be slivers.
    fn new(outline: &Convex, line: &polygon::Line, epsilon: f64) -> Option<Self> {
        let n = outline.len();
        let mut crossings: SmallVec<[Crossing; 4]> = SmallVec::new();
        for edge in 0..n {
            let [from, to] = [edge, (edge + 1) % n].map(|k| line.side(outline[k], epsilon));
            let share = if from == 0.0 {
                0.0
            } else if from * to < 0.0 {
                from / (from - to)
            } else {
                continue;
            };
            let crossing = snapped(Crossing { edge, share }, n);
            if !crossings.contains(&crossing) {
                crossings.push(crossing);
            }
        }
        let &[from, to] = crossings.as_slice() else { return None };
        let at = |c: Crossing| outline[c.edge].lerp(outline[(c.edge + 1) % n], c.share);
        let along = at(to) - at(from);
        if [from, to].iter().any(|&end| sine(outline, end, along) < LEAST_SINE) {
            return None;
        }
        let parts = polygon::Line::through([at(from), at(to)]).split(outline, epsilon);
        let [a, b] = parts.map(|part| part.map_or(0.0, |part| polygon::area(&part)));
        Some(Self { ends: [from, to], length: along.length(), least_part: a.min(b) / (a + b) })
    }
}

/// The nearest place on an edge at which cuts may end, of a polygon of `n` corners.
fn snapped(Crossing { edge, share }: Crossing, n: usize) -> Crossing {
    match share {
        share if share < SNAP => Crossing { edge, share: 0.0 },
        share if share > 1.0 - SNAP => Crossing { edge: (edge + 1) % n, share: 0.0 },
        share => Crossing { edge, share: notch(share) },
    }
}

/// The nearest of the places where cuts may end between the corners of an edge, as a share of it.
fn notch(share: f64) -> f64 {
    let nearest = |parts: f64| (share * parts).round() / parts;
    let is_near = |parts: &f64| (share - nearest(*parts)).abs() * parts < 0.125;
    nearest(HALVINGS.into_iter().find(is_near).unwrap_or(NOTCHES))
}

/// Sine of the smallest angle between a cut from or to a place on the border, and the edges there.
fn sine(outline: &Convex, end: Crossing, along: DVec2) -> f64 {
    let n = outline.len();
    let angle = |edge: usize| {
        let side = outline[(edge + 1) % n] - outline[edge % n];
        side.normalize_or_zero().perp_dot(along.normalize_or_zero()).abs()
    };
    let here = angle(end.edge);
    if end.share == 0.0 { here.min(angle(end.edge + n - 1)) } else { here }
}
