//! Exchange of reflected light by shooting: patch by patch, until little is left.
//!
//! Based on: [Cohen, Chen, Wallace and Greenberg 1988]. It is a relaxation of B = E + ρ F B, by default
//! Southwell's scaled by area: the patch with the most unshot power is next.
//! Emitters come first; their light has been carried exactly before, so their shots only book it.
//!
//! [Cohen, Chen, Wallace and Greenberg 1988]: https://doi.org/10.1145/54852.378487

mod ambient;
mod rows;
mod state;

use serde::{Deserialize, Serialize};

use super::context::Context;
use super::energy::Energy;
use super::glare::glaring;
use super::groups::Groups;
use super::observer::Observer;
use super::relaxation::{Course, Relaxation, Residuals, Step};
use super::solution::{Phase, Stop};
use super::sources::Sources;
use super::transport::{Link, Row};
use crate::colour::Rgb;
use crate::error::{Error, Result};
use crate::form_factor::hemicube::{DeltaFactors, HemicubeScene, enough_cells};
use crate::light::{ElementLight, Optics, VertexLight};
use crate::mesh::{ElementId, Mesh, PatchId};
use crate::refine::mean_radiosity;
use crate::settings::Settings;
use crate::surface::Surfaces;
use crate::visibility::Occluders;

use state::last_state;

/// Links kept for later shots; beyond them, rows are made anew.
const KEPT_LINKS: usize = 8_000_000;

/// The same where there is little room, for each element that there may be: a third of what one takes.
const LINKS_PER_ELEMENT: usize = 50;

/// Light received and not yet shot.
#[derive(Clone, Serialize, Deserialize)]
struct Held {
    unshot: Vec<Rgb>,
    pending: Vec<Rgb>,
}

/// A solution by shooting under way.
pub(super) struct Shooting<'a, 'o> {
    observer: &'a mut Observer<'o>,
    mesh: &'a Mesh,
    surfaces: &'a Surfaces,
    optics: &'a Optics,
    occluders: &'a Occluders,
    delta: DeltaFactors,
    targets: HemicubeScene,
    /// By group.
    rows: Vec<Option<Row>>,
    kept: usize,
    most_kept: usize,
    groups: &'a Groups,
    /// By element: whether its direct light glares.
    glares: Vec<bool>,
    /// By group: its area, m².
    areas: Vec<f64>,
    /// By group: its mean reflectance.
    reflectances: Vec<Rgb>,
    /// By patch: its elements, parents before their children.
    trees: Vec<Vec<ElementId>>,
    /// By group: mean radiosity received and not yet shot, W/m².
    unshot: Vec<Rgb>,
    /// By element: the irradiance received at that level and not yet shot, W/m².
    pending: Vec<Rgb>,
    /// By element: the radiosity that it releases, while its group does, W/m².
    released: Vec<Rgb>,
    /// What groups release, if that is not what they hold.
    remembered: Option<Held>,
    /// What comes straight from emitters; reflected light is not in it yet.
    pub(super) light: ElementLight,
    /// By element: irradiance by reflected light received at that level, W/m².
    pub(super) received: Vec<Rgb>,
    pub(super) energy: Energy,
    pub(super) shots: usize,
    /// Hemicubes looked through.
    pub(super) hemicubes: usize,
    /// Factors from a point to a polygon.
    pub(super) factors: u64,
}

impl<'a, 'o> Shooting<'a, 'o> {
    /// Books the direct light: emitters have shot, patches hold what they reflect of it.
    pub(super) fn new(
        context: Context<'a>,
        settings: &Settings,
        mesh: &'a Mesh,
        vertices: &VertexLight,
        observer: &'a mut Observer<'o>,
    ) -> Self {
        let _ = observer.tell(Phase::Shooting, 0.0);
        let Context { surfaces, occluders, optics, groups, .. } = context;
        let light = ElementLight::direct(mesh, vertices);
        let members = |group: usize| groups.members(group).iter().copied();
        let areas: Vec<f64> = (0..groups.len())
            .map(|group| members(group).map(|patch| mesh[patch].area).sum())
            .collect();
        let unshot = |group: usize| {
            let mean = |patch: PatchId| {
                let direct = light.direct[mesh[patch].root.index()];
                optics.reflectance[patch.index()] * direct * share(mesh[patch].area, areas[group])
            };
            members(group).map(mean).sum()
        };
        let reflectance = |group: usize| {
            let part = |patch: PatchId| {
                optics.reflectance[patch.index()] * share(mesh[patch].area, areas[group])
            };
            members(group).map(part).sum()
        };
        let reflectances = (0..groups.len()).map(reflectance).collect();
        let most = settings.hemicube_resolution as usize;
        let resolution = enough_cells(mesh.patches.len(), settings.tolerance, most);
        let mut shooting = Self {
            observer,
            mesh,
            surfaces,
            optics,
            occluders,
            delta: DeltaFactors::new(resolution),
            targets: HemicubeScene::new(&mesh.patches),
            rows: vec![None; groups.len()],
            groups,
            glares: glaring(
                mesh,
                &Sources::of_direct_light(mesh, optics, vertices, &light),
                mean_radiosity(mesh, optics, vertices),
            ),
            kept: 0,
            most_kept: most_kept(settings),
            trees: mesh.trees(),
            pending: leaves_only(mesh, &light.direct),
            unshot: (0..groups.len()).map(unshot).collect(),
            areas,
            reflectances,
            released: vec![Rgb::ZERO; mesh.elements.len()],
            remembered: None,
            received: vec![Rgb::ZERO; mesh.elements.len()],
            energy: Energy::default(),
            shots: 0,
            hemicubes: 0,
            factors: 0,
            light,
        };
        shooting.book_emitters();
        shooting.book_direct_light(context, vertices);
        shooting.energy.unshot = shooting.unshot_power();
        shooting
    }

    /// Lets patches shoot until the unshot power is small, the shots are used up, or the observer has
    /// seen enough.
    pub(super) fn run(&mut self, settings: &Settings) -> Result<(Stop, Vec<Step>)> {
        let relaxation = Relaxation::new(settings.solver, settings.omega)?;
        let (emitters, start) = (self.shots, self.energy.unshot_share().max(f64::MIN_POSITIVE));
        let mut course = Course::new(relaxation, self);
        let mut known = None;
        if let Some(state) = last_state(self.observer) {
            (course, known) = self.take_up(state);
        }
        // What is made of the rest once there has been enough is not kept, but what there was by then is.
        let is_going_on = known.is_none() && self.observer.flow.is_continue();
        let stop = known.unwrap_or_else(|| {
            relaxation.run(self, &mut course, |shooting, course| {
                let step = course.step();
                if step.unshot <= settings.stop {
                    return Some(Stop::Converged);
                }
                if settings.max_shots.is_some_and(|most| emitters + step.shots >= most) {
                    return Some(Stop::ShotLimit);
                }
                let done = (step.unshot / start).ln() / (settings.stop / start).ln();
                let is_over = shooting.observer.tell(Phase::Shooting, done).is_break();
                if !is_over && shooting.observer.checkpoint.is_due() {
                    shooting.keep(course, None);
                }
                is_over.then_some(Stop::Cancelled)
            })
        });
        if is_going_on && stop == Stop::Cancelled {
            self.keep(&course, None);
        }
        self.energy.unshot = self.unshot_power();
        self.spread_over_groups();
        if stop == Stop::Diverged {
            return Err(diverged(settings));
        }
        if is_going_on && stop != Stop::Cancelled {
            self.keep(&course, Some(stop));
        }
        Ok((stop, course.history))
    }

    /// Gives all patches of a group what they have received together.
    fn spread_over_groups(&mut self) {
        for group in 0..self.groups.len() {
            let [first, others @ ..] = self.groups.members(group) else { continue };
            let light = self.received[self.mesh[*first].root.index()];
            for &other in others {
                self.received[self.mesh[other].root.index()] = light;
            }
        }
    }

    /// What a group releases, W/m²; it holds that much less afterwards.
    fn release(&mut self, group: usize, omega: f64) -> Rgb {
        let held = self.remembered.as_ref().map_or(&self.unshot, |remembered| &remembered.unshot);
        let released = omega * held[group];
        self.unshot[group] -= released;
        released
    }

    /// Finds the radiosities that a patch's elements release, all levels settled, W/m²; they hold that much less
    /// afterwards.
    fn release_elements(&mut self, patch: PatchId, omega: f64) {
        let Self { mesh, optics, trees, pending, released, remembered, .. } = self;
        let (reflectance, tree) = (optics.reflectance[patch.index()], &trees[patch.index()]);
        released[mesh[patch].root.index()] = Rgb::ZERO;
        for element in tree.iter().map(|element| element.index()) {
            let held = remembered.as_ref().map_or(pending[element], |held| held.pending[element]);
            pending[element] -= omega * held;
            released[element] += omega * held;
            for child in &mesh.elements[element].children {
                released[child.index()] = released[element];
            }
        }
        for &element in tree.iter().rev() {
            let parts = &mesh[element].children;
            if !parts.is_empty() {
                let share = |part: &ElementId| mesh[*part].area / mesh[element].area;
                let means = parts.iter().map(|part| released[part.index()] * share(part));
                released[element.index()] = means.sum();
            }
        }
        tree.iter().for_each(|element| released[element.index()] *= reflectance);
    }

    fn unshot_power(&self) -> Rgb {
        self.areas.iter().zip(&self.unshot).map(|(&area, &unshot)| unshot * area).sum()
    }
}

impl Residuals for Shooting<'_, '_> {
    fn rows(&self) -> usize {
        self.unshot.len()
    }

    fn area(&self, row: usize) -> f64 {
        self.areas[row]
    }

    fn residual(&self, row: usize) -> Rgb {
        self.unshot[row]
    }

    fn emitted(&self) -> f64 {
        self.energy.emitted.element_sum()
    }

    fn remember(&mut self) {
        let (unshot, pending) = (self.unshot.clone(), self.pending.clone());
        self.remembered = Some(Held { unshot, pending });
    }

    fn is_ready(&self, row: usize) -> bool {
        self.rows[row].is_some()
    }

    fn prepare(&mut self, rows: &[usize]) {
        self.make_rows(rows);
    }

    fn relax(&mut self, shooter: usize, omega: f64) -> Rgb {
        let released = self.release(shooter, omega);
        match self.groups.members(shooter) {
            &[patch] => self.release_elements(patch, omega),
            // Groups of facets are taken as one.
            facets => {
                let roots = facets.iter().map(|&facet| self.mesh[facet].root.index());
                roots.for_each(|root| self.released[root] = released);
            }
        }
        let power = released * self.areas[shooter];
        let row = self.rows[shooter].take().unwrap_or_default();
        let arriving = power * (1.0 - row.escaped - row.on_backs);
        let scale = conserve(arriving, &row, &self.released);
        for link in &row.links {
            let power = scale * self.released[link.source.index()] * link.exchange;
            let group = self.groups.of(self.mesh[link.receiver].patch);
            let shared = self.groups.members(group).len() > 1;
            let area = if shared { self.areas[group] } else { self.mesh[link.receiver].area };
            // A group's light is kept with the first of its patches, and spread at last.
            self.received[link.receiver.index()] += power / area;
            self.pending[link.receiver.index()] += power / area;
            self.unshot[group] += self.reflectances[group] * power / self.areas[group];
            self.energy.absorbed += (Rgb::ONE - self.reflectances[group]) * power;
        }
        self.energy.escaped += power * row.escaped;
        self.energy.on_backs += power * row.on_backs;
        self.rows[shooter] = Some(row);
        self.shots += 1;
        released
    }
}

/// How many links may be kept.
fn most_kept(settings: &Settings) -> usize {
    let room = settings.max_elements.unwrap_or(usize::MAX).saturating_mul(LINKS_PER_ELEMENT);
    room.min(KEPT_LINKS)
}

/// A part's share of the whole; of nothing, all.
fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 1.0 }
}

/// Advice for a relaxation that will not end.
fn diverged(settings: &Settings) -> Error {
    let (solver, omega) = (settings.solver.name(), settings.omega);
    let message = format!("{solver} with {omega} lets the light grow without end; use 1 or less");
    Error::Setting { name: "omega", message }
}

/// The values of leaves, zero for all others.
fn leaves_only(mesh: &Mesh, values: &[Rgb]) -> Vec<Rgb> {
    let leaf = |(element, &value): (&crate::mesh::Element, &Rgb)| {
        if element.is_leaf() { value } else { Rgb::ZERO }
    };
    mesh.elements.iter().zip(values).map(leaf).collect()
}

/// Factors by which what the links of a row carry becomes the `power` that should arrive, W.
///
/// Elements of a shooter near others see more or less of them than the whole does; no light may be
/// lost by that, or come from nowhere.
fn conserve(power: Rgb, row: &Row, released: &[Rgb]) -> Rgb {
    let carry = |link: &Link| released[link.source.index()] * link.exchange;
    let carried: Rgb = row.links.iter().map(carry).sum();
    let scale = Rgb::select(carried.cmpne(Rgb::ZERO), power / carried, Rgb::ONE);
    scale.clamp(Rgb::splat(0.8), Rgb::splat(1.25))
}
