//! Pictures of both meshes beside the reference, where they differ most, and by how much.

use std::ops::ControlFlow;

use super::account::Account;
use super::errors::{ErrorMap, ErrorScale};
use crate::compare::comparison::Comparison;
use crate::compare::run::{Lit, Run};
use crate::page::{self, Markup, WipePicture, html};
use crate::render::{Picture, RenderOptions, Solved, Subject, View, close_up, png, render_solved};
use crate::scene::Camera;

/// Pixels of pictures.
const SIZE: [u32; 2] = [640, 480];

/// Pixels of close-ups.
const CLOSE_SIZE: [u32; 2] = [320, 240];

/// How much closer a close-up is; it shows the part of a picture that a block of this kind covers.
const ZOOM: u32 = 8;

/// How many close-ups there are.
const CLOSE_UPS: usize = 3;

/// The runs that are shown: uniform, adaptive.
pub(super) struct Shown<'a> {
    runs: [&'a Run; 2],
    pub(super) lit: [&'a Lit; 2],
}

impl<'a> Shown<'a> {
    /// Runs by their numbers, if they have kept their solutions.
    pub(super) fn new(comparison: &'a Comparison, runs: [usize; 2]) -> Option<Self> {
        let runs = runs.map(|run| &comparison.runs[run]);
        let [uniform, adaptive] = runs.map(|run| run.lit.as_ref());
        Some(Self { runs, lit: [uniform?, adaptive?] })
    }

    /// What a run is called.
    pub(super) fn name(&self, which: usize) -> String {
        let run = self.runs[which];
        format!("{}, {} elements", run.family.name(), run.elements)
    }

    fn picture(&self, comparison: &Comparison, which: usize, setup: &PictureSetup<'_>) -> Picture {
        let (lit, settings) = (self.lit[which], &self.runs[which].settings);
        let solved = Solved { surfaces: &comparison.surfaces, settings, solution: &lit.solution };
        let subject = Subject { mesh: &lit.mesh, solved: Some(solved) };
        let sky = comparison.surfaces.lights.clone();
        let options = RenderOptions { sky, ..setup.options() };
        render_solved(subject, setup.camera, &options, |_| ControlFlow::Continue(()))
    }

    /// Uniform, adaptive, reference.
    fn all(&self, comparison: &Comparison, setup: &PictureSetup<'_>) -> [Picture; 3] {
        let exact = PictureSetup { final_gather: true, ..*setup };
        [
            self.picture(comparison, 0, setup),
            self.picture(comparison, 1, setup),
            self.picture(comparison, 1, &exact),
        ]
    }
}

/// From where, how large, and how exactly.
#[derive(Clone, Copy)]
struct PictureSetup<'a> {
    camera: &'a Camera,
    view: View,
    size: [u32; 2],
    final_gather: bool,
}

impl PictureSetup<'_> {
    fn options(&self) -> RenderOptions {
        let ([width, height], view, final_gather) = (self.size, self.view, self.final_gather);
        RenderOptions { view, width, height, final_gather, ..RenderOptions::default() }
    }
}

/// What is made of the pictures.
pub(super) struct Gallery {
    names: [String; 3],
    /// PNGs.
    pictures: [Vec<u8>; 3],
    /// The same with the mesh over them; the reference has none.
    meshes: [Vec<u8>; 2],
    errors: [ErrorMap; 2],
    mean: f64,
}

impl Gallery {
    pub(super) fn new(comparison: &Comparison, shown: &Shown<'_>, account: &Account<'_>) -> Self {
        let view = View::Light;
        let setup = PictureSetup { camera: account.camera, view, size: SIZE, final_gather: false };
        let [uniform, adaptive, reference] = shown.all(comparison, &setup);
        let mean = shown.runs[1].score.all.mean;
        let errors = [&uniform, &adaptive].map(|p| ErrorMap::new(p, &reference, mean));
        let wires = PictureSetup { view: View::Wireframe, ..setup };
        let meshes = [0, 1].map(|which| {
            // So that it lies over the picture.
            let picture = shown.picture(comparison, which, &wires).without_legend();
            png(&picture, &account.display)
        });
        let names = [shown.name(0), shown.name(1), "reference".to_owned()];
        let pictures = [uniform, adaptive, reference].map(|p| png(&p, &account.display));
        Self { names, pictures, meshes, errors, mean }
    }

    /// On top of each other.
    pub(super) fn pictures(&self) -> Markup {
        let alts = self.names.each_ref().map(|name| format!("The scene, lit: {name}"));
        let picture = |k: usize| WipePicture {
            label: &self.names[k],
            png: &self.pictures[k],
            alt: &alts[k],
            mesh: self.meshes.get(k).map(Vec::as_slice),
        };
        let pictures = [0, 1, 2].map(picture);
        html! {
            h2 { "Pictures" }
            (page::wipe(&pictures, "All at one exposure. The reference is the finest adaptive solution with direct \
                light evaluated at every sample of the picture."))
        }
    }

    /// Where the meshes are farthest from the reference.
    pub(super) fn close_ups(
        &self,
        comparison: &Comparison,
        shown: &Shown<'_>,
        account: &Account<'_>,
    ) -> Markup {
        let places = worst(&self.errors);
        let rows = places.iter().map(|&place| {
            let camera = close_up(account.camera, SIZE, place, f64::from(ZOOM));
            let view = View::Light;
            let setup =
                PictureSetup { camera: &camera, view, size: CLOSE_SIZE, final_gather: false };
            let pictures = shown.all(comparison, &setup);
            let figure = |k: usize| {
                let alt = format!("Close-up of a shadow's edge: {}", self.names[k]);
                page::picture(&png(&pictures[k], &account.display), &alt, &self.names[k])
            };
            page::thirds(&[0, 1, 2].map(figure))
        });
        html! {
            h2 { "Where they differ most" }
            @for row in rows { (row) }
            @if places.is_empty() { p { "Nowhere: both pictures are the reference's." } }
        }
    }

    /// Signed and absolute, on one scale for both meshes.
    pub(super) fn error_maps(&self) -> Markup {
        let scale = ErrorScale::of(&self.errors);
        let side = |k: usize| {
            let name = &self.names[k];
            let signed = format!("Signed errors: {name}");
            let absolute = format!("Magnitudes of errors: {name}");
            html! {
                (page::picture(&self.errors[k].signed_png(&scale), &signed, &signed))
                (page::picture(&self.errors[k].absolute_png(&scale), &absolute, &absolute))
                p { (self.errors[k].in_words()) }
            }
        };
        html! {
            h2 { "Errors" }
            p {
                "Difference of luminance from the reference's picture, as a share of the mean radiosity, "
                (format!("{:.3} W/m²", self.mean)) "; one scale for both meshes."
            }
            (page::columns(&[side(0), side(1)]))
            (scale.legends())
        }
    }
}

/// Middles, in pixels, of the blocks with the largest errors of both maps together, worst first and apart.
fn worst(errors: &[ErrorMap; 2]) -> Vec<[f64; 2]> {
    let block = [SIZE[0] / ZOOM, SIZE[1] / ZOOM];
    // Blocks overlap by half.
    let starts = |axis: usize| 0..=(SIZE[axis] - block[axis]) / (block[axis] / 2);
    let corner = |k: u32, axis: usize| k * block[axis] / 2;
    let mut blocks: Vec<(f64, [u32; 2])> = starts(1)
        .flat_map(|row| starts(0).map(move |column| [corner(column, 0), corner(row, 1)]))
        .map(|at| (errors.iter().map(|map| map.sum(at, block)).sum(), at))
        .collect();
    blocks.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut chosen: Vec<[u32; 2]> = Vec::new();
    for (error, at) in blocks {
        let apart = |other: &[u32; 2]| (0..2).any(|k| at[k].abs_diff(other[k]) >= block[k]);
        if error > 0.0 && chosen.len() < CLOSE_UPS && chosen.iter().all(apart) {
            chosen.push(at);
        }
    }
    let middle = |at: [u32; 2]| [0, 1].map(|k| f64::from(at[k]) + f64::from(block[k]) / 2.0);
    chosen.into_iter().map(middle).collect()
}
