//! Direct light on the patches of a mesh: exact where it can be seen, by rays in crowds, as many as what may be hidden
//! is worth.

use std::ops::ControlFlow;

use glam::DVec3;
use rayon::prelude::*;

use super::candidates::{Candidate, Candidates, Narrowing};
use super::emitter::Emitter;
use super::emitters::Emitters;
use super::evaluation::{Evaluation, POOLED};
use super::ids::EmitterId;
use super::lines::{EventLine, Shining};
use super::punctual;
use super::work::{Evaluated, WorkCounters};
use crate::colour::{Rgb, strength};
use crate::geometry::PlanarPolygon;
use crate::geometry::boxes::{self, Aabb};
use crate::mesh::{Mesh, PatchId};
use crate::visibility::{Blockers, CROWDED, ConvexBody, Occluders, SurfacePoint};

/// Emitters that can send no more than this share of a tolerated error anywhere on a patch are looked at together
/// there, by what their middles send.
const FAINT: f64 = 0.5 * POOLED;

/// So many occluders before an emitter are cut out of it sooner than they are looked through.
const LISTED: usize = 4;

/// Light is judged as if at least this share of the mean arrived: nobody sees errors in the dark.
const DARKEST: f64 = 0.05;

/// Direct light on the patches of a mesh.
#[derive(Debug)]
pub struct DirectLight {
    emitters: Emitters,
    occluders: Occluders,
    candidates: Candidates,
    /// By patch: its unit normal.
    normals: Vec<DVec3>,
    tolerated: Tolerated,
    work: WorkCounters,
}

/// The emitters that can shine on a patch, or a part of one, and what stands in between: its potentially visible set.
#[derive(Clone, Debug)]
pub struct PotentialEmitters<'a> {
    light: &'a DirectLight,
    patch: PatchId,
    /// Those of the patch.
    around: &'a [Candidate],
    /// Those of a part that are more than faint, in place of the patch's.
    own: Option<Vec<Candidate>>,
    /// Emitters that can send no more than this are looked at together, whatever is before them, W/m².
    faint: f64,
}

/// Errors of irradiance that do not matter.
#[derive(Debug, Default)]
struct Tolerated {
    /// By patch, as a share of the geometric mean of the irradiance there and that of the whole scene; none if all
    /// matter.
    shares: Vec<f32>,
    /// Mean irradiance of the scene, W/m².
    mean: f64,
}

impl DirectLight {
    /// The light of `emitters` on the patches of `mesh`, whatever their elements: exact, but for crowds of occluders.
    pub fn new(emitters: Emitters, occluders: Occluders, mesh: &Mesh) -> Self {
        Self::observed(emitters, occluders, mesh, |_| ControlFlow::Continue(()))
    }

    /// The same; `observe` is told the share done. When it breaks off, the light of the rest takes longer to evaluate.
    pub fn observed(
        emitters: Emitters,
        occluders: Occluders,
        mesh: &Mesh,
        observe: impl FnMut(f64) -> ControlFlow<()>,
    ) -> Self {
        let candidates = Candidates::new(&emitters, &occluders, mesh, observe);
        let normals = mesh.patches.iter().map(|patch| patch.normal).collect();
        let (tolerated, work) = (Tolerated::default(), WorkCounters::default());
        Self { emitters, occluders, candidates, normals, tolerated, work }
    }

    /// The same with errors up to half of those that are tolerated on each patch: given as shares of the geometric
    /// mean of the irradiance there and that of all patches.
    #[must_use]
    pub fn tolerating(mut self, mesh: &Mesh, shares: Vec<f32>) -> Self {
        let (mean, work) = self.mean_irradiance(mesh);
        self.work += work;
        self.tolerated = Tolerated { shares, mean };
        self
    }

    /// Where it comes from.
    pub fn emitters(&self) -> &Emitters {
        &self.emitters
    }

    /// What it has taken to find out how much light there is in all.
    pub(crate) fn work(&self) -> WorkCounters {
        self.work
    }

    /// What stands in its way.
    pub fn occluders(&self) -> &Occluders {
        &self.occluders
    }

    /// The light that all places on a patch may get.
    pub fn on(&self, patch: PatchId) -> PotentialEmitters<'_> {
        let faint = FAINT * self.tolerated.error(patch, 0.0);
        PotentialEmitters {
            light: self,
            patch,
            around: self.candidates.of(patch),
            own: None,
            faint,
        }
    }

    /// What arrives at a place on a patch.
    pub fn at(&self, patch: PatchId, place: DVec3) -> Evaluated {
        self.on(patch).at(place)
    }

    /// What would arrive at a place on a patch if nothing stood between, W/m².
    pub fn unoccluded(&self, patch: PatchId, place: DVec3) -> Rgb {
        let receiver = SurfacePoint::new(place, self.normals[patch.index()]);
        let PotentialEmitters { around, faint, .. } = self.on(patch);
        let sent = |candidate: &Candidate| {
            let emitter = &self.emitters.list[candidate.emitter.index()];
            let glance = (candidate.most < faint).then(|| emitter.glance(receiver)).flatten();
            match emitter {
                Emitter::Point(light) => {
                    Some(punctual::irradiance(light, receiver, self.emitters.blur)?.0)
                }
                emitter => glance
                    .map(|(light, _)| light)
                    .or_else(|| Some(emitter.view(receiver)?.unoccluded())),
            }
        };
        around.iter().filter_map(sent).sum()
    }

    /// What arrives at a place on a patch from some of the polygons, chosen by their numbers, W/m²; `None` where it
    /// is not known exactly.
    pub(crate) fn exactly(
        &self,
        patch: PatchId,
        place: DVec3,
        chosen: impl Fn(EmitterId) -> bool,
    ) -> Option<Rgb> {
        let receiver = SurfacePoint::new(place, self.normals[patch.index()]);
        let candidates = self.candidates.of(patch).iter();
        let mut light = Rgb::ZERO;
        for Candidate { emitter, blockers, .. } in
            candidates.filter(|candidate| chosen(candidate.emitter))
        {
            let Some(view) = self.emitters.list[emitter.index()].view(receiver) else { continue };
            let seen = match self.emitters.rows {
                Some(rows) => view.sampled_evenly(&self.occluders, rows),
                None => view.exact(&self.occluders, blockers, CROWDED)?,
            };
            light += view.light(seen).irradiance;
        }
        Some(light)
    }

    /// Segments in the plane of a patch on which its irradiance by polygons may have a kink or a bend, as far as
    /// interpolation may lose more than `least` by them, W/m²; they may reach beyond the patch.
    ///
    /// The sky makes none: its pieces have no borders that could be seen. Nor do bodies, which are round. Nor are there
    /// any of emitters that more stands before than is cut out of them: what crowds throw has no borders to speak of.
    pub fn lines(&self, mesh: &Mesh, patch: PatchId, least: f64) -> Vec<EventLine> {
        let corners = &mesh[patch].corners;
        let receiver = PlanarPolygon::new(corners, self.normals[patch.index()]);
        let mut lines = Vec::new();
        let candidates = self.candidates.of(patch).iter();
        for Candidate { emitter: number, blockers, .. } in candidates.filter(|c| c.most > least) {
            let source = &self.emitters.list[number.index()];
            let Emitter::Area(emitter) = source else { continue };
            let Some(above) = emitter.above(receiver).filter(|_| !emitter.profile.is_sky()) else {
                continue;
            };
            let most = most_by(source, receiver);
            if most <= least {
                continue;
            }
            let body = ConvexBody::polygon(PlanarPolygon { corners: &above, plane: emitter.front });
            let beneath = ConvexBody::polygon(receiver);
            let between = self.occluders.numbers_in(blockers, &body, &beneath, CROWDED + 1);
            if between.len() > CROWDED {
                continue;
            }
            let shining =
                Shining { number: *number, emitter, above: &above, receiver, most, least };
            lines.extend(shining.lines(&self.occluders, between.into_iter()));
        }
        lines
    }

    /// Mean irradiance of the scene, W/m², estimated from some places, and what that took.
    fn mean_irradiance(&self, mesh: &Mesh) -> (f64, WorkCounters) {
        /// Places, evenly by area.
        const PLACES: usize = 256;
        let area: f64 = mesh.patches.iter().map(|patch| patch.area).sum();
        let step = area / PLACES as f64;
        let (mut sum, mut chosen) = (0.0, Vec::with_capacity(PLACES));
        for (index, patch) in mesh.patches.iter().enumerate() {
            sum += patch.area;
            while chosen.len() < PLACES && sum > (chosen.len() as f64 + 0.5) * step {
                chosen.push(PatchId(index as u32));
            }
        }
        let irradiance = |&patch: &PatchId| {
            let corners = &mesh[patch].corners;
            let place = corners.iter().sum::<DVec3>() / corners.len() as f64;
            // A ray or two for each emitter.
            self.on(patch).within(place, |here| here.max(f64::MIN_POSITIVE))
        };
        let found: Vec<Evaluated> = chosen.par_iter().map(irradiance).collect();
        let sum: f64 = found.iter().map(|evaluated| strength(evaluated.light.irradiance)).sum();
        let work = found.iter().map(|evaluated| evaluated.work).sum();
        (sum / found.len().max(1) as f64, work)
    }
}

impl<'a> PotentialEmitters<'a> {
    /// The light that places on a convex part of it may get: looked through once more where much stands in its way, so
    /// that the more places are evaluated the better it pays.
    pub fn on_part(&self, corners: &[DVec3]) -> Self {
        let light = self.light;
        let is_strong = |candidate: &&Candidate| candidate.most >= self.faint;
        if self.candidates().filter(is_strong).all(|strong| strong.blockers.are_few(LISTED)) {
            return self.clone();
        }
        let receiver = PlanarPolygon::new(corners, light.normals[self.patch.index()]);
        let narrowing = Narrowing { emitters: &light.emitters, occluders: &light.occluders };
        let own = match &self.own {
            Some(own) => narrowing.of_polygon(own.iter(), receiver, self.faint),
            None => {
                let strong = self.around.iter().filter(is_strong);
                narrowing.of_polygon(strong, receiver, self.faint)
            }
        };
        Self { own: Some(own), ..*self }
    }

    /// True if nothing stands before any emitter.
    pub fn is_clear(&self) -> bool {
        self.candidates().all(|candidate| candidate.blockers.is_clear())
    }

    /// True if more stands before an emitter than can be listed.
    pub fn is_crowded(&self) -> bool {
        self.candidates().any(|candidate| matches!(candidate.blockers, Blockers::Many(_)))
    }

    /// True if some emitter is nearer to a patch than `distance`, m: light may then be steep on it.
    pub(crate) fn is_near(&self, mesh: &Mesh, distance: f64) -> bool {
        let corners = mesh[self.patch].corners.iter().copied();
        let around = boxes::around(corners);
        self.candidates().any(|candidate| {
            let body = self.light.emitters.list[candidate.emitter.index()].body();
            body.is_some_and(|body| {
                let (low, high) = body.bounds();
                boxes::are_close(around, Aabb { low, high }, distance)
            })
        })
    }

    /// What arrives at a place.
    pub fn at(&self, place: DVec3) -> Evaluated {
        self.within(place, |here| self.light.tolerated.error(self.patch, here))
    }

    /// The same with errors as are `tolerated` where at least so much arrives, W/m².
    fn within(&self, place: DVec3, tolerated: impl Fn(f64) -> f64) -> Evaluated {
        let normal = self.light.normals[self.patch.index()];
        let DirectLight { emitters, occluders, .. } = self.light;
        let mut evaluation = Evaluation::new(emitters, occluders, SurfacePoint::new(place, normal));
        for candidate in self.candidates() {
            if candidate.most >= self.faint || !evaluation.add_faint(candidate) {
                evaluation.add(candidate);
            }
        }
        evaluation.finish(tolerated)
    }

    /// Those that shine here: the strong ones in their order, then those that are faint on all of the patch.
    fn candidates(&self) -> impl Iterator<Item = &Candidate> {
        let faint = self.own.as_ref().map_or(&[][..], |_| self.around).iter();
        let strong = self.own.as_deref().unwrap_or(self.around);
        strong.iter().chain(faint.filter(|candidate| candidate.most < self.faint))
    }
}

impl Tolerated {
    /// The error of irradiance that does not matter on a patch where at least so much arrives, W/m².
    fn error(&self, patch: PatchId, here: f64) -> f64 {
        let share = self.shares.get(patch.index()).map_or(0.0, |&share| f64::from(share));
        share * (self.mean * here.max(DARKEST * self.mean)).sqrt()
    }
}

/// The most irradiance by an emitter at the corners and in the middle of a receiver, W/m²; any, if it has no surface.
fn most_by(emitter: &Emitter, receiver: PlanarPolygon<'_>) -> f64 {
    if matches!(emitter, Emitter::Point(_)) {
        return f64::INFINITY;
    }
    let corners = receiver.corners;
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let views = corners.iter().chain([&middle]).filter_map(|&at| {
        // The corners of what is on one plane with the emitter see nothing of it.
        emitter.view(SurfacePoint::new(at.lerp(middle, 1e-3), receiver.plane.normal))
    });
    views.map(|view| strength(view.unoccluded())).fold(0.0, f64::max)
}
