//! The hemicube in pictures ([Cohen and Greenberg 1985](https://doi.org/10.1145/325334.325171)): its delta form
//! factors, what its cells see from the floor of the Cornell box, and the same by Nusselt's analogue, where shares of a
//! disc are form factors.

#[path = "common/figure.rs"]
mod figure;

use std::path::Path;

use figure::{Figure, GROUND, LINE, mixed};
use glam::DVec3;
use radiosity::form_factor::hemicube::{CellLayout, DeltaFactors, Hemicube, HemicubeScene};
use radiosity::form_factor::{FormFactorMethod, factors_at};
use radiosity::mesh::{Mesh, PatchId};
use radiosity::scene::LoadOptions;
use radiosity::visibility::{Occluders, PatchHierarchy, SurfacePoint};
use radiosity::{Length, Settings, Surfaces, load, surfaces_of};

/// Cells along the hemicube's edge, so few that they are seen.
const CELLS: usize = 48;

/// Pixels along the edge of a cell of the faces laid out flat, a dark line included.
const CELL: usize = 8;

/// Pixels along the diameter of a disc, and samples along the edge of each.
const DISC: usize = 480;
const SAMPLES: usize = 4;

/// Angle by which the hemicube is turned about its normal, radians: along the walls.
const TURN: f64 = 0.0;

/// What cells show that see nothing.
const BLACK: [u8; 3] = [0, 0, 0];

/// Empty pixels around things.
const MARGIN: usize = 16;

/// sRGB-coded colours of the objects of the scene, in its order.
const COLOURS: [[u8; 3]; 8] = [
    [120, 120, 120],
    [222, 214, 200],
    [255, 220, 90],
    [110, 150, 205],
    [84, 160, 84],
    [205, 80, 70],
    [235, 150, 60],
    [150, 110, 190],
];

fn main() -> radiosity::Result<()> {
    delta_factors().save("out/hemicube-delta.png");

    let scene = load(Path::new("scenes/cornell-box.obj"), &LoadOptions::default())?;
    let surfaces = surfaces_of(&scene);
    // Each surface is one patch, or a few convex ones.
    let whole = Settings { patch_size: Length::OfScene(2.0), ..Settings::medium() };
    let patches = Mesh::new(&surfaces, &whole).patches;
    let occluders = Occluders::new(&surfaces);
    let eye = SurfacePoint::new(DVec3::new(0.36, 0.0, 0.14), DVec3::Y);

    let seen = Seen::new(&surfaces, patches.iter().map(|patch| patch.surface.index()).collect());
    let (delta, targets) = (DeltaFactors::new(CELLS), HemicubeScene::new(&patches));
    let mut hemicube = Hemicube::new(&delta, &targets, &occluders);
    let items: Vec<Option<PatchId>> = hemicube.look(eye, TURN).items().collect();
    let layout = CellLayout::new(CELLS);
    let hierarchy = PatchHierarchy::new(&patches);
    let first = |direction| hierarchy.first(eye.position, hemicube.to_scene(direction));
    let exact = Disc::new(|direction| seen.sample(first(direction).map(|(patch, _)| patch)));
    let cells = Disc::new(|direction| {
        let cell = layout.along(direction);
        let (object, colour) = seen.sample(cell.and_then(|cell| items[cell]));
        let aside = [DVec3::X, DVec3::Y].map(|way| direction + way * 1.5 / DISC as f64);
        let is_edge = aside.into_iter().any(|aside| layout.along(aside) != cell);
        (object, if is_edge { mixed(colour, GROUND, 0.6) } else { colour })
    });

    let by = |method| seen.by_object(&factors_at(&patches, &occluders, method, eye));
    let factors = by(FormFactorMethod::Contour);
    let sums = seen.sums(&items, &delta);
    println!("{:<12} {:>9} {:>9} {:>9}", "", "exact", "disc", "cells");
    for (k, name) in surfaces.objects.iter().enumerate() {
        let (factor, share, sum) = (factors[k], exact.shares[k], sums[k]);
        println!("{name:<12} {factor:>9.5} {share:>9.5} {sum:>9.5}");
        assert!((factor - share).abs() < 5e-4, "shares of the disc are form factors");
        assert!((factor - sum).abs() < 1e-2, "and so are sums over cells, but for aliasing");
    }
    item_buffer(&items, &seen, &sums).save("out/hemicube-items.png");
    let both = [
        (&exact, "shares of the disc: form factors", &factors[..]),
        (&cells, "through cells: sums of delta factors", &sums[..]),
    ];
    discs(both, &seen).save("out/nusselt.png");
    Ok(())
}

/// What is seen: the surfaces of patches, and the names and colours of these.
struct Seen<'a> {
    surfaces: &'a Surfaces,
    /// By patch.
    surface: Vec<usize>,
}

impl<'a> Seen<'a> {
    fn new(surfaces: &'a Surfaces, surface: Vec<usize>) -> Self {
        Self { surfaces, surface }
    }

    fn object(&self, patch: PatchId) -> usize {
        self.surfaces.list[self.surface[patch.index()]].object as usize
    }

    /// The object of a patch, and the colour of its surface, in one of two shades.
    fn sample(&self, patch: Option<PatchId>) -> (Option<usize>, [u8; 3]) {
        let Some(patch) = patch else { return (None, BLACK) };
        let (object, surface) = (self.object(patch), self.surface[patch.index()]);
        let before = self.surfaces.list[..surface].iter();
        let shade = before.filter(|other| other.object as usize == object).count();
        (Some(object), mixed(COLOURS[object % COLOURS.len()], BLACK, 0.16 * (shade % 2) as f64))
    }

    /// Sums over the patches of each object.
    fn by_object(&self, factors: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.surfaces.objects.len()];
        for (patch, factor) in (0..).map(PatchId).zip(factors) {
            sums[self.object(patch)] += factor;
        }
        sums
    }

    /// Sums of the delta factors of the cells that see each object.
    fn sums(&self, items: &[Option<PatchId>], delta: &DeltaFactors) -> Vec<f64> {
        let mut sums = vec![0.0; self.surfaces.objects.len()];
        for (item, &factor) in items.iter().zip(delta.cells()) {
            if let Some(patch) = item {
                sums[self.object(*patch)] += f64::from(factor);
            }
        }
        sums
    }

    /// The objects that are seen, with their factors; the last line is what nothing takes.
    fn explain(&self, figure: &mut Figure, [left, top]: [usize; 2], factors: &[f64]) {
        let seen = factors.iter().enumerate().filter(|(_, factor)| **factor > 0.0);
        let mut lines: Vec<([u8; 3], String)> = seen
            .map(|(k, factor)| {
                (COLOURS[k % COLOURS.len()], line(&self.surfaces.objects[k], *factor))
            })
            .collect();
        lines.push((BLACK, line("nothing", 1.0 - factors.iter().sum::<f64>())));
        for (row, (colour, text)) in lines.iter().enumerate() {
            figure.explain([left, top + row * LINE], *colour, text);
        }
    }
}

fn line(name: &str, factor: f64) -> String {
    format!("{name:<11} {factor:.3}")
}

/// The unit disc below a hemisphere, with what directions from its middle through the hemisphere meet.
struct Disc {
    /// Row by row; of those outside, the ground.
    pixels: Vec<[u8; 3]>,
    /// By object: its share of the disc's area.
    shares: Vec<f64>,
}

impl Disc {
    fn new(sample: impl Fn(DVec3) -> (Option<usize>, [u8; 3])) -> Self {
        let at = |pixel: usize, k: usize| {
            2.0 * (pixel as f64 + (k as f64 + 0.5) / SAMPLES as f64) / DISC as f64 - 1.0
        };
        let (mut shares, mut all) = (vec![0.0; COLOURS.len()], 0.0);
        let mut pixel = |row: usize, column: usize| {
            let mut sum = [0.0; 3];
            for k in 0..SAMPLES * SAMPLES {
                // Rows go down, the frame's y up.
                let (x, y) = (at(column, k % SAMPLES), -at(row, k / SAMPLES));
                let height = 1.0 - x * x - y * y;
                let mut colour = GROUND;
                if height > 0.0 {
                    let (object, seen) = sample(DVec3::new(x, y, height.sqrt()));
                    colour = seen;
                    all += 1.0;
                    object.iter().for_each(|&object| shares[object] += 1.0);
                }
                sum.iter_mut().zip(colour).for_each(|(sum, channel)| *sum += f64::from(channel));
            }
            sum.map(|sum| (sum / (SAMPLES * SAMPLES) as f64).round() as u8)
        };
        let pixels = (0..DISC * DISC).map(|index| pixel(index / DISC, index % DISC)).collect();
        shares.iter_mut().for_each(|share| *share /= all);
        Self { pixels, shares }
    }

    fn draw(&self, figure: &mut Figure, [left, top]: [usize; 2]) {
        for (index, &pixel) in self.pixels.iter().enumerate() {
            figure.dot([left + index % DISC, top + index / DISC], pixel);
        }
    }
}

/// The faces of a hemicube laid out flat, each cell in its colour.
fn unfolded(colour: impl Fn(usize) -> [u8; 3]) -> Figure {
    let layout = CellLayout::new(CELLS);
    let size = layout.unfolded_size();
    let mut figure = Figure::new(size * CELL + 2 * MARGIN, size * CELL + 2 * MARGIN);
    for row in 0..size {
        for column in 0..size {
            if let Some(cell) = layout.unfolded(column, row) {
                let place = [column, row].map(|k| MARGIN + k * CELL);
                figure.square(place, CELL, mixed(colour(cell), GROUND, 0.35));
                figure.square(place, CELL - 1, colour(cell));
            }
        }
    }
    figure
}

/// Left and top of the corner between two faces of [`unfolded`]: to the right and below, or to the left.
fn corner(is_right: bool) -> [usize; 2] {
    let far = MARGIN + CELLS * CELL * 3 / 2 + MARGIN;
    [if is_right { far } else { MARGIN }, far]
}

fn delta_factors() -> Figure {
    let delta = DeltaFactors::new(CELLS);
    let largest = delta.cells().iter().copied().fold(0.0, f32::max);
    let colour = |share: f64| {
        let colour = colorous::VIRIDIS.eval_continuous(share);
        [colour.r, colour.g, colour.b]
    };
    let mut figure = unfolded(|cell| colour(f64::from(delta.cells()[cell] / largest)));
    let top: f32 = delta.cells()[..CELLS * CELLS].iter().sum();
    let [left, line] = corner(false);
    figure.write([left, line], &format!("top        {top:.3}"));
    figure.write([left, line + LINE], &format!("each side  {:.3}", (1.0 - top) / 4.0));
    let [left, line] = corner(true);
    figure.write([left, line], "delta factor");
    for row in 0..5 {
        let share = 1.0 - f64::from(row) / 4.0;
        let place = [left, line + (row as usize + 1) * LINE];
        figure.explain(place, colour(share), &format!("{:.2e}", share * f64::from(largest)));
    }
    figure
}

fn item_buffer(items: &[Option<PatchId>], seen: &Seen<'_>, sums: &[f64]) -> Figure {
    let mut figure = unfolded(|cell| seen.sample(items[cell]).1);
    seen.explain(&mut figure, corner(true).map(|at| at - MARGIN / 2), sums);
    figure
}

/// Discs side by side, and under each the factors that it shows.
fn discs(discs: [(&Disc, &str, &[f64]); 2], seen: &Seen<'_>) -> Figure {
    let words = 2 * MARGIN + DISC;
    let lines = seen.surfaces.objects.len() + 2;
    let mut figure = Figure::new(3 * MARGIN + 2 * DISC, words + lines * LINE);
    for (k, (disc, title, factors)) in discs.into_iter().enumerate() {
        let left = MARGIN + k * (DISC + MARGIN);
        disc.draw(&mut figure, [left, MARGIN]);
        figure.write([left, words], title);
        seen.explain(&mut figure, [left, words + LINE], factors);
    }
    figure
}
