//! Closed convex bodies of one exitance, such as the bulbs of emitters: one emitter, however many facets they have.
//!
//! Radiance does not change along rays, so what such a body sends to a place is what a flat polygon with the same
//! outline would: its silhouette, exact for any convex body.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::profile::RadianceProfile;
use super::view::EmitterView;
use crate::colour::Rgb;
use crate::geometry::Weld;
use crate::geometry::{HalfSpace, Polygon};
use crate::surface::{Surface, SurfaceId, Surfaces};
use crate::visibility::SurfacePoint;

/// Bodies of fewer facets are emitters facet by facet: few enough, and their edges make shadows with lines of their
/// own.
const LEAST_FACETS: usize = 13;

/// How far a corner may be in front of a neighbour's plane, as a share of the body's size: vertices are rounded.
const ROUNDING: f64 = 1e-5;

/// A closed convex body that glows.
#[derive(Clone, Debug)]
pub(super) struct Globe {
    /// Its facets, as indices into [`Surfaces::list`], in order.
    pub(super) surfaces: Vec<SurfaceId>,
    corners: Vec<DVec3>,
    /// In front of each facet, a hair away from it.
    fronts: Vec<HalfSpace>,
    /// By edge: its ends among the corners, the facet to its left and that to its right.
    edges: Vec<[u32; 4]>,
    pub(super) exitance: Rgb,
    pub(super) low: DVec3,
    pub(super) high: DVec3,
}

/// All globes among surfaces that emit.
pub(super) fn globes(surfaces: &Surfaces) -> Vec<Globe> {
    let mut weld = Weld::new(surfaces.epsilon);
    let is_glowing = |surface: &Surface| {
        let material = &surfaces[surface.material];
        surface.is_emitter() && material.emission_texture.is_none() && surface.rings.len() == 1
    };
    let ids = surfaces.ids();
    let glowing: Vec<SurfaceId> = ids.filter(|&id| is_glowing(&surfaces[id])).collect();
    let outline = |&id: &SurfaceId| {
        let surface = &surfaces[id];
        let corners = surface.rings[0].iter().map(|&p| surface.plane.lift(p));
        corners.map(|corner| weld.number(corner)).collect::<SmallVec<[u32; 4]>>()
    };
    let outlines: Vec<SmallVec<[u32; 4]>> = glowing.iter().map(outline).collect();
    let mut left_of: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    let mut doubled = vec![false; glowing.len()];
    for (facet, outline) in outlines.iter().enumerate() {
        for edge in edges(outline) {
            if let Some(other) = left_of.insert(edge, facet) {
                (doubled[facet], doubled[other]) = (true, true);
            }
        }
    }
    let places = weld.places();
    let mut taken = doubled;
    let mut globes = Vec::new();
    for seed in 0..glowing.len() {
        let members = connected(seed, &outlines, &left_of, &mut taken);
        globes.extend(members.and_then(|members| {
            let facets = (glowing.as_slice(), outlines.as_slice(), &left_of);
            Globe::new(surfaces, facets, &members, places)
        }));
    }
    globes
}

/// The facets that hang together with one over edges, if all of these have two sides.
fn connected(
    seed: usize,
    outlines: &[SmallVec<[u32; 4]>],
    left_of: &BTreeMap<[u32; 2], usize>,
    taken: &mut [bool],
) -> Option<Vec<usize>> {
    if std::mem::replace(&mut taken[seed], true) {
        return None;
    }
    let (mut members, mut next) = (vec![seed], 0);
    while next < members.len() {
        for [from, to] in edges(&outlines[members[next]]) {
            if let Some(&other) = left_of.get(&[to, from])
                && !std::mem::replace(&mut taken[other], true)
            {
                members.push(other);
            }
        }
        next += 1;
    }
    members.sort_unstable();
    let among = |facet: &usize| members.binary_search(facet).is_ok();
    let mut sides = members.iter().flat_map(|&member| edges(&outlines[member]));
    let is_closed = sides.all(|[a, b]| left_of.get(&[b, a]).is_some_and(among));
    (is_closed && members.len() >= LEAST_FACETS).then_some(members)
}

fn edges(outline: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(&from, &to)| [from, to])
}

/// Facets that glow: their surfaces, their outlines, and which is to the left of each edge.
type Facets<'a> = (&'a [SurfaceId], &'a [SmallVec<[u32; 4]>], &'a BTreeMap<[u32; 2], usize>);

impl Globe {
    /// The body of these facets, which close around it, if it is convex and glows evenly.
    fn new(
        surfaces: &Surfaces,
        (glowing, outlines, left_of): Facets<'_>,
        members: &[usize],
        places: &[DVec3],
    ) -> Option<Self> {
        let surface = |facet: usize| &surfaces[glowing[facet]];
        let exitance = surface(members[0]).exitance;
        let mut corners: Vec<u32> =
            members.iter().flat_map(|&facet| outlines[facet].iter().copied()).collect();
        corners.sort_unstable();
        corners.dedup();
        let number = |corner: u32| corners.binary_search(&corner).unwrap_or(0) as u32;
        let place = |corner: &u32| places[*corner as usize];
        let low = corners.iter().map(place).fold(DVec3::INFINITY, DVec3::min);
        let high = corners.iter().map(place).fold(DVec3::NEG_INFINITY, DVec3::max);
        let rounding = ROUNDING * low.distance(high);
        let mut all_edges = Vec::new();
        for (left, &facet) in members.iter().enumerate() {
            if surface(facet).exitance != exitance {
                return None;
            }
            for [from, to] in edges(&outlines[facet]) {
                let other = left_of[&[to, from]];
                let plane = &surface(other).plane;
                if outlines[facet].iter().any(|corner| plane.height(place(corner)) > rounding) {
                    return None;
                }
                if from < to {
                    let right = members.binary_search(&other).ok()? as u32;
                    all_edges.push([number(from), number(to), left as u32, right]);
                }
            }
        }
        // Bodies in one piece without holes through them: V - E + F = 2. Locally convex ones are convex.
        (corners.len() + members.len() == all_edges.len() + 2).then(|| Self {
            surfaces: members.iter().map(|&facet| glowing[facet]).collect(),
            corners: corners.iter().map(place).collect(),
            fronts: members.iter().map(|&f| front(surface(f), surfaces.epsilon)).collect(),
            edges: all_edges,
            exitance,
            low,
            high,
        })
    }

    /// Its silhouette; none from within, or from a place on it.
    fn silhouette(&self, eye: DVec3) -> Option<(Polygon, DVec3)> {
        let is_seen: Vec<bool> = self.fronts.iter().map(|front| front.depth(eye) > 0.0).collect();
        let borders =
            self.edges.iter().filter(|[.., l, r]| is_seen[*l as usize] != is_seen[*r as usize]);
        let ends = borders.flat_map(|[from, to, ..]| [*from, *to]);
        let corners: SmallVec<[DVec3; 64]> =
            ends.map(|corner| self.corners[corner as usize] - eye).collect();
        if corners.is_empty() {
            return None;
        }
        let towards = (corners.iter().sum::<DVec3>() / corners.len() as f64).try_normalize()?;
        // In the plane of what is farthest of the outline: all that hides it lies before.
        let depth = corners.iter().map(|corner| corner.dot(towards)).fold(0.0, f64::max);
        let (x, y) = (-towards).any_orthonormal_pair();
        let flat = |corner: &DVec3| {
            let at = *corner * (depth / corner.dot(towards));
            DVec2::new(at.dot(x), at.dot(y))
        };
        if corners.iter().any(|corner| corner.dot(towards) <= 1e-6 * depth) {
            return None;
        }
        let outline = convex_hull(corners.iter().map(flat).collect());
        let lift = |p: &DVec2| eye + towards * depth + x * p.x + y * p.y;
        (outline.len() >= 3).then(|| (outline.iter().map(lift).collect(), -towards))
    }

    /// As a place with a unit normal sees it.
    pub(super) fn view(&self, receiver: SurfacePoint) -> Option<EmitterView<'_>> {
        let (outline, normal) = self.silhouette(receiver.position)?;
        let horizon = HalfSpace::new(receiver.position, receiver.normal);
        let polygon = horizon.clip(&outline);
        let profile = RadianceProfile::Diffuse;
        (!polygon.is_empty()).then(|| EmitterView {
            weight: profile.weight(receiver, &polygon),
            receiver,
            polygon,
            normal,
            exitance: self.exitance,
            profile,
            own: &self.surfaces,
        })
    }
}

/// A hair before a surface, so that rounding lets no place on it be lit by what it lies on.
pub(super) fn front(surface: &Surface, epsilon: f64) -> HalfSpace {
    let normal = surface.plane.normal;
    HalfSpace::new(surface.plane.origin + normal * epsilon, normal)
}

/// The convex hull of points in a plane, counter-clockwise ([Andrew 1979]).
///
/// [Andrew 1979]: https://doi.org/10.1016/0020-0190(79)90072-3
fn convex_hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut hull: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., a, b] = hull.as_slice()
                && (*b - *a).perp_dot(point - *b) <= 0.0
            {
                hull.pop();
            }
            hull.push(point);
        }
        hull.pop();
        hull
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    hull
}
