//! The state of shooting, and how it begins.

use serde::{Deserialize, Serialize};

use crate::colour::Rgb;
use crate::form_factor::hemicube::{DeltaFactors, HemicubeScene, enough_cells};
use crate::light::{ElementLight, Optics, VertexLight};
use crate::mesh::{ElementId, Mesh, PatchId};
use crate::refine::mean_radiosity;
use crate::settings::Settings;
use crate::solver::context::Context;
use crate::solver::glare::glaring;
use crate::solver::groups::Groups;
use crate::solver::links::Row;
use crate::solver::observer::Observer;
use crate::solver::power_balance::PowerBalance;
use crate::solver::solution::Phase;
use crate::solver::sources::Sources;
use crate::surface::Surfaces;
use crate::visibility::Occluders;

/// Links kept for later shots; beyond them, rows are made anew.
const KEPT_LINKS: usize = 8_000_000;

/// The same where there is little room, for each element that there may be: a third of what one takes.
const LINKS_PER_ELEMENT: usize = 50;

/// Light received and not yet shot.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Unshot {
    pub(super) unshot: Vec<Rgb>,
    pub(super) pending: Vec<Rgb>,
}

/// A solution by shooting under way.
pub(in crate::solver) struct Shooting<'a, 'o> {
    pub(super) observer: &'a mut Observer<'o>,
    pub(super) mesh: &'a Mesh,
    pub(super) surfaces: &'a Surfaces,
    pub(super) optics: &'a Optics,
    pub(super) occluders: &'a Occluders,
    pub(super) delta: DeltaFactors,
    pub(super) targets: HemicubeScene,
    /// By group.
    pub(super) rows: Vec<Option<Row>>,
    pub(super) kept: usize,
    pub(super) most_kept: usize,
    pub(super) groups: &'a Groups,
    /// By element: whether its direct light glares.
    pub(super) glares: Vec<bool>,
    /// By group: its area, m².
    pub(super) areas: Vec<f64>,
    /// By group: its mean reflectance.
    pub(super) reflectances: Vec<Rgb>,
    /// By patch: its elements, parents before their children.
    pub(super) trees: Vec<Vec<ElementId>>,
    /// By group: mean radiosity received and not yet shot, W/m².
    pub(super) unshot: Vec<Rgb>,
    /// By element: the irradiance received at that level and not yet shot, W/m².
    pub(super) pending: Vec<Rgb>,
    /// By element: the radiosity that it releases, while its group does, W/m².
    pub(super) released: Vec<Rgb>,
    /// What groups release, if that is not what they hold.
    pub(super) remembered: Option<Unshot>,
    /// What comes straight from emitters; reflected light is not in it yet.
    pub(in crate::solver) light: ElementLight,
    /// By element: irradiance by reflected light received at that level, W/m².
    pub(in crate::solver) received: Vec<Rgb>,
    pub(in crate::solver) energy: PowerBalance,
    pub(in crate::solver) shots: usize,
    /// Hemicubes looked through.
    pub(in crate::solver) hemicubes: usize,
    /// Factors from a point to a polygon.
    pub(in crate::solver) factors: u64,
}

impl<'a, 'o> Shooting<'a, 'o> {
    /// Books the direct light: emitters have shot, patches hold what they reflect of it.
    pub(in crate::solver) fn new(
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
            energy: PowerBalance::default(),
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

    /// What a group releases, W/m²; it holds that much less afterwards.
    pub(super) fn release(&mut self, group: usize, omega: f64) -> Rgb {
        let held = self.remembered.as_ref().map_or(&self.unshot, |remembered| &remembered.unshot);
        let released = omega * held[group];
        self.unshot[group] -= released;
        released
    }

    /// Finds the radiosities that a patch's elements release, all levels settled, W/m²; they hold that much less
    /// afterwards.
    pub(super) fn release_elements(&mut self, patch: PatchId, omega: f64) {
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

    pub(super) fn unshot_power(&self) -> Rgb {
        self.areas.iter().zip(&self.unshot).map(|(&area, &unshot)| unshot * area).sum()
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

/// The values of leaves, zero for all others.
fn leaves_only(mesh: &Mesh, values: &[Rgb]) -> Vec<Rgb> {
    let leaf = |(element, &value): (&crate::mesh::Element, &Rgb)| {
        if element.is_leaf() { value } else { Rgb::ZERO }
    };
    mesh.elements.iter().zip(values).map(leaf).collect()
}
