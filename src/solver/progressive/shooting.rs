//! The state of shooting, and how it begins.

use super::row_cache::RowCache;
use super::state::{State, Unshot};
use crate::colour::Rgb;
use crate::direct::WorkCounters;
use crate::form_factor::hemicube::{DeltaFactors, HemicubeScene, enough_cells};
use crate::light::{ElementLight, VertexLight};
use crate::mesh::{ElementId, Mesh, PatchId};
use crate::refine::mean_radiosity;
use crate::settings::Settings;
use crate::solver::context::Context;
use crate::solver::glare::glaring;
use crate::solver::observer::Observer;
use crate::solver::solution::Phase;
use crate::solver::sources::Sources;

/// Links kept for later shots; beyond them, rows are made anew.
const KEPT_LINKS: usize = 8_000_000;

/// The same where there is little room, for each element that there may be: a third of what one takes.
const LINKS_PER_ELEMENT: usize = 50;

/// A solution by shooting under way.
pub(in crate::solver) struct Shooting<'a, 'o> {
    pub(super) observer: &'a mut Observer<'o>,
    pub(super) context: Context<'a>,
    pub(super) mesh: &'a Mesh,
    pub(super) delta: DeltaFactors,
    pub(super) targets: HemicubeScene,
    pub(super) rows: RowCache,
    /// By element: whether its direct light glares.
    pub(super) glares: Vec<bool>,
    /// By cluster: its area, m².
    pub(super) areas: Vec<f64>,
    /// By cluster: its mean reflectance.
    pub(super) reflectances: Vec<Rgb>,
    /// By patch: its elements, parents before their children.
    pub(super) trees: Vec<Vec<ElementId>>,
    /// By element: the radiosity that it releases, while its cluster does, W/m².
    pub(super) released: Vec<Rgb>,
    /// What comes straight from emitters; reflected light is not in it yet.
    pub(in crate::solver) light: ElementLight,
    pub(in crate::solver) state: State,
    /// What it took to find out how much direct light arrives.
    pub(in crate::solver) direct_work: WorkCounters,
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
        let Context { optics, clusters, .. } = context;
        let light = ElementLight::direct(mesh, vertices);
        let members = |cluster: usize| clusters.members(cluster).iter().copied();
        let areas: Vec<f64> = (0..clusters.len())
            .map(|cluster| members(cluster).map(|patch| mesh[patch].area).sum())
            .collect();
        let unshot = |cluster: usize| {
            let mean = |patch: PatchId| {
                let direct = light.direct[mesh[patch].root.index()];
                optics.reflectance[patch.index()] * direct * share(mesh[patch].area, areas[cluster])
            };
            members(cluster).map(mean).sum()
        };
        let reflectance = |cluster: usize| {
            let part = |patch: PatchId| {
                optics.reflectance[patch.index()] * share(mesh[patch].area, areas[cluster])
            };
            members(cluster).map(part).sum()
        };
        let reflectances = (0..clusters.len()).map(reflectance).collect();
        let unshot = Unshot {
            radiosity: (0..clusters.len()).map(unshot).collect(),
            irradiance: leaves_only(mesh, &light.direct),
        };
        let most = settings.hemicube_resolution as usize;
        let resolution = enough_cells(mesh.patches.len(), settings.tolerance, most);
        let mut shooting = Self {
            observer,
            context,
            mesh,
            delta: DeltaFactors::new(resolution),
            targets: HemicubeScene::new(&mesh.patches),
            rows: RowCache::new(clusters.len(), most_links(settings)),
            glares: glaring(
                mesh,
                &Sources::of_direct_light(mesh, optics, vertices, &light),
                mean_radiosity(mesh, optics, vertices),
            ),
            trees: mesh.trees(),
            areas,
            reflectances,
            released: vec![Rgb::ZERO; mesh.elements.len()],
            state: State {
                unshot,
                received: vec![Rgb::ZERO; mesh.elements.len()],
                ..State::default()
            },
            light,
            direct_work: WorkCounters::default(),
        };
        shooting.book_emitters();
        shooting.book_direct_light(vertices);
        shooting.state.energy.unshot = shooting.unshot_power();
        shooting
    }

    /// What a cluster releases, W/m²; it holds that much less afterwards.
    pub(super) fn release(&mut self, cluster: usize, omega: f64) -> Rgb {
        let State { unshot, snapshot, .. } = &mut self.state;
        let held = snapshot.as_ref().unwrap_or(unshot).radiosity[cluster];
        let released = omega * held;
        unshot.radiosity[cluster] -= released;
        released
    }

    /// Finds the radiosities that a patch's elements release, all levels settled, W/m²; they hold that much less
    /// afterwards.
    pub(super) fn release_elements(&mut self, patch: PatchId, omega: f64) {
        let Self { mesh, context, trees, released, .. } = self;
        let State { unshot, snapshot, .. } = &mut self.state;
        let (reflectance, tree) =
            (context.optics.reflectance[patch.index()], &trees[patch.index()]);
        released[mesh[patch].root.index()] = Rgb::ZERO;
        for element in tree.iter().map(|element| element.index()) {
            let held = snapshot.as_ref().unwrap_or(unshot).irradiance[element];
            unshot.irradiance[element] -= omega * held;
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
        self.areas
            .iter()
            .zip(&self.state.unshot.radiosity)
            .map(|(&area, &unshot)| unshot * area)
            .sum()
    }
}

/// How many links may be kept.
fn most_links(settings: &Settings) -> usize {
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
