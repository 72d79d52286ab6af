//! Pictures of both meshes beside the reference, and by how much they differ from it.

use std::ops::ControlFlow;

use super::account::Account;
use super::errors::{ErrorMap, ErrorScale};
use crate::compare::comparison::Comparison;
use crate::compare::run::{Lit, Run};
use crate::compare::sentences::{capital, number};
use crate::page::{self, Markup, WipePicture, html};
use crate::render::{Picture, RenderOptions, Solved, Subject, View, png, render_solved};
use crate::scene::Camera;

/// Pixels of pictures.
pub(super) const SIZE: [u32; 2] = [640, 480];

/// What pictures are called where there is little room.
const NAMES: [&str; 3] = ["uniform", "adaptive", "reference"];

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
        format!("{}, {} triangles", run.family.name(), number(run.triangles as f64))
    }

    /// Mean radiosity by the reference, W/m².
    pub(super) fn mean(&self) -> f64 {
        self.runs[1].score.all.mean
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
    pub(super) fn all(&self, comparison: &Comparison, setup: &PictureSetup<'_>) -> [Picture; 3] {
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
pub(super) struct PictureSetup<'a> {
    camera: &'a Camera,
    view: View,
    size: [u32; 2],
    final_gather: bool,
}

impl<'a> PictureSetup<'a> {
    /// Of the light on the mesh.
    pub(super) fn new(camera: &'a Camera, size: [u32; 2]) -> Self {
        Self { camera, view: View::Light, size, final_gather: false }
    }
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
    pub(super) errors: [ErrorMap; 2],
    mean: f64,
}

impl Gallery {
    pub(super) fn new(comparison: &Comparison, shown: &Shown<'_>, account: &Account<'_>) -> Self {
        let setup = PictureSetup::new(account.camera, SIZE);
        let [uniform, adaptive, reference] = shown.all(comparison, &setup);
        let mean = shown.mean();
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
            label: NAMES[k],
            png: &self.pictures[k],
            alt: &alts[k],
            mesh: self.meshes.get(k).map(Vec::as_slice),
        };
        let pictures = [0, 1, 2].map(picture);
        let [uniform, adaptive, _] = &self.names;
        let caption = format!(
            "{uniform}; {adaptive}; all at one exposure. The reference is the finest adaptive solution with direct light \
             evaluated at every sample of the picture."
        );
        page::wipe(&pictures, &capital(&caption))
    }

    /// Signed, on one scale for both meshes.
    pub(super) fn error_maps(&self) -> Markup {
        let scale = ErrorScale::of(&self.errors);
        let side = |k: usize| {
            let alt = format!("Signed errors: {}", self.names[k]);
            let caption = format!("{}. {}", capital(&self.names[k]), self.errors[k].in_words());
            page::picture(&self.errors[k].signed_png(&scale), &alt, &caption)
        };
        html! {
            p {
                "Signed errors: luminance minus that of the reference's picture, as a share of the mean radiosity, "
                (format!("{:.3} W/m²", self.mean)) ". Blue has too little light, orange too much."
            }
            (page::halves(&[side(0), side(1)]))
            (scale.legend())
        }
    }
}
