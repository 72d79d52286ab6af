//! Indirect light at vertices: a last gathering, by a hemicube over each, of what the elements reflect.
//!
//! Based on: the local pass of [Lischinski, Tampieri and Greenberg 1993]. Shooting has settled how
//! bright the elements are; seen from a vertex that is all that is needed, and it is smoother than
//! what any element holds.
//!
//! [Lischinski, Tampieri and Greenberg 1993]: https://doi.org/10.1145/166117.166143

use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::Observer;
use super::sources::{Piece, Sources};
use crate::colour::Rgb;
use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::{DeltaFactors, Hemicube, Sight, Targets, turn};
use crate::mesh::{ElementId, Mesh, PatchId, VertexId};
use crate::surface::Surfaces;
use crate::visibility::Occluders;

/// Cells along the edge of the hemicubes over vertices: they measure visibility only, and vertices
/// are many.
const RESOLUTION: usize = 32;

/// Deepest division of a leaf seen from close by.
const DEEPEST: u32 = 6;

/// Patches that fill less than this of a vertex's view may change without its light being gathered anew.
const WIDE: f64 = 0.02;

/// Changes of this many times the finest difference that gathering resolves make a vertex's light stale.
const STALE: f64 = 8.0;

/// The patches that fill much of a vertex's view, and their form factors.
type View = SmallVec<[(PatchId, f64); 8]>;

/// What one gathering found.
#[derive(Serialize, Deserialize)]
struct Gathered {
    /// W/m².
    irradiance: Rgb,
    view: View,
    factors: u64,
}

/// Gathers indirect light at points.
pub(super) struct Gatherer<'a> {
    surfaces: &'a Surfaces,
    occluders: &'a Occluders,
    sources: Sources,
    delta: DeltaFactors,
    /// Elements whose parts may change a result by more than this, W/m², are taken in parts.
    fine: f64,
    /// What vertices saw whose light was gathered.
    views: Vec<Option<View>>,
    /// How often light was gathered.
    pub(super) gathered: usize,
    /// Factors from a point to a polygon that it took.
    pub(super) factors: u64,
}

impl<'a> Gatherer<'a> {
    pub(super) fn new(
        (surfaces, occluders): (&'a Surfaces, &'a Occluders),
        sources: Sources,
        fine: f64,
    ) -> Self {
        let delta = DeltaFactors::new(RESOLUTION);
        Self {
            surfaces,
            occluders,
            sources,
            delta,
            fine,
            views: Vec::new(),
            gathered: 0,
            factors: 0,
        }
    }

    /// Evaluates indirect light at those of the vertices that lack it.
    pub(super) fn light(
        &mut self,
        mesh: &mut Mesh,
        vertices: impl IntoIterator<Item = VertexId>,
        observer: &mut Observer<'_>,
    ) {
        let mut dark: Vec<VertexId> =
            vertices.into_iter().filter(|&v| mesh[v].indirect.is_none()).collect();
        dark.sort_unstable();
        dark.dedup();
        let targets = Targets::new(&mesh.patches);
        let lit: Vec<Vec<Gathered>> = observer.evaluate(&dark, |batch| {
            let hemicube = || Hemicube::new(&self.delta, &targets, self.occluders);
            let gather =
                |hemicube: &mut Hemicube<'_>, &v: &VertexId| self.gather(mesh, hemicube, v);
            batch.par_iter().map_init(hemicube, gather).collect()
        });
        self.gathered += dark.len();
        self.views.resize(mesh.vertices.len(), None);
        for (&vertex, Gathered { irradiance, view, factors }) in
            dark.iter().zip(lit.into_iter().flatten())
        {
            self.factors += factors;
            mesh.vertices[vertex.index()].indirect = Some(irradiance);
            self.views[vertex.index()] = Some(view);
        }
    }

    /// Replaces what elements reflect, and forgets the light of vertices that this may change:
    /// of those that see much of what has changed, and of all that were interpolated.
    pub(super) fn replace_sources(&mut self, mesh: &mut Mesh, sources: Sources) {
        let before = std::mem::replace(&mut self.sources, sources);
        let patches = (0..mesh.patches.len() as u32).map(PatchId);
        let change: Vec<f64> = patches.map(|p| self.sources.change(mesh, &before, p)).collect();
        let is_stale = |view: &View| {
            let seen: f64 = view.iter().map(|(patch, factor)| change[patch.index()] * factor).sum();
            seen > STALE * self.fine
        };
        for (vertex, view) in mesh.vertices.iter_mut().zip(&self.views) {
            if view.as_ref().is_none_or(is_stale) {
                vertex.indirect = None;
            }
        }
    }

    /// The delta factors of the hemicubes that it looks through.
    pub(super) fn delta(&self) -> &DeltaFactors {
        &self.delta
    }

    /// Irradiance of any place with a unit normal by all reflected light, W/m².
    pub(super) fn at(
        &self,
        mesh: &Mesh,
        hemicube: &mut Hemicube<'_>,
        place: (DVec3, DVec3),
        turn: f64,
    ) -> Rgb {
        self.look(mesh, hemicube, place, turn).irradiance
    }

    /// Irradiance of a vertex by all reflected light, and what it saw.
    fn gather(&self, mesh: &Mesh, hemicube: &mut Hemicube<'_>, vertex: VertexId) -> Gathered {
        let normal = self.surfaces.list[mesh[vertex].surface as usize].plane.normal;
        self.look(mesh, hemicube, (mesh[vertex].site, normal), turn(vertex.index() as f64))
    }

    fn look(
        &self,
        mesh: &Mesh,
        hemicube: &mut Hemicube<'_>,
        (site, normal): (DVec3, DVec3),
        turn: f64,
    ) -> Gathered {
        let hemicube = hemicube.look((site, normal), turn);
        let (mut irradiance, mut factors) = (Rgb::ZERO, 0);
        let mut view = View::new();
        for sight in hemicube.sights().filter(|sight| sight.front) {
            let (light, count) = self.receive(mesh, hemicube, (site, normal), sight);
            irradiance += light;
            factors += count;
            if sight.delta > WIDE {
                view.push((sight.patch, sight.delta));
            }
        }
        Gathered { irradiance, view, factors }
    }

    /// Irradiance by one patch, from elements small enough, and how many factors that took.
    fn receive(
        &self,
        mesh: &Mesh,
        hemicube: &Hemicube<'_>,
        (site, normal): (DVec3, DVec3),
        sight: Sight,
    ) -> (Rgb, u64) {
        let surfaces = self.surfaces;
        let plane = &surfaces.list[mesh[sight.patch].surface as usize].plane;
        let (mut irradiance, mut factors) = (Rgb::ZERO, 0);
        let mut open: SmallVec<[ElementId; 32]> = SmallVec::new();
        let root = mesh[sight.patch].root;
        open.push(root);
        while let Some(source) = open.pop() {
            let element = &mesh[source];
            let corners: SmallVec<[DVec3; 8]> =
                element.corners.iter().map(|&v| plane.lift(mesh[v].position)).collect();
            let factor = point_to_polygon(site, normal, &corners);
            factors += 1;
            let varies = factor * self.sources.spread(source) > self.fine;
            let parts = self.sources.parts(mesh, source);
            if varies && !parts.is_empty() {
                open.extend_from_slice(parts);
                continue;
            }
            let visible = match sight.visible {
                1.0 => 1.0,
                visible if source == root => visible,
                _ => hemicube.visible_share(sight.patch, &corners),
            };
            if varies {
                let piece = self.sources.piece(mesh, surfaces, source);
                let (light, count) = self.piece_light((site, normal), (&piece, factor), DEEPEST);
                irradiance += visible * light;
                factors += count;
            } else {
                irradiance += visible * (self.sources.mean(source) * factor);
            }
        }
        (irradiance, factors)
    }

    /// Irradiance by a piece of a leaf with this form factor, divided while its variation matters, and
    /// how many factors that took.
    fn piece_light(
        &self,
        eye: (DVec3, DVec3),
        (piece, factor): (&Piece, f64),
        depth: u32,
    ) -> (Rgb, u64) {
        if depth == 0 || factor * piece.spread() <= self.fine {
            return (piece.mean() * factor, 0);
        }
        let parts = piece.parts();
        let lit = parts.iter().map(|part| {
            let factor = point_to_polygon(eye.0, eye.1, &part.corners);
            self.piece_light(eye, (part, factor), depth - 1)
        });
        lit.fold((Rgb::ZERO, 0), |(sum, count), (light, more)| (sum + light, count + more + 1))
    }
}
