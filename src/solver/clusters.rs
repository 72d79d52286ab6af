//! Clusters of facets: pieces of curved surfaces much smaller than patches should be send their light as one.
//!
//! Facets of a fine mesh are surfaces of their own, and so patches of their own, far more than the exchange
//! of light needs. Joined where they hang together and face about the same way, they shoot as one, after the
//! clusters of [Smits, Arvo and Greenberg 1994], and what they receive of each other's light they share evenly.
//! What comes straight from emitters, and what is gathered at last, each facet has for itself.
//!
//! [Smits, Arvo and Greenberg 1994]: https://doi.org/10.1145/192161.192277

use glam::DVec3;

use crate::geometry::Weld;
use crate::mesh::{ElementId, Mesh, Patch, PatchId};
use crate::settings::Settings;
use crate::surface::Surfaces;

/// Surfaces not longer than this share of a patch's longest side are facets.
const SMALL: f64 = 0.5;

/// Facets of a cluster are within this share of a patch's longest side of the one that it grew from.
const REACH: f64 = 0.5;

/// Cosine of the greatest angle between any of them and that one: 25°.
const ALIKE: f64 = 0.906;

/// Patches in clusters; most clusters are a single patch.
#[derive(Clone, Debug)]
pub(super) struct Clusters {
    /// By cluster: its patches, in their order.
    members: Vec<Vec<PatchId>>,
    /// By patch.
    of: Vec<u32>,
    /// By cluster: the middle of the box around its patches' centres, m, and that box's diagonal, m.
    places: Vec<(DVec3, f64)>,
}

impl Clusters {
    /// The clusters of a mesh, in the order of their first patches.
    pub(super) fn new(surfaces: &Surfaces, settings: &Settings, mesh: &Mesh) -> Self {
        let size = settings.patch_length(surfaces.extent);
        let facets: Vec<bool> =
            surfaces.list.iter().map(|surface| surface.extent() <= SMALL * size).collect();
        let is_facet = |patch: &Patch| facets[patch.surface.index()];
        let corners = FacetCorners::new(mesh, is_facet, surfaces.epsilon);
        let of = vec![u32::MAX; mesh.patches.len()];
        let mut clusters = Self { members: Vec::new(), of, places: Vec::new() };
        for (index, patch) in mesh.patches.iter().enumerate() {
            if clusters.of[index] == u32::MAX {
                let seed = PatchId(index as u32);
                let reach = if is_facet(patch) { REACH * size } else { 0.0 };
                clusters.grow(mesh, &corners, seed, reach);
            }
        }
        clusters
    }

    /// A cluster of the facets that hang together with a `seed` and are within `reach` of it, m.
    fn grow(&mut self, mesh: &Mesh, corners: &FacetCorners, seed: PatchId, reach: f64) {
        let number = self.members.len() as u32;
        let centre = centre(&mesh[seed]);
        let mut members = vec![seed];
        self.of[seed.index()] = number;
        let mut next = 0;
        while next < members.len() && reach > 0.0 {
            for other in corners.neighbours(members[next]) {
                let patch = &mesh[other];
                let belongs = patch.normal.dot(mesh[seed].normal) >= ALIKE
                    && self::centre(patch).distance(centre) <= reach;
                if belongs && self.of[other.index()] == u32::MAX {
                    self.of[other.index()] = number;
                    members.push(other);
                }
            }
            next += 1;
        }
        members.sort_unstable();
        let [low, high] = bounds(mesh, &members);
        self.places.push((low.midpoint(high), low.distance(high)));
        self.members.push(members);
    }

    /// Number of clusters.
    pub(super) fn len(&self) -> usize {
        self.members.len()
    }

    /// Number of patches.
    pub(super) fn patches(&self) -> usize {
        self.of.len()
    }

    /// The patches of a cluster.
    pub(super) fn members(&self, cluster: usize) -> &[PatchId] {
        &self.members[cluster]
    }

    /// The cluster of a patch.
    pub(super) fn of(&self, patch: PatchId) -> usize {
        self.of[patch.index()] as usize
    }

    /// The element to which links of a cluster of several patches are tied: its first patch's.
    pub(super) fn receiver(&self, mesh: &Mesh, cluster: usize) -> ElementId {
        mesh[self.members[cluster][0]].root
    }

    /// The middle of a cluster, m.
    pub(super) fn centre(&self, cluster: usize) -> DVec3 {
        self.places[cluster].0
    }

    /// How far apart the centres of its patches are, m.
    pub(super) fn size(&self, cluster: usize) -> f64 {
        self.places[cluster].1
    }

    /// True if a patch is one of several in its cluster.
    pub(super) fn holds(&self, patch: PatchId) -> bool {
        self.members[self.of(patch)].len() > 1
    }
}

/// Which facets have a corner in common.
struct FacetCorners {
    /// By patch: the places of its corners; none if it is no facet.
    places: Vec<Vec<u32>>,
    /// By place.
    facets: Vec<Vec<PatchId>>,
}

impl FacetCorners {
    fn new(mesh: &Mesh, is_facet: impl Fn(&Patch) -> bool, epsilon: f64) -> Self {
        let mut weld = Weld::new(epsilon);
        let mut corners = Self { places: Vec::new(), facets: Vec::new() };
        for (index, patch) in mesh.patches.iter().enumerate() {
            let outline = patch.corners.iter().filter(|_| is_facet(patch));
            let places: Vec<u32> = outline.map(|&corner| weld.number(corner)).collect();
            corners.facets.resize(weld.places().len(), Vec::new());
            for &place in &places {
                corners.facets[place as usize].push(PatchId(index as u32));
            }
            corners.places.push(places);
        }
        corners
    }

    fn neighbours(&self, patch: PatchId) -> impl Iterator<Item = PatchId> + '_ {
        let places = self.places[patch.index()].iter();
        places.flat_map(|&place| self.facets[place as usize].iter().copied())
    }
}

/// A part of a cluster, and the facet that looks for it.
#[derive(Clone, Debug)]
pub(super) struct SubCluster {
    pub(super) members: Vec<PatchId>,
    /// In the middle, facing as they do in the mean.
    pub(super) representative: PatchId,
    /// Area, m².
    pub(super) area: f64,
    /// Diagonal of the box around the members' centres, m.
    pub(super) size: f64,
}

impl SubCluster {
    pub(super) fn new(mesh: &Mesh, members: Vec<PatchId>) -> Self {
        let area: f64 = members.iter().map(|&m| mesh[m].area).sum();
        let mean = |of: fn(&Patch) -> DVec3| -> DVec3 {
            members.iter().map(|&m| of(&mesh[m]) * (mesh[m].area / area)).sum()
        };
        let (middle, normal) = (mean(centre), mean(|patch| patch.normal).normalize_or_zero());
        let [low, high] = bounds(mesh, &members);
        let size = low.distance(high);
        let aside = |patch: &Patch| {
            let turned = 1.0 - patch.normal.dot(normal);
            centre(patch).distance(middle) / size.max(f64::MIN_POSITIVE) + turned / (1.0 - ALIKE)
        };
        let nearest = members.iter().min_by(|a, b| {
            let [a, b] = [a, b].map(|&&member| aside(&mesh[member]));
            a.total_cmp(&b)
        });
        let representative = nearest.copied().unwrap_or(members[0]);
        Self { members, representative, area, size }
    }

    /// Two parts of a part, cut across its longest extent.
    pub(super) fn halves(&self, mesh: &Mesh) -> [Self; 2] {
        let [low, high] = bounds(mesh, &self.members);
        let axis = (high - low).max_position();
        let mut order = self.members.clone();
        order.sort_by(|&a, &b| centre(&mesh[a])[axis].total_cmp(&centre(&mesh[b])[axis]));
        let second = order.split_off(order.len() / 2);
        [Self::new(mesh, order), Self::new(mesh, second)]
    }
}

/// The mean of a patch's corners, m.
pub(super) fn centre(patch: &Patch) -> DVec3 {
    patch.corners.iter().sum::<DVec3>() / patch.corners.len() as f64
}

fn bounds(mesh: &Mesh, patches: &[PatchId]) -> [DVec3; 2] {
    let empty = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    patches
        .iter()
        .map(|&patch| centre(&mesh[patch]))
        .fold(empty, |[low, high], centre| [low.min(centre), high.max(centre)])
}
