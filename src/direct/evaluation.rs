//! Light at one place: exact where that is worth it, else by rays, of what matters little of all emitters together.

use glam::DVec3;
use smallvec::SmallVec;

use super::candidates::Candidate;
use super::emitter::Emitter;
use super::emitters::Emitters;
use super::ids::EmitterId;
use super::pool::Pool;
use super::punctual;
use super::view::{EmitterView, Seen};
use super::work::{Evaluated, WorkCounters};
use crate::colour::{Rgb, strength};
use crate::light::Direct;
use crate::scene::Light;
use crate::visibility::{Blockers, CROWDED, Occluders, SurfacePoint};

/// Emitters that send more than this many tolerated errors are looked at exactly, if that can be done.
const EXACT: f64 = 4.0;

/// Most shadows that are cut out of an emitter for each tolerated error that it sends.
const SHADOWS: f64 = 2.0;

/// Emitters that send less than this share of a tolerated error are looked at together.
pub(super) const POOLED: f64 = 0.5;

/// Share of a tolerated error that looking by rays may make.
const SHARE: f64 = 0.5;

/// Light at one place, emitter by emitter.
pub(super) struct Evaluation<'a> {
    emitters: &'a Emitters,
    occluders: &'a Occluders,
    receiver: SurfacePoint,
    known: Direct,
    /// Emitters that something may stand before.
    open: SmallVec<[(EmitterId, &'a Blockers, EmitterView<'a>); 2]>,
    pool: Pool,
    work: WorkCounters,
}

impl<'a> Evaluation<'a> {
    /// Of no emitter yet, at a place with a unit normal.
    pub(super) fn new(
        emitters: &'a Emitters,
        occluders: &'a Occluders,
        receiver: SurfacePoint,
    ) -> Self {
        let (known, open, pool) = (Direct::default(), SmallVec::new(), Pool::default());
        let work = WorkCounters::default();
        Self { emitters, occluders, receiver, known, open, pool, work }
    }

    /// Adds the light of an emitter that looks small and does not matter by itself; false if it looks large.
    pub(super) fn add_faint(
        &mut self,
        Candidate { emitter: number, blockers, .. }: &Candidate,
    ) -> bool {
        let emitters = self.emitters;
        let glance = emitters.list[number.index()].glance(self.receiver);
        let Some((sent, middle)) = glance.filter(|_| emitters.rows.is_none()) else { return false };
        if sent.max_element() > 0.0 {
            self.work.evaluations += 1;
            self.push(*number, sent, blockers, middle);
        }
        true
    }

    /// Takes the light of an emitter, if all is seen, or else puts it to those that are looked at together, by rays to
    /// a place on it.
    fn push(&mut self, number: EmitterId, sent: Rgb, blockers: &Blockers, at: DVec3) {
        self.known.unoccluded += sent;
        if blockers.is_clear() {
            self.known.irradiance += sent;
        } else {
            self.pool.push(number, sent, at);
        }
    }

    /// Adds an emitter's light if it can be told at once.
    pub(super) fn add(&mut self, Candidate { emitter: number, blockers, .. }: &'a Candidate) {
        let (emitters, occluders) = (self.emitters, self.occluders);
        let emitter = &emitters.list[number.index()];
        if let Emitter::Point(point) = emitter {
            self.add_point(*number, point, blockers);
        } else if let Some(view) = emitter.view(self.receiver) {
            self.work.evaluations += 1;
            let seen = match emitters.rows {
                _ if blockers.is_clear() => Some(view.all()),
                rows => rows.map(|rows| view.sampled_evenly(occluders, rows)),
            };
            match seen {
                Some(seen) => self.take(&view, seen),
                None => self.open.push((*number, blockers, view)),
            }
        }
    }

    fn add_point(&mut self, number: EmitterId, light: &Light, blockers: &Blockers) {
        let found = punctual::irradiance(light, self.receiver, self.emitters.blur);
        let Some((sent, source)) = found else { return };
        self.work.evaluations += 1;
        self.push(number, sent, blockers, source.end(self.receiver.position, self.occluders));
    }

    fn take(&mut self, view: &EmitterView<'_>, seen: Seen) {
        self.known = self.known + view.light(seen);
        self.work.rays += seen.rays;
    }

    /// All light, once errors are known that do not matter where so much arrives at least, W/m².
    pub(super) fn finish(mut self, tolerated: impl Fn(f64) -> f64) -> Evaluated {
        let mut open = std::mem::take(&mut self.open);
        let error = tolerated(strength(self.known.irradiance));
        open.retain(|(_, blockers, view)| {
            let is_worth_it = strength(view.unoccluded()) > POOLED * error;
            let exact = (is_worth_it && !matches!(blockers, Blockers::Many(_)))
                .then(|| view.exact(self.occluders, blockers, CROWDED));
            exact.flatten().map(|seen| self.take(view, seen)).is_none()
        });
        let error = tolerated(strength(self.known.irradiance));
        for (number, blockers, view) in open {
            if strength(view.unoccluded()) > POOLED * error {
                let seen = self.crowded(&view, blockers, error);
                self.take(&view, seen);
            } else {
                let middle = view.polygon.iter().sum::<DVec3>() / view.polygon.len() as f64;
                self.push(number, view.unoccluded(), blockers, middle);
            }
        }
        let (emitters, occluders) = (self.emitters, self.occluders);
        let sees = |emitter: EmitterId, at: DVec3| {
            let is_own = |surface| emitters.list[emitter.index()].is_part(surface);
            !occluders.blocks_beyond(self.receiver.position, at, is_own)
        };
        let (light, rays) = self.pool.shine(SHARE * error, sees);
        self.known.irradiance += light;
        self.work.rays += rays;
        Evaluated { light: self.known, work: self.work }
    }

    /// What is seen of an emitter that much may stand before.
    fn crowded(&self, view: &EmitterView<'_>, blockers: &Blockers, error: f64) -> Seen {
        let occluders = self.occluders;
        let sent = strength(view.unoccluded());
        // The more an emitter sends, the more may be cut out of it before rays would do as well.
        let most = (SHADOWS * sent / error.max(f64::MIN_POSITIVE)) as usize;
        let exact = (sent > EXACT * error).then(|| view.exact(occluders, blockers, most));
        let sampled = || view.sampled(occluders, SHARE * error / sent * view.weight);
        exact.flatten().unwrap_or_else(sampled)
    }
}
