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

use super::clusters::Clusters;
use super::context::GatherContext;
use super::gather_points::{GatherPoint, IncidentLight, LightVector, gather_points};
use super::glare::{Gaze, glaring};
use super::lit_mesh::LitMesh;
use super::observer::Observer;
use super::sources::{RadiosityPiece, Sources};
use crate::colour::Rgb;
use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::{
    DeltaFactors, Hemicube, HemicubeScene, PatchCoverage, VisiblePatch, enough_cells, turn,
};
use crate::light::Optics;
use crate::mesh::{ElementId, Mesh, PatchId, VertexId};
use crate::settings::Settings;
use crate::surface::Surfaces;
use crate::visibility::{Occluders, SurfacePoint};

/// Most cells along the edge of the hemicubes over vertices: they measure visibility only, and vertices
/// are many.
///
/// At 16, shadows in two rooms (medium) err by 1.45 % for 0.78 %, and noise makes 9 860 triangles of 8 498; at 64 they
/// err no less.
const MOST_CELLS: usize = 32;

/// Deepest division of a leaf seen from close by.
///
/// At 3, two rooms (medium) err by 0.723 % for 0.717 %; at 12 nothing changes.
const DEEPEST: u32 = 6;

/// Gathering resolves differences down to this share of the tolerated error.
///
/// At half of it, two rooms joined by a door (medium) err by 0.58 % for 0.72 % and take 1.2 times the time; at twice, by
/// 0.93 %, in 0.9 times the time.
const GATHER_SHARE: f64 = 0.13;

/// Patches that fill less than this of a vertex's view may change without its light being gathered anew.
///
/// At 0.01, two rooms (medium) err by 0.68 % for 0.72 %, in 1.1 times the time; at 0.04, by 0.73 %.
const WIDE: f64 = 0.02;

/// Changes of this many times the finest difference that gathering resolves make a vertex's light stale.
///
/// At 4, two rooms (medium) err by 0.66 % for 0.72 %, in 1.1 times the time; at 16, by 0.88 %.
const STALE: f64 = 8.0;

/// The patches that fill much of a vertex's view, and their form factors.
type PatchView = SmallVec<[(PatchId, f64); 8]>;

/// What one gathering found.
#[derive(Serialize, Deserialize)]
struct Gathered {
    /// W/m².
    irradiance: Rgb,
    view: PatchView,
    factors: u64,
}

/// Gathers indirect light at points.
pub(super) struct Gatherer<'a> {
    surfaces: &'a Surfaces,
    occluders: &'a Occluders,
    clusters: &'a Clusters,
    /// Vertices of a cluster of facets nearer to each other than this, m, have one view.
    near: f64,
    sources: Sources<'a>,
    /// By patch: whether it is among `glaring`.
    glares: Vec<bool>,
    glaring: Vec<PatchId>,
    delta: DeltaFactors,
    /// Mean radiosity of the scene, W/m².
    mean: f64,
    /// Elements whose parts may change a result by more than this, W/m², are taken in parts.
    fine: f64,
    /// What vertices saw whose light was gathered.
    views: Vec<Option<PatchView>>,
    /// How often light was gathered.
    pub(super) gathered: usize,
    /// Factors from a point to a polygon that it took.
    pub(super) factors: u64,
}

impl<'a> Gatherer<'a> {
    pub(super) fn new(
        GatherContext { surfaces, occluders, clusters }: GatherContext<'a>,
        settings: &Settings,
        mesh: &Mesh,
        sources: Sources<'a>,
        mean: f64,
    ) -> Self {
        let resolution = enough_cells(clusters.patches(), settings.tolerance, MOST_CELLS);
        let delta = DeltaFactors::new(resolution);
        let mut gatherer = Self {
            surfaces,
            occluders,
            clusters,
            near: 0.5 * settings.min_element.metres(surfaces.extent),
            sources,
            glares: Vec::new(),
            glaring: Vec::new(),
            delta,
            mean,
            fine: GATHER_SHARE * settings.tolerance * mean,
            views: Vec::new(),
            gathered: 0,
            factors: 0,
        };
        gatherer.find_glaring(mesh);
        gatherer
    }

    /// Finds the patches that glare by the sources.
    fn find_glaring(&mut self, mesh: &Mesh) {
        let elements = glaring(mesh, &self.sources, self.mean);
        let glares =
            |patch: PatchId| !self.clusters.holds(patch) && elements[mesh[patch].root.index()];
        let patches = mesh.patch_ids();
        self.glares = patches.clone().map(glares).collect();
        self.glaring = patches.filter(|patch| self.glares[patch.index()]).collect();
    }

    /// Evaluates indirect light at those of the vertices that lack it.
    pub(super) fn light(
        &mut self,
        LitMesh { mesh, light, .. }: &mut LitMesh<'_>,
        vertices: impl IntoIterator<Item = VertexId>,
        observer: &mut Observer<'_>,
    ) {
        let mesh = &**mesh;
        let mut dark: Vec<VertexId> =
            vertices.into_iter().filter(|&v| light.indirect(v).is_none()).collect();
        dark.sort_unstable();
        dark.dedup();
        let targets = HemicubeScene::new(&mesh.patches);
        let gather_points = gather_points(mesh, self.clusters, self.near, &dark);
        let lit: Vec<Vec<Vec<Gathered>>> = observer.evaluate(&gather_points, |batch, enough| {
            let hemicube = || Hemicube::new(&self.delta, &targets, self.occluders);
            let gather = |hemicube: &mut Hemicube<'_>, gather_point| {
                self.gather(mesh, hemicube, gather_point)
            };
            let going_on = batch.par_iter().take_any_while(|_| !enough.is_said());
            going_on.map_init(hemicube, gather).collect()
        });
        self.gathered += gather_points.len();
        self.views.resize(mesh.vertices.len(), None);
        let vertices = gather_points.iter().flat_map(|gather_point| &gather_point.vertices);
        for (&vertex, Gathered { irradiance, view, factors }) in
            vertices.zip(lit.into_iter().flatten().flatten())
        {
            self.factors += factors;
            light.set_indirect(vertex, irradiance);
            self.views[vertex.index()] = Some(view);
        }
    }

    /// Replaces what elements reflect, and forgets the light of vertices that this may change:
    /// of those that see much of what has changed, and of all that were interpolated.
    pub(super) fn replace_sources(
        &mut self,
        LitMesh { mesh, light, .. }: &mut LitMesh<'_>,
        sources: Sources<'a>,
    ) {
        let before = std::mem::replace(&mut self.sources, sources);
        self.find_glaring(mesh);
        let patches = mesh.patch_ids();
        let change: Vec<f64> = patches.map(|p| self.sources.change(mesh, &before, p)).collect();
        let is_stale = |view: &PatchView| {
            let seen: f64 = view.iter().map(|(patch, factor)| change[patch.index()] * factor).sum();
            seen > STALE * self.fine
        };
        light.forget_indirect(|v| {
            let view = self.views.get(v.index());
            view.is_some_and(|view| view.as_ref().is_none_or(is_stale))
        });
    }

    /// How patches reflect.
    pub(super) fn optics(&self) -> &'a Optics {
        self.sources.optics
    }

    /// What of the mesh is in clusters.
    pub(super) fn clusters(&self) -> &'a Clusters {
        self.clusters
    }

    /// The delta factors of the hemicubes that it looks through.
    pub(super) fn delta(&self) -> &DeltaFactors {
        &self.delta
    }

    /// Irradiance of any point of a surface by all reflected light, W/m².
    pub(super) fn at(
        &self,
        mesh: &Mesh,
        hemicube: &mut Hemicube<'_>,
        point: SurfacePoint,
        turn: f64,
    ) -> Rgb {
        let mut irradiance = Rgb::ZERO;
        self.look(mesh, hemicube.look(point, turn), &mut |from: &IncidentLight<'_>| {
            irradiance += from.light;
        });
        irradiance
    }

    /// Irradiance of the vertices of a gathering point by all reflected light, and what they saw.
    fn gather(
        &self,
        mesh: &Mesh,
        hemicube: &mut Hemicube<'_>,
        gather_point: &GatherPoint,
    ) -> Vec<Gathered> {
        let turn = turn(gather_point.vertices[0].index() as f64);
        let point = SurfacePoint::new(gather_point.eye, gather_point.normal);
        let normal = |v: VertexId| self.surfaces[mesh[v].surface].plane.normal;
        if gather_point.vertices.len() == 1 {
            let mut irradiance = Rgb::ZERO;
            let (view, factors) =
                self.look(mesh, hemicube.look(point, turn), &mut |from: &IncidentLight<'_>| {
                    irradiance += from.light;
                });
            return vec![Gathered { irradiance, view, factors }];
        }
        let mut field = LightVector::default();
        let (view, factors) =
            self.look(mesh, hemicube.look(point, turn), &mut |from: &IncidentLight<'_>| {
                field.add(point, from);
            });
        let light = |(k, &vertex): (usize, &VertexId)| Gathered {
            irradiance: field.irradiance(normal(vertex)),
            view: view.clone(),
            factors: if k == 0 { factors } else { 0 },
        };
        gather_point.vertices.iter().enumerate().map(light).collect()
    }

    /// Tells `arrive` of all reflected light. Returns what fills much of the view, and how many factors that took.
    fn look(
        &self,
        mesh: &Mesh,
        hemicube: &Hemicube<'_>,
        arrive: &mut impl FnMut(&IncidentLight<'_>),
    ) -> (PatchView, u64) {
        let eye = hemicube.eye();
        let (mut factors, mut view) = (0, PatchView::new());
        let is_whole = |patch: PatchId| !self.clusters.holds(patch);
        let is_plain = |patch: PatchId| is_whole(patch) && !self.glares[patch.index()];
        for sight in hemicube.visible_patches_of(is_plain).filter(|sight| sight.front) {
            factors += self.receive(mesh, hemicube, &sight, arrive);
            if sight.delta > WIDE {
                view.push((sight.patch, sight.delta));
            }
        }
        let Self { occluders, sources, fine, .. } = self;
        let gaze = Gaze { mesh, occluders, sources, eye, fine: *fine };
        for &patch in &self.glaring {
            let (factor, count) = gaze.receive(patch, arrive);
            factors += count;
            if factor > WIDE {
                view.push((patch, factor));
            }
        }
        // Facets are many and small: their cells are all that is to be known of them.
        let facets = hemicube.coverage_of(|patch| !is_whole(patch));
        for PatchCoverage { patch, kept, .. } in
            facets.filter(|cover| cover.front && cover.kept > 0.0)
        {
            let light = self.sources.mean(mesh[patch].root) * kept;
            arrive(&IncidentLight { light, corners: &mesh[patch].corners });
            if kept > WIDE {
                view.push((patch, kept));
            }
        }
        (view, factors)
    }

    /// Tells `arrive` of the light of one patch, from elements small enough. Returns how many factors that took.
    fn receive(
        &self,
        mesh: &Mesh,
        hemicube: &Hemicube<'_>,
        sight: &VisiblePatch,
        arrive: &mut impl FnMut(&IncidentLight<'_>),
    ) -> u64 {
        let (plane, eye) = (mesh.plane(sight.patch), hemicube.eye());
        let mut factors = 0;
        let mut open: SmallVec<[ElementId; 32]> = SmallVec::new();
        let root = mesh[sight.patch].root;
        open.push(root);
        while let Some(source) = open.pop() {
            let element = &mesh[source];
            let corners: SmallVec<[DVec3; 8]> =
                element.corners.iter().map(|&v| plane.lift(mesh[v].position)).collect();
            let factor = point_to_polygon(eye.position, eye.normal, &corners);
            factors += 1;
            let varies = factor * self.sources.spread(source) > self.fine;
            let parts = self.sources.parts(mesh, source);
            if varies && !parts.is_empty() {
                open.extend_from_slice(parts);
                continue;
            }
            let visible = hemicube.visible_share(sight, (source != root).then_some(&corners[..]));
            if varies {
                let piece = self.sources.piece(mesh, source);
                let (light, count) = self.piece_light(eye, &piece, factor, DEEPEST);
                arrive(&IncidentLight { light: visible * light, corners: &corners });
                factors += count;
            } else {
                let light = visible * (self.sources.mean(source) * factor);
                arrive(&IncidentLight { light, corners: &corners });
            }
        }
        factors
    }

    /// Irradiance by a piece of a leaf with this form factor, divided while its variation matters, and
    /// how many factors that took.
    fn piece_light(
        &self,
        eye: SurfacePoint,
        piece: &RadiosityPiece,
        factor: f64,
        depth: u32,
    ) -> (Rgb, u64) {
        if depth == 0 || factor * piece.spread() <= self.fine {
            return (piece.mean() * factor, 0);
        }
        let parts = piece.parts();
        let lit = parts.iter().map(|part| {
            let factor = point_to_polygon(eye.position, eye.normal, &part.corners);
            self.piece_light(eye, part, factor, depth - 1)
        });
        lit.fold((Rgb::ZERO, 0), |(sum, count), (light, more)| (sum + light, count + more + 1))
    }
}
